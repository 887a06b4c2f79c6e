"""Public names for defining a new kind of station; see the guide on station kinds."""

from rmfs.control.decisions import Visit as Visit
from rmfs.layout.kinds import StationKind as StationKind
from rmfs.simulation.service import VisitService as VisitService
from rmfs.simulation.visits import VisitController as VisitController
from rmfs.world.stations import PickStation as PickStation
from rmfs.world.stations import ReplenishmentStation as ReplenishmentStation
from rmfs.world.stations import Station as Station
from rmfs.world.tasks import VisitTask as VisitTask

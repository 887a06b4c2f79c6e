"""Pod selection (PPS): which pod is brought to a station, or which station a carried pod goes to."""

from __future__ import annotations

from abc import abstractmethod
from typing import TYPE_CHECKING, TypeVar

from rmfs.config import Model
from rmfs.control.base import Controller
from rmfs.control.problems import Problem

if TYPE_CHECKING:
    from collections.abc import Sequence

    from rmfs.world.robots import Robot
    from rmfs.world.stations import PickStation, ReplenishmentStation


class LateBinding(Model):
    """Parameters of every PPS rule.

    Attributes
    ----------
    late_picks
        Whether a pod on its way to a pick station is given requests that come up meanwhile.
    late_bundles
        Whether a pod on its way to a replenishment station is given bundles that come up meanwhile.
    """

    late_picks: bool = True
    late_bundles: bool = True


P = TypeVar("P", bound=LateBinding)


class PodSelection(Controller[P]):
    """Chooses pods for robots that TA wants to work for a station.

    It is asked by TA, for an empty robot or for a pod that has been served. What the pod can serve
    at the station is bound to it by the simulation.
    """

    problem = Problem.PPS

    @abstractmethod
    def pick_pod(self, robot: Robot, station: PickStation) -> int:
        """Choose a pod at hand with units that open requests of the station want, or -1."""

    @abstractmethod
    def replenishment_pod(self, robot: Robot, station: ReplenishmentStation) -> int:
        """Choose a pod at hand for which bundles wait at the station, or -1."""

    @abstractmethod
    def next_station(self, robot: Robot, stations: Sequence[int]) -> int:
        """Choose one of several stations that the pod of a robot can serve (at least one)."""

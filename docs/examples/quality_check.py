"""Quality checks: every n-th pod that was at a pick station is inspected before it is stored."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Any

from pydantic import Field

from rmfs.config import Model
from rmfs.measure.base import Measure
from rmfs.measure.columns import INTEGER, REAL, Column
from rmfs.stations import (
    PickStation,
    Station,
    StationKind,
    Visit,
    VisitController,
    VisitService,
    VisitTask,
)

if TYPE_CHECKING:
    from rmfs.measure.ended import EndedRun
    from rmfs.world.robots import Robot


class CheckParameters(Model):
    """Parameters of checks in a layout file."""

    every: Annotated[int, Field(ge=1)] = 5
    check_s: Annotated[float, Field(gt=0)] = 20.0


class CheckTask(VisitTask):
    """Bring a pod to a check."""

    kind = "check"


class CheckStation(Station[CheckTask]):
    """A station that counts the pods inspected there."""

    passed = 0


class CheckService(VisitService):
    """One inspector, who takes `check_s` for a pod."""

    def seconds(self, task: VisitTask) -> float:
        """All pods take the same time."""
        return float(self.parameters.check_s)

    def done(self, task: VisitTask) -> None:
        """The pod may go on."""
        self.station.passed += 1


class EveryNth(VisitController[CheckStation]):
    """Sends every n-th pod that arrives at a pick station to the check with the fewest pods."""

    def __init__(self, *given: Any) -> None:
        super().__init__(*given)
        self._visits = 0
        self._due: set[int] = set()

    def visit_started(self, time_s: float, station: int, pod: int, robot: int) -> None:
        """Count visits to pick stations; every n-th pod is due for a check."""
        if isinstance(self.view.all_stations[station], PickStation):
            self._visits += 1
            if self._visits % self.parameters.every == 0:
                self._due.add(pod)

    def visit_for(self, robot: Robot) -> Visit | None:
        """Send a pod that is due for a check when its robot has finished at the pick station."""
        if robot.pod not in self._due:
            return None
        self._due.remove(robot.pod)
        chosen = min(self.stations, key=lambda station: (len(station.tasks), station.index))
        return Visit(robot, robot.pod, chosen.index, self.task)


class Checks(Measure):
    """Columns of the footprint about checks."""

    columns = (
        Column("pods_checked", INTEGER, "pods", "Visits of pods to checks"),
        Column("check_idle_share", REAL, "share", "Share of time in which checks have no pod"),
    )

    def footprint(self, run: EndedRun) -> dict[str, Any]:
        """Read the table of stations."""
        stations = run.tables["stations"]
        own = stations[stations["kind"] == QualityCheck.name]
        return {
            "pods_checked": int(own["visits"].sum()),
            "check_idle_share": float(own["idle_share"].mean()),
        }


class QualityCheck(StationKind):
    """The kind: this is what a layout file names."""

    name = "check"
    letter = "Q"
    colour = "#7B3294"
    handles = "pods checked"
    parameters_model = CheckParameters
    task = CheckTask
    state = CheckStation
    service = CheckService
    controller = EveryNth
    measures = (Checks,)

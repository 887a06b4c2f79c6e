"""A finished run, as measures see it."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING, Any, Protocol

from rmfs.measure.tables import Logs, Made

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray
    from pydantic import BaseModel

    from rmfs.control.choices import Choice
    from rmfs.control.settings import ControllerSettings
    from rmfs.layout.model import Layout
    from rmfs.measure.base import Measure
    from rmfs.measure.checker import CheckReport
    from rmfs.measure.events import EventLog
    from rmfs.measure.recorder import Recorder
    from rmfs.scenario import Scenario
    from rmfs.world.world import World


class Measured(Protocol):
    """The data of a finished run from which its tables are made."""

    @property
    def names(self) -> tuple[str, str, str]:
        """Names of layout, scenario and controllers."""

    @property
    def seed(self) -> int:
        """Seed of the run."""

    @property
    def warmup_s(self) -> float:
        """Simulated time before the measured time starts, in s."""

    @property
    def duration_s(self) -> float:
        """Length of the measured time, in s."""

    @property
    def recorder(self) -> Recorder:
        """The data recorded during the run, from which its tables are made."""

    @property
    def measures(self) -> Sequence[Measure]:
        """The measures that make up the footprint: those of rmfs and those of the user."""

    @property
    def wall_s(self) -> float:
        """Wall time of the simulation, in s."""


class Recorded(Measured, Protocol):
    """A finished run with everything that a run folder contains."""

    @property
    def layout(self) -> Layout:
        """The simulated layout, after overrides."""

    @property
    def scenario(self) -> Scenario:
        """The simulated scenario, after overrides."""

    @property
    def controllers(self) -> ControllerSettings:
        """The controllers, after overrides."""

    @property
    def overrides(self) -> list[tuple[list[str], Any]]:
        """Overrides, that is, changes of single parameters: pairs of key path and value."""

    @property
    def notes(self) -> dict[str, list[str]]:
        """Notes on the import of inputs from files of another system, by input."""

    @property
    def pacing(self) -> str:
        """The pacing as specified by the user."""

    @property
    def pacing_settings(self) -> BaseModel:
        """The pacing with all its parameters."""

    @property
    def interventions(self) -> Sequence[tuple[float, Choice]]:
        """Interactive exchanges of controllers: for each, its time (s) and the new controller."""

    @property
    def slow_robots(self) -> list[tuple[int, int, int, float]]:
        """Periods in which robots were slow: robot, start and end (us), share of the top speed."""

    @property
    def trace(self) -> dict[str, NDArray[Any]]:
        """All pieces of motion, one array per column; available only if a trace was requested."""

    @property
    def events(self) -> EventLog | None:
        """All events except motion; None if no trace was requested."""


class EndedRun:
    """A finished run, as measures see it.

    Attributes
    ----------
    names
        Names of layout, scenario and controllers.
    seed
        Seed of the run.
    start_s, end_s
        Start and end of the measured time, in seconds since the start of the run.
    warmup_s, duration_s
        Simulated time before the measured time, and length of the measured time, in s.
    wall_s
        Wall time of the simulation in s.
    recorder
        The data recorded during the run, warm-up included.
    layout, world
        The layout, and the state of the warehouse at the end of the run.
    report
        Result of the trace checker; None if it did not run.
    """

    def __init__(self, run: Measured, report: CheckReport | None = None) -> None:
        self.names = run.names
        self.seed = run.seed
        self.warmup_s, self.duration_s = run.warmup_s, run.duration_s
        self.wall_s = run.wall_s
        self.recorder = run.recorder
        self.layout: Layout = run.recorder.layout
        self.world: World = run.recorder.world
        self.start_s, self.end_s = run.recorder.start_s, run.recorder.end_s
        self.report = report

    @cached_property
    def logs(self) -> Logs:
        """The recorded data as data frames."""
        return Logs(self.recorder)

    @cached_property
    def tables(self) -> Made:
        """The tables of the run folder except the footprint, by name; made on first access."""
        return Made(self.logs)

    def handled(self, column: str) -> int:
        """Return the sum over all stations of a count in the table `stations`.

        Parameters
        ----------
        column
            Column of the table, such as `units_picked`.
        """
        return int(self.tables["stations"][column].sum())

"""A run that has ended, as measures see it."""

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
    """What tables are made from: a run that has ended."""

    @property
    def names(self) -> tuple[str, str, str]:
        """Names of layout, scenario and controllers."""

    @property
    def seed(self) -> int:
        """Seed of the run."""

    @property
    def warmup_s(self) -> float:
        """Simulated time before the measured time."""

    @property
    def duration_s(self) -> float:
        """Measured time."""

    @property
    def recorder(self) -> Recorder:
        """What was written down."""

    @property
    def measures(self) -> Sequence[Measure]:
        """What makes the footprint: the measures of rmfs and those of the user."""

    @property
    def wall_s(self) -> float:
        """Wall time of the simulation."""


class Recorded(Measured, Protocol):
    """What a run folder is written from."""

    @property
    def layout(self) -> Layout:
        """What was simulated, after overrides."""

    @property
    def scenario(self) -> Scenario:
        """Likewise."""

    @property
    def controllers(self) -> ControllerSettings:
        """Likewise."""

    @property
    def overrides(self) -> list[tuple[list[str], Any]]:
        """Pairs of path and value."""

    @property
    def notes(self) -> dict[str, list[str]]:
        """Remarks on files of other systems."""

    @property
    def pacing(self) -> str:
        """The pacing as it was given."""

    @property
    def pacing_settings(self) -> BaseModel:
        """The pacing with all its parameters."""

    @property
    def interventions(self) -> Sequence[tuple[float, Choice]]:
        """Controllers exchanged by hand, and when (s)."""

    @property
    def slow_robots(self) -> list[tuple[int, int, int, float]]:
        """When which robots were slow: robot, from when to when (us), share of the top speed."""

    @property
    def trace(self) -> dict[str, NDArray[Any]]:
        """Every piece of motion; only if the run was asked to record it."""

    @property
    def events(self) -> EventLog | None:
        """What happened; only if the run was asked to record its trace."""


class EndedRun:
    """A run that has ended, as measures see it.

    Attributes
    ----------
    names
        Names of layout, scenario and controllers.
    seed
        Seed of the run.
    start_s, end_s
        The measured time, in seconds since the start of the run.
    warmup_s, duration_s
        Simulated time before the measured time, and its length.
    wall_s
        Wall time of the simulation.
    recorder
        What was written down, warm-up included.
    layout, world
        What was simulated, and how the run left it.
    report
        What the trace checker found; nothing if it did not run.
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
        """What happened, as frames."""
        return Logs(self.recorder)

    @cached_property
    def tables(self) -> Made:
        """The tables of the run folder but the footprint, by name; made when asked for."""
        return Made(self.logs)

    def handled(self, column: str) -> int:
        """Return the total of a column of the table `stations`: `units_picked` and the like."""
        return int(self.tables["stations"][column].sum())

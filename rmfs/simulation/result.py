"""`Run`: the result of a simulation."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rmfs import measure
from rmfs.errors import InputError
from rmfs.measure.checker import Slow, check
from rmfs.measure.dictionary import TABLES
from rmfs.measure.ended import EndedRun
from rmfs.measure.folder import fill, reserved
from rmfs.measure.footprints import footprint
from rmfs.measure.results import Results

if TYPE_CHECKING:
    from collections.abc import Sequence

    import pandas as pd
    from numpy.typing import NDArray

    from rmfs.control.choices import Choice
    from rmfs.control.settings import ControllerSettings
    from rmfs.layout.model import Layout
    from rmfs.measure import EventLog, Recorder, RunFolder
    from rmfs.measure.base import Measure
    from rmfs.measure.checker import CheckReport
    from rmfs.scenario import Scenario
    from rmfs.simulation.disturbances import DisturbanceSource
    from rmfs.simulation.inputs import Overrides
    from rmfs.simulation.pacing import PacingSettings
    from rmfs.simulation.statistics import DecisionStatistics
    from rmfs.traffic import Traffic
    from rmfs.world import World


@dataclass(repr=False, eq=False)
class Run(Results):
    """A finished run.

    A run that is sent to another process (pickled) contains its tables and trace, but not `world`,
    `traffic`, `recorder` and `disturbances`.

    Attributes
    ----------
    layout, scenario, controllers
        The simulated inputs, after overrides.
    names
        Layout, scenario and controllers as specified by the user. Controllers that were installed
        interactively during the run are appended to the third name.
    overrides
        Changed parameters as (path, value) pairs: those given by the user, and those that a
        scenario of RAWSim-O implies for the layout.
    notes
        For each input imported from RAWSim-O files, what the import left out or changed.
    pacing, pacing_settings
        The pacing as specified by the user, and with all its parameters.
    warmup_s, duration_s, end_s
        Length of the warm-up, length of the measured time, and both together, in s.
    wall_s
        Wall time of the simulation in s, not counting the loading of its inputs.
    world, traffic
        The final state of world and traffic.
    statistics
        For each decision problem, number and duration of calls of its controller.
    recorder
        The recorded data.
    measures
        The measures that make up the footprint.
    disturbances
        The source of disturbances; its attribute `begun` lists those that occurred.
    events
        The recorded events; only if the trace was recorded.
    interventions
        For each interactive exchange of a controller, the time in s and the new controller.
    idle_rules
        Descriptions of rules that decided nothing for a long time although work waited.
    """

    layout: Layout
    scenario: Scenario
    controllers: ControllerSettings
    names: tuple[str, str, str]
    overrides: Overrides
    notes: dict[str, list[str]]
    seed: int
    pacing: str
    pacing_settings: PacingSettings
    warmup_s: float
    duration_s: float
    end_s: float
    wall_s: float
    world: World
    traffic: Traffic
    statistics: list[DecisionStatistics]
    recorder: Recorder
    measures: Sequence[Measure]
    disturbances: DisturbanceSource
    events: EventLog | None = None
    interventions: Sequence[tuple[float, Choice]] = ()
    idle_rules: Sequence[str] = ()

    _report: CheckReport | None = None
    _sent: _Sent | None = None

    @cached_property
    def footprint(self) -> pd.Series[Any]:
        """Measures of the whole run, as in the single row of `footprint.csv`."""
        row: pd.Series[Any] = self.table("footprint").iloc[0]
        return row

    def table(self, name: str) -> pd.DataFrame:
        """Return a table by name; see `Results.table`."""
        if name not in TABLES:
            raise InputError(f"{name}: no such table; valid: {', '.join(TABLES)}")
        if self._sent is not None:
            return self._sent.tables[name]
        if name == "footprint":
            return self._footprint
        return self._ended.tables[name]

    def check(self) -> CheckReport:
        """Verify with the independent checker that the motion is safe.

        From then on, the footprint contains the number of collisions (`collisions`).

        Raises
        ------
        InputError
            If the trace was not recorded.
        """
        until_us = round(self.end_s * 1e6)
        slow = [Slow(*one) for one in self.slow_robots]
        self._require_trace()
        self._report = check(self.layout, self.trace, until_us=until_us, slow=slow)
        for known in ("footprint", "_footprint", "_ended"):
            self.__dict__.pop(known, None)
        return self._report

    def save(self, path: str | Path, *, force: bool = False) -> RunFolder:
        """Write a run folder, with the trace if there is one; see `Results.save`."""
        has_trace = self.events is not None
        with reserved(Path(path), force=force) as folder:
            fill(folder, self, report=self._report, trace=has_trace, tables=self._tables())
        return measure.load_run(Path(path))

    @property
    def trace(self) -> dict[str, NDArray[Any]]:
        """The complete motion of the robots; only if the trace was recorded."""
        return self.traffic.trace() if self._sent is None else self._sent.trace

    @property
    def slow_robots(self) -> list[tuple[int, int, int, float]]:
        """Slow periods of robots: (robot, start in us, end in us, share of the top speed)."""
        return self.disturbances.slow if self._sent is None else self._sent.slow_robots

    def _tables(self) -> dict[str, pd.DataFrame]:
        return {name: self.table(name) for name in TABLES}

    @cached_property
    def _footprint(self) -> pd.DataFrame:
        return footprint(self._ended, self.measures)

    @cached_property
    def _ended(self) -> EndedRun:
        return EndedRun(self, self._report)

    def _in_folder(self, path: Path) -> RunFolder:
        self._require_trace()
        return self.save(path)

    def _require_trace(self) -> None:
        if self.events is None:
            raise InputError("the run has no trace; simulate it with trace=True")

    def __getstate__(self) -> dict[str, Any]:
        trace = {} if self.events is None else self.trace
        kept = {key: value for key, value in self.__dict__.items() if key not in _STAYS}
        return {**kept, "_sent": _Sent(self._tables(), trace, self.slow_robots)}

    def __getattr__(self, name: str) -> Any:
        if name in _STAYS:
            raise AttributeError(
                f"{name} is not available, as the run was simulated in another process"
            )
        raise AttributeError(f"{type(self).__name__!r} object has no attribute {name!r}")


@dataclass(frozen=True)
class _Sent:
    """The parts of a run that are sent to another process."""

    tables: dict[str, pd.DataFrame]
    trace: dict[str, NDArray[Any]]
    slow_robots: list[tuple[int, int, int, float]]


_STAYS = frozenset(("world", "traffic", "recorder", "disturbances", "_ended", "_footprint"))
"""The parts of a run that cannot be sent."""

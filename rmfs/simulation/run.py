"""`simulate` and `Simulation`: from names to results, in one call or step by step."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any, Self

from rmfs import layout as layouts
from rmfs import measure
from rmfs.control.pp import planner_settings
from rmfs.control.problems import Problem
from rmfs.errors import InputError
from rmfs.measure.checker import Slow, check
from rmfs.measure.dictionary import TABLES
from rmfs.measure.ended import EndedRun
from rmfs.measure.folder import fill, reserved
from rmfs.measure.footprints import footprint
from rmfs.measure.measures import SHIPPED
from rmfs.measure.provenance import MARK
from rmfs.measure.registry import find_all
from rmfs.measure.results import Results
from rmfs.simulation import forking, saving
from rmfs.simulation.checkpoints import resumed
from rmfs.simulation.inputs import Overrides, as_overrides, load_inputs, name_of
from rmfs.simulation.kernel import Kernel
from rmfs.simulation.pacing import Replay, ReplayPacing, pacing_settings
from rmfs.traffic import Traffic

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping, Sequence

    import pandas as pd
    from numpy.typing import NDArray

    from rmfs.control.choices import Choice
    from rmfs.control.settings import ControllerSettings
    from rmfs.layout.model import Layout
    from rmfs.measure import EventLog, Recorder, RunFolder
    from rmfs.measure.base import Measure
    from rmfs.measure.checker import CheckReport
    from rmfs.observer import Observer
    from rmfs.scenario import Scenario, StreamRecorder
    from rmfs.simulation.disturbances import DisturbanceSource
    from rmfs.simulation.pacing import Paced, PacingSettings
    from rmfs.simulation.statistics import DecisionStatistics
    from rmfs.world import World

    Driver = Callable[[Kernel, Callable[[float, float], None] | None], None]


@dataclass(repr=False, eq=False)
class Run(Results):
    """A run that has ended.

    Sent to another process, it takes its tables and its trace along and leaves behind what can
    only be used here: `world`, `traffic`, `recorder` and `disturbances`.

    Attributes
    ----------
    layout, scenario, controllers
        What was simulated, after overrides.
    names
        Layout, scenario and controllers as the user named them; behind the controllers stands
        what was exchanged by hand.
    overrides
        As pairs of path and value: those given, and what a scenario of RAWSim-O asks of the layout.
    notes
        Per part, what an import of RAWSim-O's file left out or does differently.
    pacing, pacing_settings
        The pacing as it was given, and with all its parameters.
    warmup_s, duration_s, end_s
        Simulated first and not measured; measured; both together.
    wall_s
        Wall time of the simulation, without loading.
    world, traffic
        Their last state.
    statistics
        Per decision problem, how often its controller was asked and how long it took.
    recorder
        What was written down.
    measures
        What makes the footprint of it.
    disturbances
        What went wrong.
    events
        What happened; only if the run was asked to record its trace.
    interventions
        Controllers exchanged by hand, and when (s); `names` tells of them, too.
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

    _report: CheckReport | None = None
    _sent: _Sent | None = None

    @cached_property
    def footprint(self) -> pd.Series[Any]:
        """Measures of the whole run; one row of `footprint.csv`."""
        row: pd.Series[Any] = self.table("footprint").iloc[0]
        return row

    @property
    def series(self) -> pd.DataFrame:
        """Measures minute by minute."""
        return self.table("series")

    @property
    def decisions(self) -> pd.DataFrame:
        """Measures per decision problem."""
        return self.table("decisions")

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
        """Have the independent checker prove the motion safe; `collisions` tells of it then."""
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
        """Every piece of motion; only if the run was asked to record it."""
        return self.traffic.trace() if self._sent is None else self._sent.trace

    @property
    def slow_robots(self) -> list[tuple[int, int, int, float]]:
        """When which robots were slow: robot, from when to when (us), share of the top speed."""
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
            raise InputError("the run has recorded no trace; simulate it with trace=True")

    def __getstate__(self) -> dict[str, Any]:
        trace = {} if self.events is None else self.trace
        kept = {key: value for key, value in self.__dict__.items() if key not in _STAYS}
        return {**kept, "_sent": _Sent(self._tables(), trace, self.slow_robots)}

    def __getattr__(self, name: str) -> Any:
        if name in _STAYS:
            raise AttributeError(f"{name} was left behind when the run was sent to this process")
        raise AttributeError(f"{type(self).__name__!r} object has no attribute {name!r}")


@dataclass(frozen=True)
class _Sent:
    """What a run takes along to another process in place of what it was made from."""

    tables: dict[str, pd.DataFrame]
    trace: dict[str, NDArray[Any]]
    slow_robots: list[tuple[int, int, int, float]]


_STAYS = frozenset(("world", "traffic", "recorder", "disturbances", "_ended", "_footprint"))
"""What of a run cannot travel."""


def simulate(
    layout: str | Path | Layout = "default",
    scenario: str | Path | Scenario = "default",
    controllers: str | Path | ControllerSettings = "default",
    *,
    seed: int = 0,
    set: Mapping[str, Any] | None = None,
    overrides: Sequence[tuple[list[str], Any]] = (),
    observers: Sequence[Observer] = (),
    measures: Sequence[str | type[Measure]] = (),
    driver: Driver = Kernel.run,
    pacing: str = "instant",
    trace: bool = False,
    events: EventLog | None = None,
    streams: StreamRecorder | None = None,
    progress: Callable[[float, float], None] | None = None,
    remark: Callable[[str, str], None] | None = None,
    allow_not_well_formed: bool = False,
    traffic_maker: Callable[..., Traffic] = Traffic,
    resume: Path | None = None,
) -> Run:
    """Simulate a warehouse.

    Parameters
    ----------
    layout, scenario, controllers
        Names of shipped instances, paths, or the objects themselves.
    seed
        Seed of all random streams, 0 or greater.
    set
        Parameters by dotted key, as `--set` has them: `{"layout.robots": 16}`. Where a rule is
        named, its class will do: `{"controllers.psa.name": MyRule}`.
    overrides
        The same as pairs of path and value, for example `(["layout", "robots"], 16)`; `set` wins.
    observers
        Told of everything that happens, besides the recorder of the usual measures.
    measures
        What is measured besides: classes derived from `rmfs.Measure`, or how they are named
        (`module:Class`, `path/to/file.py:Class`, the name of an installed one).
    driver
        Takes the simulation from its first event to its last: for who lets a run wait for somebody.
        By default it goes on without a stop.
    pacing
        What the thinking of optimisers costs in simulated time: `instant` for nothing, `wall`,
        `work`, `fixed=SECONDS` or `replay=RUN_DIR` (docs: optimisers in the loop).
    trace
        Whether every piece of motion and everything that happens is kept.
    events
        Where what happens is kept, for who reads it while the run goes on; means `trace`.
    streams
        Keeps all orders and bundles that come, to be written by `rmfs.scenario.write_stream`.
    progress
        Called with the simulated time so far and in total, about a hundred times.
    remark
        Called, before the run begins, with part (`layout`, ...) and text of each remark on a file
        of RAWSim-O: what is left out or done differently.
    allow_not_well_formed
        Whether to run a layout in which robots may block each other for ever.
    traffic_maker
        Makes the traffic layer, from what `Traffic` is made from: the demonstrator has its own.
    resume
        A file that `Simulation.save` has written in a run of the same inputs, to go on from.

    Raises
    ------
    InputError
        If something given is wrong; names what and says what would be valid.
    """
    simulation = Simulation(
        layout,
        scenario,
        controllers,
        seed=seed,
        set=set,
        overrides=overrides,
        observers=observers,
        measures=measures,
        pacing=pacing,
        trace=trace,
        events=events,
        streams=streams,
        remark=remark,
        allow_not_well_formed=allow_not_well_formed,
        traffic_maker=traffic_maker,
    )
    if resume is not None:
        simulation = resumed(resume, simulation)
    driver(simulation, progress)
    return simulation.result()


class Simulation(Kernel):
    """A run that goes on as far as it is told: the same as `simulate`, step by step.

    Parameters
    ----------
    layout, scenario, controllers, seed, overrides, observers, measures, pacing, trace, events, \
streams, remark, allow_not_well_formed, traffic_maker
        As for `simulate`.
    outside
        Decision problems that `step` hands out, such as `["poa", "pps"]`.

    Raises
    ------
    InputError
        If something given is wrong; names what and says what would be valid.
    """

    def __init__(
        self,
        layout: str | Path | Layout = "default",
        scenario: str | Path | Scenario = "default",
        controllers: str | Path | ControllerSettings = "default",
        *,
        seed: int = 0,
        set: Mapping[str, Any] | None = None,
        outside: Iterable[str] = (),
        overrides: Sequence[tuple[list[str], Any]] = (),
        observers: Sequence[Observer] = (),
        measures: Sequence[str | type[Measure]] = (),
        pacing: str = "instant",
        trace: bool = False,
        events: EventLog | None = None,
        streams: StreamRecorder | None = None,
        remark: Callable[[str, str], None] | None = None,
        allow_not_well_formed: bool = False,
        traffic_maker: Callable[..., Traffic] = Traffic,
    ) -> None:
        if seed < 0:
            raise InputError(f"seed {seed}: must be 0 or greater")
        changes = [*overrides, *as_overrides(set or {})]
        inputs = load_inputs(layout, scenario, controllers, changes)
        plan, work, rules = inputs.layout, inputs.scenario, inputs.controllers
        self.names = name_of(layout), name_of(scenario), name_of(controllers)
        self.inputs = inputs
        self.pacing_named = pacing
        self.pacing_settings = pacing_settings(pacing, inputs.pacing)
        layouts.refuse(plan, self.names[0], allow_not_well_formed=allow_not_well_formed)
        if remark is not None:
            for part, notes in inputs.notes.items():
                for note in notes:
                    remark(part, note)
        self.recorder = measure.Recorder()
        wanted = find_all([*_of_stations(plan), *measures])
        self.measures = [kind() for kind in (*SHIPPED, *wanted)]
        self.log = measure.EventLog() if events is None and trace else events
        planner = planner_settings(rules.choices[Problem.PP], seed)
        slow = work.disturbances.slow
        slower = {} if slow is None else {"slow_shares": (slow.speed_share,)}
        super().__init__(
            plan,
            work,
            rules,
            seed=seed,
            observers=[
                self.recorder,
                *([self.log] if self.log is not None else []),
                *self.measures,
                *observers,
            ],
            outside=outside,
            pacing=_with_answers(self.pacing_settings),
            traffic=traffic_maker(
                plan, record_trace=self.log is not None, planner=planner, **slower
            ),
            streams=streams,
        )

    def fork(self) -> Self:
        """Copy the simulation as it is, a decision that waits included.

        The copy goes on as this one would, bit for bit, and neither changes the other. Layout,
        scenario and tables of travel times, which never change, are shared.

        Raises
        ------
        InputError
            If the pacing is `wall`: a solver at work cannot be copied.
        """
        return forking.fork(self)

    def save(self, path: Path) -> None:
        """Write the simulation as it is into a file, from which `load` goes on.

        Raises
        ------
        InputError
            If the file cannot be written, or the pacing is `wall`.
        """
        saving.save(self, path)

    @classmethod
    def load(cls, path: Path) -> Self:
        """Go on from a file that `save` has written, to the same end, bit for bit.

        The file holds pickled objects, which can run any code: load only what you trust.

        Raises
        ------
        InputError
            If it is no such file, is damaged, or was written by another version of the code.
        """
        return saving.load(cls, path)

    def result(self) -> Run:
        """Return the run: its footprint, its tables, its trace.

        Raises
        ------
        InputError
            If the run has not come to its end: rates and means would be wrong.
        """
        if not self.ended:
            raise InputError(
                f"the run is at {self.now_s:g} s of {self.end_s:g} s: its results come at its end"
            )
        marks = "".join(
            f"{MARK}{choice.problem}={choice.name}@{time_s:.6f}s"
            for time_s, choice in self.interventions
        )
        return Run(
            layout=self.layout,
            scenario=self.scenario,
            controllers=self.controllers,
            names=(*self.names[:2], self.names[2] + marks),
            overrides=self.inputs.overrides,
            notes=self.inputs.notes,
            seed=self.seed,
            pacing=self.pacing_named,
            pacing_settings=self.pacing_settings,
            warmup_s=self.warmup_s,
            duration_s=self.scenario.duration_s,
            end_s=self.end_s,
            wall_s=self.wall_s,
            world=self.world,
            traffic=self.traffic,
            statistics=list(self.deciding.statistics.values()),
            recorder=self.recorder,
            measures=self.measures,
            disturbances=self.disturbances,
            events=self.log,
            interventions=list(self.interventions),
        )


def _of_stations(layout: Layout) -> list[str | type[Measure]]:
    """Measures that kinds of station bring along."""
    return [measure for kind in layout.other_kinds for measure in kind.measures]


def _with_answers(pacing: PacingSettings) -> Paced:
    """Read the answers of a run that is to be replayed."""
    if not isinstance(pacing, ReplayPacing):
        return pacing
    answers = measure.load_run(pacing.run).table("answers").to_dict("records")
    return Replay(pacing, answers)  # type: ignore[arg-type]

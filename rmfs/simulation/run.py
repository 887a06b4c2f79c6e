"""`simulate` and `Simulation`: from names to results, in one call or step by step."""

from __future__ import annotations

import warnings
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar, Self

from rmfs import layout as layouts
from rmfs import measure, room
from rmfs.config import LARGEST_SEED
from rmfs.control.pp import planner_settings
from rmfs.control.problems import Problem
from rmfs.errors import InputError
from rmfs.measure.measures import SHIPPED
from rmfs.measure.provenance import MARK
from rmfs.measure.registry import find_all
from rmfs.simulation import forking, saving
from rmfs.simulation.checkpoints import resumed
from rmfs.simulation.idle_rules import IdleRuleWarning, idle_rules
from rmfs.simulation.inputs import as_overrides, load_inputs, name_of
from rmfs.simulation.kernel import Kernel
from rmfs.simulation.pacing import Replay, ReplayPacing, pacing_settings
from rmfs.simulation.result import Run
from rmfs.traffic import Traffic

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping, Sequence

    from rmfs.control.settings import ControllerSettings
    from rmfs.layout.model import Layout
    from rmfs.measure import EventLog
    from rmfs.measure.base import Measure
    from rmfs.observer import Observer
    from rmfs.scenario import Scenario, StreamRecorder
    from rmfs.simulation.pacing import Paced, PacingSettings

    Driver = Callable[[Kernel, Callable[[float, float], None] | None], None]


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
    measured
        Whether the run is measured; without, it is a little faster and has no result.

    Raises
    ------
    InputError
        If something given is wrong; names what and says what would be valid.
    """

    checks_layout: ClassVar[bool] = True
    """Whether the layout is looked at before the run."""

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
        measured: bool = True,
    ) -> None:
        if not 0 <= seed <= LARGEST_SEED:
            raise InputError(f"seed {seed}: must be between 0 and {LARGEST_SEED}")
        changes = [*overrides, *as_overrides(set or {})]
        inputs = load_inputs(layout, scenario, controllers, changes)
        plan, work, rules = inputs.layout, inputs.scenario, inputs.controllers
        _require_room(plan, work)
        self.names = name_of(layout), name_of(scenario), name_of(controllers)
        self.inputs = inputs
        self.pacing_named = pacing
        self.pacing_settings = pacing_settings(pacing, inputs.pacing)
        if self.checks_layout:
            layouts.refuse(plan, self.names[0], allow_not_well_formed=allow_not_well_formed)
        if remark is not None:
            for part, notes in inputs.notes.items():
                for note in notes:
                    remark(part, note)
        self.measured = measured
        self.recorder = measure.Recorder()
        wanted = find_all([*_of_stations(plan), *measures])
        self.measures = [kind() for kind in (*SHIPPED, *wanted)]
        measuring = [self.recorder, *self.measures] if measured else []
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
                *measuring[:1],
                *([self.log] if self.log is not None else []),
                *measuring[1:],
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

    def save(self, path: str | Path) -> None:
        """Write the simulation as it is into a file, from which `load` goes on.

        Raises
        ------
        InputError
            If the file cannot be written, or the pacing is `wall`.
        """
        saving.save(self, Path(path))

    @classmethod
    def load(cls, path: str | Path) -> Self:
        """Go on from a file that `save` has written, to the same end, bit for bit.

        The file holds pickled objects, which can run any code: load only what you trust.

        Raises
        ------
        InputError
            If it is no such file, is damaged, or was written by another version of the code.
        """
        return saving.load(cls, Path(path))

    def result(self) -> Run:
        """Return the run: its footprint, its tables, its trace.

        Raises
        ------
        InputError
            If the run has not come to its end (rates and means would be wrong), or is not measured.
        """
        if not self.measured:
            raise InputError("a run with measured=False has no results")
        if not self.ended:
            raise InputError(
                f"the run is at {self.now_s:g} s of {self.end_s:g} s: its results come at its end"
            )
        statistics = self.deciding.statistics
        outside = self.phase.outside.problems
        idle = idle_rules(self.world, self.controller_set, statistics, self.end_s, outside)
        for told in idle:
            warnings.warn(told, IdleRuleWarning, stacklevel=2)
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
            statistics=list(statistics.values()),
            recorder=self.recorder,
            measures=self.measures,
            disturbances=self.disturbances,
            events=self.log,
            interventions=list(self.interventions),
            idle_rules=idle,
        )


def _of_stations(layout: Layout) -> list[str | type[Measure]]:
    """Measures that kinds of station bring along."""
    return [measure for kind in layout.other_kinds for measure in kind.measures]


def _with_answers(pacing: PacingSettings) -> Paced:
    """Read the answers of a run that is to be replayed."""
    if not isinstance(pacing, ReplayPacing):
        return pacing
    answers = measure.load_run(pacing.run).table("answers").to_dict("records")
    if not answers:
        raise InputError(f"pacing replay: {pacing.run}: that run asked no optimiser")
    return Replay(pacing, answers)  # type: ignore[arg-type]


def _require_room(plan: Layout, work: Scenario) -> None:
    """Refuse what does not fit into memory."""
    demand = work.demand
    orders = getattr(demand, "orders", 0) or getattr(demand, "initial_orders", 0)
    skus = getattr(work.skus, "count", 0)
    needed = (
        plan.waypoints * room.WAYPOINT_BYTES
        + skus * (plan.pods * room.STOCK_BYTES + room.SKU_BYTES)
        + orders * room.ORDER_BYTES
    )
    told = f"{plan.waypoints} waypoints, {skus} SKUs on {plan.pods} pods, {orders} orders"
    room.require(needed, f"a run with {told}")

"""`simulate` and `Simulation`: run a simulation in one call or step by step."""

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
from rmfs.measure.provenance import marks
from rmfs.measure.registry import find_all
from rmfs.simulation import forking, saving
from rmfs.simulation.checkpoints import resumed
from rmfs.simulation.idle_rules import IdleRuleWarning, idle_rules
from rmfs.simulation.inputs import as_overrides, load_inputs, name_of
from rmfs.simulation.kernel import Kernel
from rmfs.simulation.pacing import Replay, ReplayPacing, pacing_settings
from rmfs.simulation.pacing.planning import Tape, let_plans_take_time
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
        Each given as the name of a shipped one, as the path of a file, or as an object.
    seed
        Seed of all random streams, 0 or greater.
    set
        Parameters by dotted key, as for `--set`: `{"layout.robots": 16}`. A rule can also be given
        as a class: `{"controllers.psa.name": MyRule}`.
    overrides
        Parameters as (path, value) pairs, for example `(["layout", "robots"], 16)`; for a parameter
        that is also in `set`, the value in `set` is used.
    observers
        Objects that are notified of every event, as is the recorder of the standard measures.
    measures
        Additional measures: classes derived from `rmfs.Measure`, or references to them
        (`module:Class`, `path/to/file.py:Class`, or the name of an installed measure).
    driver
        Function that runs the simulation from its first event to its last. The default does so
        without interruption; another function can pause the simulation, for example to save it.
    pacing
        How simulated time accounts for the computation of optimisers: `instant` (not at all),
        `wall`, `work`, `fixed=SECONDS` or `replay=RUN_DIR` (docs: optimisers in the loop).
    trace
        Whether to record the complete motion of the robots and all events.
    events
        Log in which all events are recorded; it can be read during the run. Implies `trace`.
    streams
        Records all arriving orders and bundles, for `rmfs.scenario.write_stream`.
    progress
        Called about a hundred times with the simulated time so far and in total, in s.
    remark
        Called before the run for each note on what the import of RAWSim-O files left out or
        changed. Its arguments are the input concerned (`layout`, ...) and the text of the note.
    allow_not_well_formed
        Whether to accept a layout in which robots may block each other forever.
    traffic_maker
        Creates the traffic layer from the arguments of `Traffic`; used by `rmfs.demonstrator` for
        real and emulated robots.
    resume
        File from which to resume, written by `Simulation.save` in a run with the same inputs. The
        saved run keeps the copies of its observers, so `observers`, `events` and `streams` must be
        left out.

    Raises
    ------
    InputError
        If an argument is wrong; the message names it and the valid values.
    RuleError
        If a user's controller decides something impossible.
    StalledError, OptimiserError, ReplayError
        As for `Simulation.run`.
    """
    if resume is not None and (observers or events is not None or streams is not None):
        raise InputError(
            f"{resume}: a resumed run takes no observers, events or streams; leave them out, or "
            "use Simulation.load"
        )
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
    """A run that can be simulated in steps, with the same results as those of `simulate`.

    Parameters
    ----------
    layout, scenario, controllers, seed, set, overrides, observers, measures, pacing, trace, \
events, streams, remark, allow_not_well_formed, traffic_maker
        As for `simulate`.
    outside
        Decision problems decided outside the simulation, such as `["poa", "pps"]`; `step`
        simulates up to the next of these decisions and returns it.
    measured
        Whether to measure the run. If not, it is slightly faster and has no result.

    Raises
    ------
    InputError
        If an argument is wrong; the message names it and the valid values.
    """

    checks_layout: ClassVar[bool] = True
    """Whether layouts are checked before the run; a subclass may switch this off."""

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
        if isinstance(seed, bool) or not hasattr(seed, "__index__"):
            raise InputError(f"seed {seed!r}: must be a whole number")
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
        planner = planner_settings(rules.choices[Problem.PP], seed, plan)
        slow = work.disturbances.slow
        slower = {} if slow is None else {"slow_shares": (slow.speed_share,)}
        traffic = traffic_maker(plan, record_trace=self.log is not None, planner=planner, **slower)
        let_plans_take_time(traffic, self.pacing_settings.planning, planner.name, _plans_of)
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
            traffic=traffic,
            streams=streams,
        )

    def fork(self) -> Self:
        """Copy the simulation in its current state, including a pending decision.

        The copy continues exactly as the original would, bit for bit, and the two are independent.
        Layout, scenario and tables of travel times, which never change, are shared.

        Raises
        ------
        InputError
            If the pacing, or the pacing of path planning, is `wall`: a copy could not continue
            identically.
        """
        return forking.fork(self)

    def save(self, path: str | Path) -> None:
        """Save the simulation in its current state to a file, from which `load` resumes.

        Raises
        ------
        InputError
            If the file cannot be written, or if the pacing, or the pacing of path planning, is
            `wall`.
        """
        saving.save(self, Path(path))

    @classmethod
    def load(cls, path: str | Path) -> Self:
        """Resume a simulation from a file written by `save`, with identical results.

        The file contains pickled objects, which can execute code: load only trusted files.

        Raises
        ------
        InputError
            If the file is not valid, is damaged, or was written by another version of the code.
        """
        return saving.load(cls, Path(path))

    def __getstate__(self) -> dict[str, Any]:
        """Return the state, unless it could not continue identically."""
        if self.pacing_settings.planning.mode == "wall":
            raise InputError(
                "a run with pacing.planning wall cannot be copied: the copy would take other times"
            )
        return super().__getstate__()

    def result(self) -> Run:
        """Return the finished run with its footprint, tables and trace.

        Issues an `IdleRuleWarning` for each rule that decided nothing for a long time although work
        waited.

        Raises
        ------
        InputError
            If the run has not ended (rates and means would be wrong), or is not measured.
        """
        if not self.measured:
            raise InputError("a run with measured=False has no results")
        if not self.ended:
            raise InputError(
                f"the run is at {self.now_s:g} s of {self.end_s:g} s and has no results yet"
            )
        statistics = self.deciding.statistics
        outside = self.phase.outside.problems
        idle = idle_rules(self.world, self.controller_set, statistics, self.end_s, outside)
        for told in idle:
            warnings.warn(told, IdleRuleWarning, stacklevel=2)
        return Run(
            layout=self.layout,
            scenario=self.scenario,
            controllers=self.controllers,
            names=(*self.names[:2], self.names[2] + marks(self.interventions)),
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
    """Return the measures of the layout's kinds of station."""
    return [measure for kind in layout.other_kinds for measure in kind.measures]


def _with_answers(pacing: PacingSettings) -> Paced:
    """Read the answers of the run to replay."""
    if not isinstance(pacing, ReplayPacing):
        return pacing
    answers = measure.load_run(pacing.run).table("answers").to_dict("records")
    if not answers:
        raise InputError(f"pacing replay: {pacing.run}: no optimiser was asked in that run")
    return Replay(pacing, answers)  # type: ignore[arg-type]


def _plans_of(run: Path) -> tuple[dict[str, Any], Tape]:
    """Read how plans took time in a run, and its searches."""
    folder = measure.load_run(run)
    rows = folder.table("plans")
    columns = (rows[name].tolist() for name in ("robot", "begun_us", "labels", "took_us"))
    return folder.parameters["pacing_parameters"]["planning"], list(zip(*columns, strict=True))


def _require_room(plan: Layout, work: Scenario) -> None:
    """Refuse a run that does not fit into memory."""
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

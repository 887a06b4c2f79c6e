"""`simulate`: one call from names to results."""

from __future__ import annotations

import time
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rmfs import control, measure
from rmfs import layout as layouts
from rmfs import scenario as scenarios
from rmfs.control.pp import planner_settings
from rmfs.control.problems import Problem
from rmfs.control.settings import ControllerSettings
from rmfs.errors import InputError
from rmfs.layout.model import Layout
from rmfs.scenario import Scenario
from rmfs.simulation.pacing import pacing_settings
from rmfs.simulation.simulation import Simulation
from rmfs.traffic import Traffic

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    import pandas as pd
    from numpy.typing import NDArray

    from rmfs.measure import EventLog, Recorder
    from rmfs.measure.observer import Observer
    from rmfs.scenario import StreamRecorder
    from rmfs.simulation.pacing import PacingSettings
    from rmfs.simulation.statistics import DecisionStatistics
    from rmfs.world import World

Overrides = list[tuple[list[str], Any]]


@dataclass
class Run:
    """A run that has ended.

    Attributes
    ----------
    layout, scenario, controllers
        What was simulated, after overrides.
    names
        Layout, scenario and controllers as the user named them.
    overrides
        The overrides given, as pairs of path and value.
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
        What was measured.
    events
        What happened; only if the run was asked to record its trace.
    """

    layout: Layout
    scenario: Scenario
    controllers: ControllerSettings
    names: tuple[str, str, str]
    overrides: Overrides
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
    events: EventLog | None = None

    @cached_property
    def footprint(self) -> pd.Series[Any]:
        """Measures of the whole run; one row of `footprint.csv`."""
        return measure.footprint(self)

    @cached_property
    def series(self) -> pd.DataFrame:
        """Measures minute by minute."""
        return measure.series(self)

    @cached_property
    def decisions(self) -> pd.DataFrame:
        """Measures per decision problem."""
        return measure.decisions(self)

    @property
    def trace(self) -> dict[str, NDArray[Any]]:
        """Every piece of motion; only if the run was asked to record it."""
        return self.traffic.trace()


def simulate(
    layout: str | Path | Layout,
    scenario: str | Path | Scenario,
    controllers: str | Path | ControllerSettings,
    *,
    seed: int = 0,
    overrides: Sequence[tuple[list[str], Any]] = (),
    observers: Sequence[Observer] = (),
    pacing: str = "instant",
    trace: bool = False,
    streams: StreamRecorder | None = None,
    progress: Callable[[float, float], None] | None = None,
    allow_not_well_formed: bool = False,
) -> Run:
    """Simulate a warehouse.

    Parameters
    ----------
    layout, scenario, controllers
        Names of shipped instances, paths, or the objects themselves.
    seed
        Seed of all random streams, 0 or greater.
    overrides
        Pairs of path and value, for example `(["layout", "robots"], 16)`, applied to what is read
        from files.
    observers
        Told of everything that happens, besides the recorder of the usual measures.
    pacing
        What the thinking of optimisers costs in simulated time: `instant` for nothing, `wall`,
        `work`, `fixed=SECONDS` or `replay=RUN_DIR` (docs: optimisers in the loop).
    trace
        Whether every piece of motion and everything that happens is kept.
    streams
        Keeps all orders and bundles that come, to be written by `rmfs.scenario.write_stream`.
    progress
        Called with the simulated time so far and in total, about a hundred times.
    allow_not_well_formed
        Whether to run a layout in which robots may block each other for ever.

    Raises
    ------
    InputError
        If something given is wrong; names what and says what would be valid.
    """
    given = _split(overrides)
    plan = _loaded(layout, Layout, layouts.load, given["layout"])
    work = _loaded(scenario, Scenario, scenarios.load, given["scenario"])
    rules = _loaded(controllers, ControllerSettings, control.load, given["controllers"])
    if seed < 0:
        raise InputError(f"seed {seed}: must be 0 or greater")
    pace = pacing_settings(pacing, given["pacing"])
    layouts.refuse(plan, _name(layout), allow_not_well_formed=allow_not_well_formed)
    recorder = measure.Recorder()
    events = measure.EventLog() if trace else None
    planner = planner_settings(rules.choices[Problem.PP], seed)
    traffic = Traffic(plan, record_trace=trace, planner=planner)
    simulation = Simulation(
        plan,
        work,
        rules,
        seed=seed,
        observers=[recorder, *([events] if events is not None else []), *observers],
        pacing=pace,
        traffic=traffic,
        streams=streams,
    )
    begun = time.perf_counter()
    simulation.run(progress)
    wall_s = time.perf_counter() - begun
    return Run(
        layout=plan,
        scenario=work,
        controllers=rules,
        names=(_name(layout), _name(scenario), _name(controllers)),
        overrides=list(overrides),
        seed=seed,
        pacing=pacing,
        pacing_settings=pace,
        warmup_s=work.warmup_s,
        duration_s=work.duration_s,
        end_s=simulation.end_s,
        wall_s=wall_s,
        world=simulation.world,
        traffic=traffic,
        statistics=list(simulation.phase.statistics.values()),
        recorder=recorder,
        events=events,
    )


def _split(overrides: Sequence[tuple[list[str], Any]]) -> dict[str, Overrides]:
    """Sort overrides by the part they are for."""
    parts: dict[str, Overrides] = {"layout": [], "scenario": [], "controllers": [], "pacing": []}
    for path, value in overrides:
        if path[0] not in parts or len(path) < 2:
            raise InputError(
                f"--set {'.'.join(path)}: must begin with layout., scenario., controllers. "
                "or pacing."
            )
        parts[path[0]].append((path[1:], value))
    return parts


def _loaded(given: Any, kind: type, load: Callable[..., Any], overrides: Overrides) -> Any:
    """Load a part unless it is an object already, which overrides cannot change."""
    if not isinstance(given, kind):
        return load(str(given), overrides)
    if overrides:
        path = ".".join(overrides[0][0])
        raise InputError(f"--set {path}: {kind.__name__} was given as an object, not as a file")
    return given


def _name(given: Any) -> str:
    return Path(given).stem if isinstance(given, str | Path) else str(given.name)

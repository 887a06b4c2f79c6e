"""Whole runs with real traffic: conservation, repetition, and nobody idle while there is work."""

from __future__ import annotations

import gc
import weakref

import pytest
from ledger import Ledger

from rmfs import Simulation, control, layout, scenario, simulate
from rmfs.errors import InputError
from rmfs.observer import Observer
from rmfs.simulation.kernel import Kernel


def run(
    controllers: str,
    seed: int = 0,
    robots: int = 16,
    duration_s: float = 1200.0,
    observers: tuple[Observer, ...] = (),
    scenario_name: str = "basic",
) -> tuple[Kernel, Ledger]:
    plan = layout.load("basic", [(["robots"], robots)])
    work = scenario.load(scenario_name, [(["duration_s"], duration_s), (["warmup_s"], 0.0)])
    ledger = Ledger()
    simulation = Kernel(
        plan, work, control.load(controllers), seed=seed, observers=[ledger, *observers]
    )
    for watch in observers:
        watch.simulation = simulation
    simulation.run()
    return simulation, ledger


@pytest.mark.parametrize(
    ("controllers", "scenario_name"),
    [("default", "basic"), ("random", "basic"), ("random", "pp-minimal")],
)
def test_stock_and_requests_are_conserved(controllers, scenario_name) -> None:
    simulation, ledger = run(controllers, scenario_name=scenario_name)
    ledger.check()
    assert simulation.world.orders_completed > 50
    assert simulation.world.bundles_stored > 100


def test_three_times_the_robots() -> None:
    """48 robots, of which 18 at most find work: the others rest beneath pods, and nothing jams."""
    few, _ = run("default", robots=16)
    many, ledger = run("default", robots=48)
    ledger.check()
    assert len(many.world.resting) > 16
    assert many.world.units_picked >= 0.98 * few.world.units_picked
    beneath_pods = [
        many.world.storage.pod_at[robot.waypoint] >= 0 for robot in many.world.resting.values()
    ]
    assert all(beneath_pods)


def test_the_same_seed_gives_the_same_events() -> None:
    first, second = run("default", seed=3)[1], run("default", seed=3)[1]
    assert first.log == second.log
    assert len(first.log) > 400
    assert run("default", seed=4)[1].log != first.log


class IdleWatch(Observer):
    """Checks every minute that no robot rests although PPS would find a pod for its station."""

    simulation: Kernel
    checked = 0

    def sampled(self, time_s) -> None:
        view, panel = self.simulation.view, self.simulation.controller_set
        ta, pps = panel["ta"], panel["pps"]
        for robot in view.resting.values():
            station = ta._station_of[robot.index]
            if station < 0 or not ta.may_work(robot, station):
                continue
            self.checked += 1
            if station < len(view.pick_stations):
                pod = pps.pick_pod(robot, view.pick_stations[station])
            else:
                index = station - len(view.pick_stations)
                pod = pps.replenishment_pod(robot, view.replenishment_stations[index])
            assert pod < 0, f"robot {robot.index} rests at {time_s} s; pod {pod} has work"


def test_no_robot_rests_while_its_station_has_work_for_it() -> None:
    watch = IdleWatch()
    run("default", robots=32, duration_s=3600.0, observers=(watch,))
    assert watch.checked > 50


def test_the_warm_up_and_the_samples() -> None:
    class Calls(Observer):
        def __init__(self) -> None:
            self.calls: list[tuple[str, float]] = []

        def warmup_ended(self, time_s):
            self.calls.append(("warm-up", time_s))

        def sampled(self, time_s):
            self.calls.append(("sample", time_s))

        def run_ended(self, time_s):
            self.calls.append(("end", time_s))

    calls = Calls()
    work = scenario.load("basic", [(["duration_s"], 150.0), (["warmup_s"], 30.0)])
    Kernel(layout.load("basic"), work, control.load("default"), observers=[calls]).run()
    assert calls.calls == [("warm-up", 30.0), ("sample", 90.0), ("sample", 150.0), ("end", 180.0)]


@pytest.mark.parametrize("stepwise", [False, True])
def test_a_run_ends_at_the_nearest_microsecond(stepwise) -> None:
    # in floating-point numbers, 424.4 + 600 is slightly more than 1024.4
    work = scenario.load("basic", [(["duration_s"], 600.0), (["warmup_s"], 424.4)])
    simulation = Kernel(layout.load("basic"), work, control.load("default"))
    if stepwise:
        simulation.run_until(1024.4)
    else:
        simulation.run()
    assert simulation.ended
    assert simulation.now_us == 1_024_400_000


class TestSimulate:
    def test_from_names(self) -> None:
        told: list[tuple[float, float]] = []
        result = simulate(
            "basic",
            "basic",
            "random",
            seed=1,
            overrides=[(["scenario", "duration_s"], 60.0), (["controllers", "psa"], "nearest")],
            trace=True,
            progress=lambda done, total: told.append((done, total)),
        )
        assert result.names == ("basic", "basic", "random")
        assert (result.warmup_s, result.duration_s, result.end_s) == (0.0, 60.0, 60.0)
        assert result.world.bundles_created > 0
        assert len(result.trace["robot"]) > 0
        assert told[0] == (0.0, 60.0)
        assert told[-1] == (60.0, 60.0)
        assert len(told) == 101

    @pytest.mark.parametrize(
        ("arguments", "message"),
        [
            ({"overrides": [(["rules", "psa"], 1)]}, "must begin with layout., scenario., con"),
            ({"overrides": [(["scenario"], 1)]}, "must begin with"),
            ({"pacing": "slow"}, "pacing slow: unknown mode; valid: instant"),
            ({"seed": -1}, "seed -1"),
            ({"controllers": "defalt"}, "did you mean default?"),
        ],
    )
    def test_mistakes_are_named(self, arguments, message) -> None:
        given = {"layout": "basic", "scenario": "basic", "controllers": "default"} | arguments
        with pytest.raises(InputError) as error:
            simulate(**given)
        assert message in str(error.value)

    def test_objects_cannot_be_overridden(self) -> None:
        plan = layout.load("basic")
        with pytest.raises(InputError, match="given as an object"):
            simulate(plan, "basic", "default", overrides=[(["layout", "robots"], 3)])


def test_finished_runs_are_left_to_the_garbage_collector() -> None:
    """No run freezes objects: frozen ones are freed by full collections only, if at all."""
    frozen = []

    def finished() -> weakref.ref[Simulation]:
        simulation = Simulation("small", "small", seed=1, set={"scenario.duration_s": 20})
        simulation.run(lambda now_s, end_s: frozen.append(gc.get_freeze_count()))
        return weakref.ref(simulation)

    before = gc.get_freeze_count()
    run = finished()
    gc.collect()
    assert run() is None
    assert set(frozen) == {before}

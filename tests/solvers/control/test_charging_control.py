"""CA by a model in whole runs: it decides, repeats, gives way to its rule, and can be exchanged."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import rmfs
from rmfs.control.asks import Ask, Call
from rmfs.control.problems import Problem
from rmfs.measure.dictionary import reproducible
from rmfs.solvers.control.charging import ScheduleControl
from rmfs.solvers.control.tasks.dispatch import DispatchControl
from tests.simulation.energy_ledger import EnergyLedger

SITE = {
    "layout.robots": 10,
    "layout.other_stations.charger": {
        "kind": "charger",
        "north": 2,
        "parameters": {"power_w": 800.0},
    },
    "scenario.energy.battery": {
        "capacity_wh": 100,
        "initial_least_share": 0.4,
        "initial_most_share": 0.7,
    },
    "scenario.warmup_s": 0,
    "scenario.duration_s": 1800,
    "controllers.ca.name": "schedule",
}
SWAP = {
    "layout.other_stations.charger.north": 0,
    "layout.other_stations.swap": {
        "kind": "swap",
        "north": 2,
        "parameters": {"swap_s": 60.0, "batteries": 3},
    },
}


def simulate(seed: int = 1, **more: Any) -> Any:
    ledger = EnergyLedger()
    given = SITE | {name: value for name, value in more.items() if "." in name}
    rest = {name: value for name, value in more.items() if "." not in name}
    run = rmfs.simulate(seed=seed, set=given, trace=True, observers=[ledger], **rest)
    ledger.check(run)
    assert run.check().ok
    return run


@pytest.mark.parametrize("method", ["highs", "cp_sat", "greedy"])
def test_robots_go_when_the_schedule_says(method: str) -> None:
    run = simulate(**{"controllers.ca.method": method})
    found = run.footprint
    assert found["robots_stranded"] == 0
    assert found["charges"] > 5
    assert found["optimiser_failures"] == 0
    # those that the guard sends are nobody's decision; the first are sent before an answer
    assert found["optimiser_decision_share"] > 0.9
    asked = run.decisions[run.decisions["source"] == "optimiser"]
    assert set(asked["problem"]) == {"ca"}
    assert set(asked["backend"]) <= {"rule", method}
    assert len(asked) == pytest.approx(30, abs=3)


def test_robots_that_swap_batteries() -> None:
    run = simulate(**SWAP)
    assert run.footprint["robots_stranded"] == 0
    assert run.footprint["charges"] > 3
    assert run.footprint["optimiser_decision_share"] > 0.9


def test_repeats_when_thinking_takes_time() -> None:
    one, other = (simulate(pacing="work") for _ in range(2))
    columns = reproducible("footprint")
    assert one.footprint[columns].to_csv() == other.footprint[columns].to_csv()
    assert one.footprint["paced_s"] > 0


def test_late_answers_are_applied_as_far_as_they_hold() -> None:
    run = simulate(pacing="fixed=40")
    assert run.footprint["optimiser_decision_share"] > 0
    assert run.footprint["robots_stranded"] == 0


def test_the_rule_decides_where_there_is_no_answer(monkeypatch: pytest.MonkeyPatch) -> None:
    def fail(self: Any, batteries: Any) -> None:
        return None

    monkeypatch.setattr(ScheduleControl, "_question", fail)
    run = simulate(**{"controllers.ca.below_share": 0.45, "controllers.ca.until_share": 0.6})
    assert run.footprint["charges"] > 5
    levels = run.table("robots")["level_wh"] / 100.0
    assert levels.max() < 0.75  # who has the upper level leaves, though it was sent for more


def test_without_batteries_or_places_nothing_is_asked() -> None:
    for given in (
        {"scenario.energy.battery": None, "layout.other_stations.charger.north": 0},
        {
            "layout.other_stations.charger.north": 0,
            "scenario.energy.inductive": {"power_w": 400.0},
            "scenario.energy.battery.capacity_wh": 600,
        },
    ):
        run = rmfs.simulate(seed=1, set=SITE | given | {"scenario.duration_s": 600})
        assert run.footprint["optimiser_calls"] == 0


def test_questions_tell_levels_places_and_who_is_there() -> None:
    simulation = rmfs.Simulation(seed=1, set=SITE | {"controllers.ca.name": "threshold"})
    simulation.run_until(1500)
    view = simulation.view
    made = ScheduleControl(ScheduleControl.parameters_model(), view, np.random.default_rng(0))
    asked = next(one for one in made.decide() if isinstance(one, Ask))
    data = asked.question.data
    np.testing.assert_allclose(data.level, view.batteries.shares())
    there = {s.robot for s in view.chargers if s.robot in s.tasks}
    assert set(np.flatnonzero(data.here == 0).tolist()) == there
    assert data.places[:, 0].tolist() == [2]
    assert data.gain[0] == pytest.approx(0.1)
    call = Call(0, Problem.CA, made, asked, 0, "")
    call.answer = asked.solve(asked.question)
    assert call.answer.bound <= call.answer.objective + 1e-6


def test_dispatch_sends_robots_with_more_energy_first() -> None:
    """What is missing in a battery counts as a longer way."""
    site = {name: value for name, value in SITE.items() if name != "controllers.ca.name"}
    simulation = rmfs.Simulation("default", "default", "ta-balance", seed=1, set=site)
    simulation.run_until(200)
    for empty_s in (0.0, 500.0):
        made: Any = DispatchControl(
            DispatchControl.parameters_model(empty_battery_s=empty_s),
            simulation.view,
            np.random.default_rng(0),
        )
        robots = simulation.view.robots[:2]
        shares = simulation.view.batteries.shares()[:2]
        longer = [made._low_s(robot) for robot in robots]
        assert longer == pytest.approx([empty_s * (1 - share) for share in shares])
    run = simulate_dispatch(0.0), simulate_dispatch(2000.0)
    assert run[0]["units_picked"] > 0
    assert run[1]["units_picked"] > 0
    # those with little energy are spared, so that levels stay closer together
    assert run[1]["spread"] < run[0]["spread"]


def simulate_dispatch(empty_s: float) -> dict[str, float]:
    given = SITE | {
        "layout.robots": 16,
        "layout.pick_stations.east": 1,
        "layout.replenishment_stations.west": 1,
        "scenario.energy.battery": {"capacity_wh": 300, "initial_least_share": 0.5},
        "scenario.duration_s": 1200,
        "controllers.ca.name": "threshold",
        "controllers.ta.empty_battery_s": empty_s,
    }
    run = rmfs.simulate("default", "default", "ta-balance", seed=2, set=given)
    levels = run.table("robots")["level_wh"]
    return {"units_picked": run.footprint["units_picked"], "spread": float(levels.std())}


def test_candidates_of_ta_tell_the_level() -> None:
    for given, told in ((SITE, True), ({"layout.robots": 10}, False)):
        simulation = rmfs.Simulation(seed=1, outside=["ta"], set=given)
        decision = simulation.step()
        assert decision is not None
        assert ("level_share" in decision.candidates.frame().columns) == told

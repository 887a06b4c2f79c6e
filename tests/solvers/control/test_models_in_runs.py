"""Every shipped set of controllers that ask a model, in short runs on a real floor."""

from __future__ import annotations

from typing import Any

import pytest

import rmfs
from rmfs.measure.checker import check
from rmfs.measure.dictionary import reproducible

DECIDES = {
    "psa-placement": {"psa"},
    "psa-prices": {"psa"},
    "psa-stays": {"psa"},
    "ta-matching": {"ta"},
    "ta-balance": {"ta"},
    "ta-routes": {"ta"},
    "planning": {"ta"},
    "stocking": {"rps"},
    "solver": {"poa", "psa", "ta", "rps"},
}


ALONE = [name for name in DECIDES if name != "solver"]


def overrides(duration_s: float) -> list[tuple[list[str], Any]]:
    """Half of the default floor, six robots, few SKUs, bundles from the beginning."""
    return [
        (["layout", "robots"], 6),
        (["layout", "pick_stations", "east"], 2),
        (["layout", "replenishment_stations", "west"], 2),
        (["layout", "horizontal_aisles"], 4),
        (["scenario", "warmup_s"], 0),
        (["scenario", "duration_s"], duration_s),
        (["scenario", "skus", "count"], 200),
        (["scenario", "replenishment", "resume_below_share"], 0.8),
        (["scenario", "replenishment", "pause_above_share"], 0.9),
    ]


def run(controllers: str, duration_s: float, **more: Any) -> Any:
    """Simulate, with the whole trace checked."""
    settings = overrides(duration_s)
    if "rps" in DECIDES[controllers]:
        settings += [
            (["controllers", "rps", "work_s"], 0.003),
            (["controllers", "rps", "bundles"], 10),
        ]
    made = rmfs.simulate("default", "default", controllers, seed=2, overrides=settings, **more)
    if more.get("trace"):
        report = check(made.layout, made.trace, round(made.end_s * 1e6))
        assert report.ok, report.summary()
    return made


@pytest.mark.parametrize("controllers", DECIDES)
def test_works_and_decides_by_its_model(controllers: str) -> None:
    """Units are picked, bundles stored, and nine of ten decisions come from a solution."""
    made = run(controllers, 450.0 if "rps" in DECIDES[controllers] else 600.0, trace=True)
    found = made.footprint
    assert found["units_picked"] > 40
    assert found["bundles_stored"] > 2
    assert found["optimiser_decision_share"] >= 0.9
    assert found["optimiser_failures"] == 0
    asked = made.decisions[made.decisions["source"] == "optimiser"]
    assert set(asked["problem"]) == DECIDES[controllers]
    assert asked["applied"].sum() > 10
    assert set(asked["status"]) <= {"optimal", "feasible"}


@pytest.mark.parametrize("controllers", ALONE)
def test_the_rule_that_the_solver_starts_from_can_decide_alone(controllers: str) -> None:
    """The arm that tells what solving is worth: the same controller, asking as often."""
    (problem,) = DECIDES[controllers]
    settings = [*overrides(200.0), (["controllers", problem, "method"], "greedy")]
    made = rmfs.simulate("default", "default", controllers, seed=2, overrides=settings)
    asked = made.decisions[made.decisions["source"] == "optimiser"]
    # planning counts visits in a unit of its own, whoever decides
    assert set(asked["backend"]) <= {"rule", "visits"}
    assert asked["applied"].sum() > 0


@pytest.mark.parametrize("controllers", ALONE)
def test_repeats_when_thinking_takes_time(controllers: str) -> None:
    """Under `work` pacing two runs agree, and what has become stale meanwhile is dropped."""
    one, other = (run(controllers, 200.0, pacing="work") for _ in range(2))
    columns = reproducible("footprint")
    assert one.footprint[columns].to_csv() == other.footprint[columns].to_csv()
    assert one.footprint["paced_s"] > 0.0


@pytest.mark.parametrize("controllers", ALONE)
def test_late_answers_are_applied_as_far_as_they_hold(controllers: str) -> None:
    """An answer that takes 20 s finds another world: the rest is dropped, the rule stands in."""
    made = run(controllers, 400.0, pacing="fixed=20", trace=True)
    asked = made.decisions[made.decisions["source"] == "optimiser"]
    assert asked["applied"].sum() > 0
    assert made.footprint["units_picked"] > 15
    if "ta" in DECIDES[controllers] and controllers != "planning":  # which keeps to its last plan
        assert made.footprint["heuristic_decision_share"] > 0.0

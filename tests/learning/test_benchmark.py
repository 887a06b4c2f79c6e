"""The benchmark: its table from made-up results, its bounds, and its designs."""

from __future__ import annotations

from itertools import combinations
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from rmfs.experiments.design.planning import plan
from rmfs.experiments.papers.late_bound import fewest_late
from rmfs.experiments.papers.learning import (
    LATE,
    UNITS,
    best_rule,
    compared,
    fewest_late_mean,
    most_units,
    with_goals,
)
from rmfs.experiments.results import load
from rmfs.experiments.running import run

AT_BEST = {"backlog, tight": 220.0, "arrivals, tight": 4.0}
RULES = "default rules (best rule)"


def results(**gains: float) -> pd.DataFrame:
    """Ten seeds of a regime per goal; an arm is so much better than the default rules."""
    draw = np.random.default_rng(1)
    rows = []
    for regime in ("backlog, tight", "arrivals, tight"):
        for seed in range(10):
            common = draw.normal(0, 5)
            for policy, gain in {"default rules": 0.0, **gains}.items():
                own = gain + common + draw.normal(0, 1)
                rows.append(
                    {
                        "regime": regime,
                        "policy": policy,
                        "arm": f"{regime} {policy}",
                        "replication": seed,
                        UNITS: 200 + own,
                        "orders_late": 30 - own,
                        "orders_overdue_end": 10,
                        "units_per_h_bound": 660.0,
                        "duration_s": 1200.0,
                        "on_time_share": 0.6,
                        "order_turnover_mean_s": 300.0,
                        "bundles_per_h": 40.0,
                        "cpu_s": 1.0,
                    }
                )
    return with_goals(pd.DataFrame(rows))


def test_gains_have_one_sign_whatever_the_goal() -> None:
    made = results(**{"POA due-time": 2.0, "TA tried": 6.0, "linear": -3.0})
    frame = compared(made, AT_BEST).frame
    for regime in ("backlog, tight", "arrivals, tight"):
        tried = frame.loc[f"{regime}, TA tried"]
        assert tried["gain on default", "mean"] == pytest.approx(6.0, abs=1.5)
        assert tried["gain on best rule", "mean"] == pytest.approx(4.0, abs=1.5)
        assert tried["gain on default", "p"] < 0.001
        assert frame.loc[f"{regime}, linear"]["gain on default", "mean"] < -1.0
        assert f"{regime}, POA due-time (best rule)" in frame.index


def test_the_share_of_the_room_is_that_between_the_rules_and_the_bound() -> None:
    made = results(**{"TA tried": 6.0})
    frame = compared(made, AT_BEST).frame
    for regime, sign in (("backlog, tight", 1.0), ("arrivals, tight", -1.0)):
        rules, tried = (frame.loc[f"{regime}, {one}"] for one in (RULES, "TA tried"))
        moved = sign * (tried["goal", "mean"] - rules["goal", "mean"])
        room = sign * (AT_BEST[regime] - rules["goal", "mean"])
        assert tried["bound", ""] == AT_BEST[regime]
        assert tried["share of the room", ""] == pytest.approx(moved / room)
        assert 0 < tried["share of the room", ""] < 1


def test_networks_are_compared_with_the_best_linear_rule() -> None:
    arms = {"linear, units": 1.0, "linear, due times": 4.0, "PPO, units": 7.0}
    frame = compared(results(**arms), AT_BEST).frame
    for regime in ("backlog, tight", "arrivals, tight"):
        gains = frame.loc[f"{regime}, PPO, units"]["gain on best linear rule", "mean"]
        assert gains == pytest.approx(3.0, abs=1.5)
        assert np.isnan(frame.loc[f"{regime}, linear, due times"]["gain on best linear rule", "p"])
    without = compared(results(**{"linear, units": 1.0}), AT_BEST).frame
    assert "gain on best linear rule" not in without.columns.get_level_values(0)


def test_orders_that_are_never_done_are_late_too() -> None:
    made = results()
    assert (made[LATE] == made["orders_late"] + 10).all()
    assert most_units(made) == pytest.approx(220.0)


def test_the_best_rule_is_neither_trained_nor_tried_nor_an_optimiser() -> None:
    better = {
        "TA tried": 9.0,
        "linear, units": 8.0,
        "PPO, units": 8.5,
        "optimiser, split orders": 12.0,
    }
    made = results(**{"POA due-time": 1.0, **better})
    for regime, goal in (("backlog, tight", UNITS), ("arrivals, tight", LATE)):
        assert best_rule(made[made["regime"] == regime], goal) == "POA due-time"


def in_time(released_s: np.ndarray, due_s: np.ndarray, work_s: np.ndarray) -> bool:
    """Whether one station that may interrupt work can do all orders: earliest due time first."""
    left, now_s = work_s.copy(), 0.0
    while left.any():
        ready = np.flatnonzero((left > 0) & (released_s <= now_s))
        later = released_s[released_s > now_s]
        if not len(ready):
            now_s = later.min()
            continue
        first = ready[due_s[ready].argmin()]
        until_s = min(now_s + left[first], later.min(initial=np.inf))
        left[first] -= until_s - now_s
        now_s = until_s
        if left[first] == 0 and now_s > due_s[first]:
            return False
    return True


def fewest_by_trying(released_s: np.ndarray, due_s: np.ndarray, work_s: np.ndarray) -> int:
    count = len(work_s)
    for late in range(count + 1):
        for kept in combinations(range(count), count - late):
            rows = list(kept)
            if in_time(released_s[rows], due_s[rows], work_s[rows]):
                return late
    raise AssertionError


def test_the_bound_on_late_orders_is_never_above_the_best_schedule() -> None:
    draw = np.random.default_rng(7)
    gaps = []
    for _ in range(60):
        released_s = draw.integers(0, 60, 7).astype(float)
        work_s = draw.integers(1, 4, 7) * 10.0
        due_s = released_s + draw.integers(10, 60, 7)
        best = fewest_by_trying(released_s, due_s, work_s)
        found = fewest_late(released_s, due_s, work_s, 1)
        assert found <= best
        gaps.append(best - found)
    assert np.mean(gaps) < 1.0  # and not far below it
    assert gaps.count(0) > 20


def test_the_bound_on_late_orders_by_hand() -> None:
    none = np.zeros(0)
    assert fewest_late(none, none, none, 2) == 0
    start, due, work = np.zeros(5), np.full(5, 20.0), np.full(5, 10.0)
    assert fewest_late(start, due, work, 1) == 3
    assert fewest_late(start, due, work, 2) == 1
    assert fewest_late(start, due, work, 3) == 0
    # an order that takes longer than it has is late, whatever else waits
    assert fewest_late(np.array([0.0, 100.0]), np.array([90.0, 110.0]), np.array([10.0, 30.0]), 1)


def test_the_mean_bound_counts_orders_due_in_the_measured_time() -> None:
    orders = pd.DataFrame(
        {
            "replication": [0] * 5 + [1] * 2,
            "created_s": 600.0,
            "due_s": [620.0] * 5 + [590.0, 2000.0],
            "units": 3,
            "start_s": 600.0,
            "end_s": 1800.0,
        }
    )
    # five orders of 30 s in 30 s (with the unit under way at the due time); then none is due
    assert fewest_late_mean(orders, 1, 10.0) == pytest.approx(2.0)
    assert fewest_late_mean(orders, 2, 10.0) == pytest.approx(1.5)


@pytest.mark.parametrize(
    ("design", "arms"),
    [("learning", 36), ("learning-sites", 20), ("learning-ppo", 40), ("learning-ppo-sites", 20)],
)
def test_designs_can_be_planned_with_seeds_that_no_training_has_seen(
    design: str, arms: int
) -> None:
    made = plan(design)
    assert len(made.arms) == arms
    assert min(made.design.seeds) > 1000
    assert max(made.design.seeds) < 1_000_000  # where the seeds of `rmfs learn-network` begin


@pytest.mark.parametrize("regime", ["backlog, tight", "arrivals, tight"])
def test_the_arms_of_networks_run(regime: str, tmp_path: Path) -> None:
    wanted = {"PPO, units", "PPO, due times"}
    without = [
        arm.name
        for arm in plan("learning-ppo").arms
        if arm.levels["policy"] not in wanted or arm.levels["regime"] != regime
    ]
    short = {"scenario.duration_s": 200.0, "scenario.warmup_s": 0.0}
    made = plan("learning-ppo", replications=1, base=short, without=without)
    assert not run(made, tmp_path, processes=1).failed
    frame = load(tmp_path)
    assert set(frame["policy"]) == wanted
    assert sorted(frame["controllers"]) == ["network-due", "network-units"]
    assert (frame["units_picked"] > 0).all()

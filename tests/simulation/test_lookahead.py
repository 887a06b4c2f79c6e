"""Looking ahead: trials meet no truth, change nothing, repeat, and are charged for."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from doubles import Situation, small_layout
from test_stepping import told

import rmfs
from rmfs.control.decisions import AssignOrder
from rmfs.control.halving import Comparison, solve
from rmfs.control.lookahead import Goal, Tried
from rmfs.control.problems import Problem
from rmfs.errors import InputError
from rmfs.simulation.lookahead import Earnings

GOAL = Goal(orders=1.0, overdue_s=0.01, distance_m=0.001)
DISTURBED = {
    "scenario.disturbances.breakdowns": {"every_s": 60, "lasting_s": 20},
    "scenario.disturbances.late_motions": {"probability": 0.05},
}


def made(scenario: str = "small-arrivals", pacing: str = "instant", **given: Any) -> Any:
    keys = {"scenario.duration_s": 500}
    keys |= {key.replace("__", "."): value for key, value in given.items()}
    return rmfs.Simulation("small", scenario, seed=3, set=keys, pacing=pacing, trace=True)


def trials_of(run: Any, count: int = 3) -> Any:
    """Trials of giving one of the oldest orders to a station with a free slot."""
    station = next(one for one in run.view.pick_stations if one.free_slots)
    decisions = [AssignOrder(order, station.index) for order in list(run.view.orders)[:count]]
    base = run.controller_set[Problem.POA]
    return run.controller_set._lookahead(Problem.POA, decisions, base, 300.0, GOAL)


def with_a_free_slot(**given: Any) -> Any:
    """A run that waits for a decision of POA while a slot is free."""
    keys = {"scenario.duration_s": 500, **given}
    run = rmfs.Simulation("small", "small-arrivals", seed=3, set=keys, outside=["poa"], trace=True)
    while (decision := run.step()) is not None:
        free = any(one.free_slots for one in run.view.pick_stations)
        if free and run.now_s > 200 and len(run.view.orders) > 3:
            return run
        advice = decision.advice()
        if advice is None:
            decision.decline()
        else:
            decision.answer(advice)
    raise AssertionError("no slot was free")


@pytest.mark.parametrize("given", [{}, DISTURBED], ids=["quiet", "disturbed"])
def test_trials_do_not_see_what_will_really_come(given: dict[str, Any]) -> None:
    """Two runs with one past and two futures: what is tried in both goes alike."""
    past = with_a_free_slot(**given)
    truth, other = (past._snapshot(None)(path)[0] for path in [(98, 0), (99, 0)])
    assert trials_of(truth)(1, 0) == trials_of(other)(1, 0)
    came = []
    for one in (truth, other):
        one.phase.take_over(Problem.POA, one.controller_set[Problem.POA])
        one._unsettled = True
        one.run_until(500)
        came.append((one.world.orders_created, one.world.units_picked, one.instants))
    assert came[0] != came[1]


def test_high_periods_of_orders_and_bundles_coincide_in_futures() -> None:
    periods = {"kind": "high-low", "low_to_high_per_h": 20.0, "high_to_low_per_h": 20.0}
    orders = {"mode": "poisson", "profile": periods | {"high_per_h": 600.0}}
    bundles = {"mode": "poisson", "profile": periods | {"high_per_h": 300.0}}
    run = made("small", scenario__demand=orders, scenario__replenishment=bundles)
    run.run_until(200.0)
    for path in [(1, 0), (1, 1)]:
        arrivals = run._snapshot(None)(path)[0].arrivals
        intakes = arrivals._orders, arrivals._bundles
        rates = [intake._processes[-1]._candidates._rate for intake in intakes]
        high = [
            [rate.per_h(at_s * 10**6) == rate.peak_per_h for at_s in range(0, 4000, 20)]
            for rate in rates
        ]
        assert high[0] == high[1]
        assert 0 < sum(high[0]) < len(high[0])


def test_futures_do_not_know_that_nothing_more_will_come() -> None:
    """The last order of this run has arrived; in other futures, more arrive."""
    demand = {"mode": "poisson", "orders_per_h": 12.0, "per_station": False, "initial_orders": 5}
    run = made("small", scenario__demand=demand)
    run.run_until(1.0)
    process = run.arrivals._orders._processes[-1]
    while process._next is not None:
        run.run_until(process._next.time_us / 1e6)
    assert run.now_s < 400.0
    before, snapshot = run.world.orders_created, run._snapshot(None)
    more = []
    for sample in range(20):
        future = snapshot((1, sample))[0]
        more.append(future.arrivals._orders.next_us <= 500_000_000)
    assert 1 < sum(more) < 20
    run.run_until(500.0)
    assert run.world.orders_created == before


def test_one_future_for_all_that_is_compared_and_another_next_time() -> None:
    run = with_a_free_slot()
    trials = trials_of(run)
    assert trials(0, 0) == trials(0, 0)
    assert len({trials(0, sample).value for sample in range(4)}) > 1
    assert len({trials(which, 0).value for which in range(3)}) > 1
    assert trials_of(run)(0, 0) != trials(0, 0)


def test_trying_changes_nothing() -> None:
    run, untouched = with_a_free_slot(), with_a_free_slot()
    trials = trials_of(run)
    for which in range(3):
        trials(which, 0)
    for one in (run, untouched):
        one.phase.take_over(Problem.POA, one.controller_set[Problem.POA])
        one._unsettled = True
        one.run()
    assert told(run) == told(untouched)


def test_a_trial_is_worth_what_its_goal_says() -> None:
    run = with_a_free_slot()
    order = next(iter(run.view.orders))
    base = run.controller_set[Problem.POA]
    decision = [AssignOrder(order, next(s.index for s in run.view.pick_stations if s.free_slots))]
    look = run.controller_set._lookahead

    def value(**weights: float) -> float:
        goal = Goal(**{"units": 0.0, **weights})
        look._asked = 0  # the same futures
        return float(look(Problem.POA, decision, base, 150.0, goal)(0, 0).value)

    assert value() == 0.0
    assert 0 < value(units=1.0) < 200
    assert 0 < value(orders=1.0) < value(units=1.0)
    assert -5000 < value(distance_m=1.0) < -50
    total = value(units=1.0) + value(orders=2.0) + value(distance_m=0.1)
    assert value(units=1.0, orders=2.0, distance_m=0.1) == pytest.approx(total)


@pytest.mark.parametrize("problem", ["poa", "ta"])
def test_who_is_never_sure_decides_as_the_base_rule(problem: str) -> None:
    sure = {"name": "rollout", "certainty": 1e9, "samples": 2, "candidates": 2, "horizon_s": 20}
    inside, run = made(), made(**{f"controllers__{problem}": sure})
    inside.run()
    run.run()
    assert run.optimisers._asked > 5
    alike = ("motion", "stock", "orders", "units")
    assert [told(run)[name] for name in alike] == [told(inside)[name] for name in alike]


@pytest.mark.parametrize("problem", ["poa", "ta"])
@pytest.mark.parametrize("pacing", ["instant", "fixed=3", "work"])
def test_a_run_with_look_ahead_repeats_and_can_be_copied(problem: str, pacing: str) -> None:
    rule = {"name": "rollout", "samples": 1, "candidates": 2, "horizon_s": 20, "certainty": 0}
    given = {f"controllers__{problem}": rule, "scenario__duration_s": 120}
    run, again = made(pacing=pacing, **given), made(pacing=pacing, **given)
    run.run_until(60)
    fork = run.fork()
    for one in (run, again, fork):
        one.run()
    assert told(run) == told(again) == told(fork)
    paced_s = run.result().footprint["paced_s"]
    assert (paced_s > 0) == (pacing != "instant")


@pytest.mark.parametrize(
    ("given", "pacing", "told_why"),
    [
        (
            {"controllers__poa": {"name": "rollout", "base": {"name": "best"}}},
            "instant",
            "poa.base",
        ),
        ({"controllers__poa": {"name": "rollout"}}, "wall", "wall cannot be copied"),
        (
            {"controllers__ta": {"name": "rollout", "over": ["poa"]}},
            "instant",
            "over.0: Input should be",
        ),
        (
            {"controllers__poa": {"name": "rollout", "samples": 1}},
            "instant",
            "samples must be 2 or more, or certainty 0: .* given: samples = 1, certainty = 1",
        ),
    ],
)
def test_what_cannot_be_looked_ahead_is_refused(
    given: dict[str, Any], pacing: str, told_why: str
) -> None:
    with pytest.raises(InputError, match=told_why):
        made(pacing=pacing, **given).run()


# --- sequential halving ---------------------------------------------------------------------------


class Noisy:
    """Trials of known means, with noise that is partly common to all."""

    def __init__(self, means: list[float], noise: float) -> None:
        self.means, self.noise = means, noise
        self.asked: list[tuple[int, int]] = []

    def __call__(self, which: int, sample: int) -> Tried:
        self.asked.append((which, sample))
        common = np.random.default_rng(sample).normal()
        own = np.random.default_rng([sample, which]).normal()
        return Tried(self.means[which] + common + self.noise * own, 10)


def best(trials: Noisy, samples: int = 16, instants: int = 10**6, certainty: float = 1.0) -> int:
    answer = solve(Comparison(trials, len(trials.means), samples, instants, certainty))
    assert answer.solution is not None
    assert answer.work == 10 * len(trials.asked)
    return int(answer.solution["row"])  # type: ignore[arg-type]


def test_the_best_is_found_and_the_bad_are_dropped() -> None:
    trials = Noisy([0.0, 0.2, 2.0, -1.0, 0.5], 0.3)
    assert best(trials) == 2
    per_row = [sum(which == row for which, _ in trials.asked) for row in range(5)]
    assert per_row[2] == per_row[0] == 16
    assert max(per_row[1], per_row[3], per_row[4]) <= 4


def test_the_base_rule_keeps_what_is_not_clearly_worse() -> None:
    assert best(Noisy([0.0, 0.1, 0.05], 5.0), certainty=3.0) == 0
    assert best(Noisy([1.0, 0.5, 0.0], 0.0)) == 0


def test_one_future_is_enough_only_if_no_certainty_is_required() -> None:
    """With one sample, the standard error is unknown, so nothing is certain."""
    for certainty, chosen in ((1.0, 0), (1e-9, 0), (0.0, 1)):
        assert best(Noisy([0.0, 5.0], 0.1), samples=1, certainty=certainty) == chosen
        assert best(Noisy([0.0, 5.0], 0.1), instants=5, certainty=certainty) == chosen
    assert best(Noisy([0.0, -5.0], 0.1), samples=1, certainty=0.0) == 0


def test_a_budget_ends_the_rounds() -> None:
    trials = Noisy([0.0, 1.0, 0.9, 0.8], 0.1)
    best(trials, instants=45)
    assert len(trials.asked) == 7  # all four, then three of them, which was over the budget


def test_a_trial_counts_metres_beyond_the_end_of_the_warm_up() -> None:
    """The same 500 s, with and without a warm-up that ends within the horizon."""
    goal, values = Goal(units=0.0, distance_m=1.0), []
    for warmup_s in (0, 250):
        given = {"scenario.warmup_s": warmup_s, "scenario.duration_s": 500 - warmup_s}
        run = with_a_free_slot(**given)
        assert 200 < run.now_s < 250
        order = next(iter(run.view.orders))
        station = next(one.index for one in run.view.pick_stations if one.free_slots)
        base, look = run.controller_set[Problem.POA], run.controller_set._lookahead
        trials = look(Problem.POA, [AssignOrder(order, station)], base, 150.0, goal)
        values.append(trials(0, 0).value)
    assert values[1] == pytest.approx(values[0])
    assert values[0] < -50


def test_a_split_order_is_overdue_once() -> None:
    """Due at 10 s; at 40 s, a line is in the backlog and two are at stations."""
    situation = Situation(small_layout(pick_stations=2))
    order = situation.order(due_s=10.0, s0=1, s1=1, s2=1)
    for station, sku in ((0, 0), (1, 1)):
        situation.world.assign_lines(order, station, [sku])
    situation.world.now_s = 40.0
    earnings = Earnings(Goal(units=0.0, overdue_s=1.0), begin_s=0.0, horizon_s=40.0)
    assert earnings.value(situation.world) == -30.0
    situation.world.assign_lines(order, 1, [2])
    assert earnings.value(situation.world) == -30.0


def test_a_cancelled_order_was_overdue_until_then() -> None:
    """Due at 10 s, cancelled at 25 s."""
    situation = Situation(small_layout(pick_stations=1))
    order = situation.order(due_s=10.0, s0=1)
    earnings = Earnings(Goal(units=0.0, overdue_s=1.0), begin_s=0.0, horizon_s=40.0)
    situation.world.now_s = 25.0
    situation.world.cut_order(order, {})
    earnings.order_cancelled(order)
    situation.world.now_s = 40.0
    assert earnings.value(situation.world) == -15.0

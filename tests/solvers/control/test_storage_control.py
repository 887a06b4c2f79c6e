"""PSA by models in a small warehouse by hand, and what pruning of places loses: nothing."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from doubles import Situation, small_layout

from rmfs.control.asks import Ask, Call, told_by
from rmfs.control.choices import choose
from rmfs.control.problems import Problem
from rmfs.errors import InputError
from rmfs.solvers.control.storage.bands import bands, means
from rmfs.solvers.control.storage.placement import PlacementControl, worth_looking_at
from rmfs.solvers.control.storage.prices import PricesControl
from rmfs.solvers.control.storage.stays import StaysControl
from rmfs.solvers.models.storage import placement

ASKS_AHEAD = [PlacementControl, StaysControl]


def ask(control: Any) -> list[Call]:
    """Let a controller ask, and return its questions with their answers, not yet told."""
    calls = []
    for decision in control.decide():
        assert isinstance(decision, Ask)
        calls.append(Call(0, Problem.PSA, control, decision, 0, ""))
        calls[-1].answer = decision.solve(decision.question)
    return calls


def tell(control: Any, call: Call) -> None:
    """Tell a controller an answer."""
    assert list(control.answered(call)) == []


def place(control: Any, situation: Situation) -> tuple[int, Call | None]:
    """Ask for the place of the pod of robot 0, and by whose solution it was found."""
    return told_by(control.place(situation.world.robots[0]), None)


def carried(places: int = 8) -> Situation:
    """Robot 0 stands with pod 3 at the station above place 0; places from 4 on are empty too."""
    situation = Situation(small_layout(places=places, robots=1))
    situation.stock(3, s1=5)
    situation.assigned(s1=1)
    situation.carry(0, 3)
    return situation


@pytest.mark.parametrize("control", [*ASKS_AHEAD, PricesControl])
def test_one_pod_takes_the_place_nearest_to_the_only_station(control: type) -> None:
    """Place 3, just left, is the nearest empty one; it costs least now and later."""
    situation = carried()
    made = situation.make(control)
    for call in ask(made):
        tell(made, call)
    found, call = place(made, situation)
    assert found == 3
    assert call is not None


@pytest.mark.parametrize("control", [*ASKS_AHEAD, PricesControl])
def test_without_an_answer_the_nearest_place(control: type) -> None:
    situation = carried()
    made = situation.make(control)
    (call,) = ask(made)
    assert place(made, situation) == (3, None)
    call.answer = None
    tell(made, call)
    assert place(made, situation) == (3, None)


def test_after_a_failure_old_prices_decide_nothing() -> None:
    """Else a run would count decisions by the optimiser while its calls fail."""
    situation = carried()
    made = situation.make(PricesControl)
    (call,) = ask(made)
    tell(made, call)
    assert place(made, situation)[1] is call
    failed = Call(1, Problem.PSA, made, call.ask, 0, "")
    tell(made, failed)
    assert place(made, situation) == (3, None)


@pytest.mark.parametrize("control", ASKS_AHEAD)
def test_a_place_taken_meanwhile_is_stale(control: type) -> None:
    """Somebody else comes to keep place 3: the call counts it, and the next place is taken."""
    situation = carried()
    made = situation.make(control)
    (call,) = ask(made)
    tell(made, call)
    other = Situation(small_layout(places=8)).world.robots[1]
    situation.world.storage.keep(other, 3)
    assert place(made, situation) == (4, None)
    assert call.stale == 1


@pytest.mark.parametrize("control", ASKS_AHEAD)
def test_an_answer_for_a_pod_no_longer_carried_is_stale(control: type) -> None:
    situation = carried()
    robot = situation.world.robots[0]
    made = situation.make(control)
    (call,) = ask(made)
    robot.pod = -1
    tell(made, call)
    assert call.stale == 1


def test_the_pod_wanted_more_gets_the_nearer_place() -> None:
    """Two pods return to places 2 and 3, equally far now: orders that wait want pod 3 alone."""
    situation = Situation(small_layout(places=4, pods=4, robots=2))
    situation.stock(2, s1=1)
    situation.stock(3, s2=40)
    situation.assigned(s1=1)
    situation.assigned(s2=1)
    situation.carry(0, 2)
    situation.carry(1, 3)
    for _ in range(20):
        situation.order(s2=2)
    made = situation.make(PlacementControl)
    for call in ask(made):
        tell(made, call)
    assert [told_by(made.place(robot), None)[0] for robot in situation.world.robots] == [3, 2]


def test_places_left_out_never_matter() -> None:
    """On 200 random cases the best placement over the places kept is the best of all."""
    for seed in range(200):
        rng = np.random.default_rng(seed)
        pods, places = int(rng.integers(1, 6)), int(rng.integers(6, 20))
        travel_s, access_s = rng.uniform(0, 90, (pods, places)), rng.uniform(0, 90, places)
        visits = rng.uniform(0, 3, pods)
        kept = worth_looking_at(travel_s + np.outer(visits, access_s))
        every = placement.solve(placement.Placement(travel_s, access_s, visits))
        few = placement.solve(placement.Placement(travel_s[:, kept], access_s[kept], visits))
        assert few.objective == pytest.approx(every.objective)
        assert len(kept) <= pods * pods


def test_bands_are_of_equal_size_and_in_order() -> None:
    values = np.array([5.0, 1.0, 3.0, 3.0, 9.0, 0.0])
    assert bands(values, 3).tolist() == [2, 0, 1, 1, 2, 0]
    assert means(values, bands(values, 3)).tolist() == [0.5, 3.0, 7.0]
    assert bands(np.array([2.0, 1.0]), 5).tolist() == [1, 0]


def test_a_buffer_time_is_refused_where_questions_have_a_period() -> None:
    """PSA prices asks every `period_s`; it took `buffer_s`, and did nothing with it."""
    with pytest.raises(InputError, match="buffer_s"):
        choose(Problem.PSA, {"name": "prices", "buffer_s": 60.0}, "test")
    for name in ("placement", "stays"):
        choose(Problem.PSA, {"name": name, "buffer_s": 60.0}, "test")


def test_units_that_orders_lose_do_not_count_as_picked() -> None:
    """Otherwise, pile-on and rate would be those of 1,000 units that nobody picked."""
    situation = carried()
    foresight = situation.make(PlacementControl).foresight
    pile_on, rate = foresight.pile_on, foresight.units_per_h.sum()
    situation.world.inventory.demand(1, 1000)
    situation.world.inventory.undemand(1, 1000)
    assert foresight.pile_on == pile_on
    assert foresight.units_per_h.sum() == pytest.approx(rate)

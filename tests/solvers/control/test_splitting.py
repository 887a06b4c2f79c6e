"""Which orders may be split: by hand, and in runs in which the wall must never be full."""

from __future__ import annotations

import numpy as np
import pytest
from doubles import Situation, small_layout
from pile_on_sample import SMALL, snapshot

import rmfs
from rmfs.measure.dictionary import reproducible
from rmfs.observer import Observer
from rmfs.solvers.control.items import servable
from rmfs.solvers.control.splitting import Splitting
from rmfs.solvers.models.pile_on.candidates import call_price, whole_price
from rmfs.world import verify
from rmfs.world.put_wall import PutWall


@pytest.fixture
def situation() -> Situation:
    """Two stations with three slots; pod 0 has all that is ordered."""
    made = Situation(small_layout(pick_stations=2, slots=3))
    made.stock(0, s1=9, s2=9, s3=9)
    return made


def test_an_order_needs_room_for_all_its_lines_but_one(situation: Situation) -> None:
    three, two = situation.order(s1=1, s2=1, s3=1), situation.order(s1=1, s2=1)
    one, other = situation.order(s3=1), situation.order(s2=1, s3=1)
    view, world = situation.view, situation.world
    world.put_wall = PutWall(3, slot_per_part=True)
    splitting = Splitting(view, None)
    assert all(splitting.admits(order) for order in (three, two, one, other))
    splitting.add(three)
    assert splitting.admits(three)
    assert splitting.admits(two)
    splitting.add(two)
    assert not splitting.admits(other)
    assert splitting.admits(one)  # its only line is no part of anything
    # what is planned counts alike
    assert not Splitting(view, None, [three, two]).admits(other)
    # and what stands at a station; lines that join a part make room again
    world.assign_lines(three, 0, [1])
    assert not Splitting(view, None, [two]).admits(other)
    world.assign_lines(three, 0, [2])
    assert Splitting(view, None, [two]).admits(other)
    world.assign_lines(three, 0, [3])
    assert Splitting(view, None).admits(other)
    verify(world)


def test_one_slot_for_all_totes_of_an_order(situation: Situation) -> None:
    three, two = situation.order(s1=1, s2=1, s3=1), situation.order(s1=1, s2=1)
    situation.world.put_wall = PutWall(1, slot_per_part=False)
    splitting = Splitting(situation.view, None)
    assert splitting.admits(three)
    splitting.add(three)
    assert not splitting.admits(two)


def test_what_is_picked_keeps_its_slots_until_it_is_there(situation: Situation) -> None:
    gone, two = situation.order(s1=1, s2=1), situation.order(s1=1, s2=1)
    wall = situation.world.put_wall = PutWall(1, slot_per_part=True)
    totes = [wall.release(gone, 0, 0.0, last=last) for last in (False, True)]
    assert not Splitting(situation.view, None).admits(two)
    for tote in totes:
        wall.arrive(tote, 1.0)
    assert Splitting(situation.view, None).admits(two)


def test_a_limit_counts_orders_and_a_price_is_asked(situation: Situation) -> None:
    two, other = situation.order(s1=1, s2=1), situation.order(s1=1, s2=1)
    splitting = Splitting(situation.view, 1)
    splitting.add(two)
    assert splitting.admits(two)
    assert not splitting.admits(other)
    assert not Splitting(situation.view, 0).admits(two)
    situation.world.put_wall = PutWall(1, slot_per_part=True)  # a limit takes its place
    assert Splitting(situation.view, 1).admits(situation.order(s1=1, s2=1, s3=1))
    situation.world.put_wall = None
    dear = Splitting(situation.view, None, pays=lambda order: order is two)
    assert [dear.offers()(order) for order in (two, other)] == [True, False]
    assert not dear.is_free
    assert Splitting(situation.view, None).is_free


def test_orders_that_may_not_be_split_are_whole(situation: Situation) -> None:
    two, one = situation.order(s1=1, s2=1), situation.order(s3=1)
    items = servable(situation.view, True, Splitting(situation.view, 0))
    assert [(item.order, item.line is None) for item in items] == [(two, True), (one, False)]
    assert len(servable(situation.view, True)) == 3


def test_first_are_those_of_which_pods_under_way_serve_most(situation: Situation) -> None:
    """Pod 1 brings two of each SKU 1 and 2 to station 0."""
    world = situation.world
    situation.stock(1, s1=2, s2=2)
    nothing = situation.order(s0=1, s3=1)
    whole = situation.order(s1=1, s2=1)
    third = situation.order(s1=1, s3=1, s4=1)
    most = situation.order(s1=1, s2=1, s3=1)
    half = situation.order(s2=1, s4=1)
    world.start_pick(world.robots[0], 1, 0)
    offered = Splitting(situation.view, 10).offers()
    assert [offered(order) for order in (nothing, whole)] == [False, False]
    assert all(offered(order) for order in (third, most, half))
    # lines served per slot: 1 of 2, 2 of 2, 1 of 1
    for slots, chosen in [(1, {half}), (2, {most}), (3, {most, half}), (5, {most, half, third})]:
        world.put_wall = PutWall(slots, slot_per_part=True)
        offered = Splitting(situation.view, None).offers()
        assert {order for order in (third, most, half) if offered(order)} == chosen
    # all together as far as there is room: with half planned, most does not fit into two
    world.put_wall = PutWall(2, slot_per_part=True)
    offered = Splitting(situation.view, None, [half]).offers()
    assert [offered(order) for order in (third, most, half)] == [False, False, True]


@pytest.mark.parametrize("seed", range(5))
def test_price_of_a_whole_order(seed: int) -> None:
    """Of every order, by looking at each station, line and pod."""
    data = snapshot(SMALL, seed)
    shares, told = call_price(data), whole_price(data)
    for order in range(data.orders):
        lines = range(data.first_line[order], data.first_line[order + 1])
        costs = []
        for station in range(data.stations):
            cost = 0.0
            for line in lines:
                sku = data.line_sku[line]
                if data.surplus[station, sku] < data.line_units[line]:
                    pods = np.flatnonzero(data.available & (data.stock[:, sku] > 0))
                    cost += min((shares[pod, station] for pod in pods), default=np.inf)
            costs.append(cost)
        assert told[order] == pytest.approx(min(costs))
    assert told[np.isfinite(told)].mean() > 0


class MostSplit(Observer):
    """Most orders that needed the wall at a time."""

    def __init__(self):
        self.most = 0

    def run_started(self, run):
        self.world = run.world

    def order_assigned(self, order):
        def totes(whole):
            lines = len(whole.lines) if whole in self.world.orders else bool(whole.lines)
            return len(whole.parts) + lines

        split = [whole for whole in self.world.split_orders.values() if totes(whole) > 1]
        self.most = max(self.most, len(split))


CONTROLLERS = {"pile-on-split": "poa", "m1g": "ta", "planning-split": "ta"}


def simulate(controllers, *observers, **given):
    short = {"scenario.duration_s": 900, "layout.robots": 6} | given
    short[f"controllers.{CONTROLLERS[controllers]}.split"] = True
    return rmfs.simulate(
        "small", "small", controllers, seed=3, pacing="work", set=short, observers=observers
    )


@pytest.mark.parametrize("controllers", CONTROLLERS)
@pytest.mark.parametrize("slot_for", ["part", "order"])
def test_a_wall_that_controllers_know_is_never_full(controllers, slot_for):
    packing = {"slots": 10, "slot_for": slot_for, "travel": {"constant_s": 100.0}}
    run = simulate(controllers, **{"scenario.packing": packing})
    verify(run.world)
    assert run.footprint["totes_held_mean"] == run.footprint["totes_by_hand"] == 0
    assert 4 <= run.footprint["wall_slots_max"] <= 10
    assert run.footprint["orders_packed_split_share"] > 0


@pytest.mark.parametrize("controllers", CONTROLLERS)
@pytest.mark.parametrize("limit", [0, 3])
def test_a_limit_of_orders_holds(controllers, limit):
    watch, problem = MostSplit(), CONTROLLERS[controllers]
    given = {f"controllers.{problem}.split_orders": limit, "scenario.packing": {}}
    run = simulate(controllers, watch, **given)
    assert watch.most == limit
    assert (run.footprint["totes_per_order"] == 1) == (limit == 0)


@pytest.mark.parametrize("controllers", CONTROLLERS)
def test_without_a_wall_any_number_is_split(controllers):
    free = MostSplit()
    simulate(controllers, free)
    assert free.most > 10


def test_the_price_of_a_part():
    """A dear one leaves few splits, of orders that no pods could serve whole; none changes none."""
    runs = {
        part_s: simulate(
            "pile-on-split", **{"controllers.poa.part_s": part_s, "scenario.packing": {}}
        ).footprint
        for part_s in (0.0, 40.0, 300.0)
    }
    totes = [runs[part_s]["totes_per_order"] for part_s in (0.0, 40.0, 300.0)]
    assert totes[0] > totes[1] > totes[2]
    columns = reproducible("footprint")
    free = simulate("pile-on-split", **{"scenario.packing": {}}).footprint
    assert runs[0.0][columns].equals(free[columns])

"""Orders in the pool of a station: what is bound to them, and when it is given back.

Pod 0 is fetched by robot 0, which rests beneath it or comes there. Distances as in `test_service`.
"""

from __future__ import annotations

from hand_made import HandMade

from rmfs.control.base import NoParameters
from rmfs.control.decisions import AssignOrder, QueueOrder
from rmfs.control.poa import PickOrderAssignment
from rmfs.control.problems import Problem
from rmfs.control.settings import settings

HERE = __name__


class PoolOnly(PickOrderAssignment[NoParameters]):
    """Assigns order 0 and queues all others at station 0."""

    def decide(self):
        for order in list(self.view.orders):
            if order.index == 0:
                yield AssignOrder(order, 0)
            elif order.queued_at < 0:
                yield QueueOrder(order, 0)


class Pool(PoolOnly):
    """Puts queued orders on the station as soon as a slot is free."""

    def decide(self):
        yield from super().decide()
        station = self.view.pick_stations[0]
        for order in list(station.queued.values()):
            if station.free_slots:
                yield AssignOrder(order, 0)


def two_orders(poa: str, slots: int = 1, **pps) -> HandMade:
    """Order 0 wants SKU 0, order 1 SKU 1; pod 0 has one unit of each."""
    made = HandMade(
        {"robots": 1, "places": 3, "pods": 1, "slots": slots},
        {"duration_s": 200.0},
        poa={"name": f"{HERE}:{poa}"},
        pps={"name": "lexicographic", **pps},
        ta={"name": "balanced", "period_s": 0.0},
    )
    made.stock(0, s0=1, s1=1)
    made.order(s0=1)
    made.order(s1=1)
    return made


def test_a_pod_serves_a_queued_order_in_the_slot_that_comes_free() -> None:
    """One slot. Both units are bound when the pod is fetched.

    The unit of order 0 is picked when the pod arrives; 10 s later the order is complete, order 1
    takes its slot, and its unit is picked from the same pod.
    """
    made = two_orders("Pool")
    diary = made.run()
    ((arrived_s, *_),) = diary.of("arrive")
    assert diary.of("unit") == [
        (arrived_s, "unit", 0, 0, False),
        (arrived_s + 10, "unit", 1, 1, False),
    ]
    assert made.world.orders_completed == 2


def test_the_pod_goes_if_the_slot_is_not_given_to_its_order() -> None:
    """POA leaves order 1 in the pool: 10 s after the first pick its request is open again."""
    made = two_orders("PoolOnly", consider="assigned")
    diary = made.run()
    ((arrived_s, *_),) = diary.of("arrive")
    ((left_s, *_),) = diary.of("leave")
    assert left_s == arrived_s + 10
    order = made.world.pick_stations[0].queued[1]
    assert (order.open_units, order.lines[0].open_units) == (1, 1)
    assert made.world.inventory.available[1, 0] == 1
    assert made.world.inventory.free_stock[1] == 1


def test_a_pod_that_came_for_queued_orders_only_is_let_go_at_once() -> None:
    """Two slots, and POA uses one: pod 0 comes again for order 1, in vain, and leaves.

    The first time it stays for 10 s, until order 0 is complete: POA may have waited for that.
    """
    made = two_orders("PoolOnly", slots=2)
    diary = made.run()
    ((came, gone), *later) = zip(diary.of("arrive"), diary.of("leave"), strict=False)
    assert gone[0] == came[0] + 10
    assert later
    for came, gone in later:
        assert came[0] == gone[0]
    assert [entry[2] for entry in diary.of("unit")] == [0]


def test_requests_of_assigned_orders_only() -> None:
    """`reserve = assigned`: the unit of order 1 is bound when the order gets the slot, not before.

    At that moment the pod is on its way back to its place.
    """
    made = two_orders("Pool", consider="assigned", reserve="assigned")
    diary = made.run()
    (first, *_), (second, *_) = diary.of("arrive")
    assert [entry[0] for entry in diary.of("unit")] == [first, second]


def test_an_order_that_is_queued_late_is_bound_to_a_pod_on_its_way() -> None:
    """Order 1 arrives 1 s before the pod does; that is late binding."""
    made = two_orders("Pool")
    arrived_s = made.run().of("arrive")[0][0]
    made = HandMade(
        {"robots": 1, "places": 3, "pods": 1, "slots": 1},
        {"duration_s": 200.0},
        poa={"name": f"{HERE}:Pool"},
        ta={"name": "balanced", "period_s": 0.0},
    )
    made.stock(0, s0=1, s1=1)
    made.order(s0=1)
    made.order(at_s=arrived_s - 1, s1=1)
    diary = made.run()
    assert [entry[2:] for entry in diary.of("unit")] == [(0, 0, False), (1, 1, True)]


def two_robots(slots: int, **pps) -> HandMade:
    """Order 0 wants SKU 0. Pod 3 has two units of SKU 0, pod 0 one of SKU 1."""
    made = HandMade(
        {"robots": 2, "slots": slots},
        {"duration_s": 200.0},
        poa={"name": f"{HERE}:PoolOnly"},
        pps={"name": "lexicographic", **pps},
        ta={"name": "balanced", "period_s": 0.0, "replenishment_weight": 0.0},
    )
    made.stock(3, s0=2)
    made.stock(0, s1=1)
    made.order(s0=1)
    return made


def fetches(diary) -> list[float]:
    """When robots started to fetch pods for the station."""
    return [entry[0] for entry in diary.of("pick")]


def test_a_pod_is_fetched_as_soon_as_a_slot_is_free_for_a_queued_order() -> None:
    """One slot: the pod for order 1 is fetched when order 0 is complete, though nobody assigns."""
    made = two_robots(slots=1)
    made.order(at_s=1.0, s1=1)
    diary = made.run()
    ((complete_s, *_),) = diary.of("complete")
    assert fetches(diary)[:2] == [0.0, complete_s]


def test_a_pod_is_fetched_as_soon_as_it_completes_what_is_left_of_a_queued_order() -> None:
    """Order 1 wants SKUs 0 and 1, which no pod has together, and queues while pod 3 is fetched.

    When pod 3 is lifted, after 5 s, the unit of SKU 0 is bound to it; pod 0 completes the rest.
    """
    made = two_robots(slots=2, reserve="assigned-and-queued")
    made.order(at_s=1.0, s0=1, s1=1)
    diary = made.run()
    assert fetches(diary)[:2] == [0.0, 5.0]


def test_queued_requests_are_returned_when_poa_is_exchanged() -> None:
    """At 1 s, while the pod is being fetched, another rule follows that knows no pools."""
    made = two_orders("Pool")
    table = {"format": "rmfs-controllers/1", "name": "x", "poa": {"name": "random"}}
    choice = settings(table).choices[Problem.POA]

    def exchange() -> None:
        assert len(made.world.robots[0].task.picks) == 2
        made.simulation.phase.exchange(choice)
        assert len(made.world.robots[0].task.picks) == 1
        assert not made.world.pick_stations[0].queued

    made.at(1.0, exchange)
    made.run()
    assert made.world.orders_completed == 2

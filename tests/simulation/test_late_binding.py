"""Work that comes up while a pod is on its way. Distances as in `test_service`."""

from __future__ import annotations

from hand_made import HandMade


def test_an_order_is_added_to_a_pod_that_is_carried() -> None:
    """Pod 0 is lifted at 2 s and arrives at 14 s; order 1 comes at 10 s and is picked second."""
    made = HandMade({"robots": 1})
    made.stock(0, s0=1, s1=1)
    made.order(s0=1)
    made.order(at_s=10.0, s1=1)
    assert made.run().of("unit") == [(14.0, "unit", 0, 0, False), (24.0, "unit", 1, 1, True)]


def test_not_if_it_is_switched_off() -> None:
    """At 17 s the robot asks for a task and goes on with the pod: the unit is not late-bound."""
    made = HandMade({"robots": 1}, pps={"late_picks": False})
    made.stock(0, s0=1, s1=1)
    made.order(s0=1)
    made.order(at_s=10.0, s1=1)
    picks = made.run().of("unit")
    assert picks == [(14.0, "unit", 0, 0, False), (24.0, "unit", 1, 1, False)]


def test_a_pod_that_is_lifted_takes_what_came_up_before() -> None:
    """Order 1 comes at 1 s, while the robot is still on its way to the pod (lift at 2 s)."""
    made = HandMade({"robots": 1})
    made.stock(0, s0=1, s1=1)
    made.order(s0=1)
    made.order(at_s=1.0, s1=1)
    assert made.run().of("unit") == [(14.0, "unit", 0, 0, False), (24.0, "unit", 1, 1, True)]


def test_the_pod_that_arrives_first_gets_the_work() -> None:
    """Pods 0 and 3 are both carried at 10 s and both have SKU 2; pod 0 arrives at 14 s."""
    made = HandMade({"robots": 2}, ta={"replenishment_weight": 0})
    made.stock(0, s0=1, s2=1)
    made.stock(3, s1=1, s2=1)
    made.order(s0=1)
    made.order(s1=1)
    made.order(at_s=10.0, s2=1)
    late = [entry for entry in made.run().of("unit") if entry[-1]]
    assert late == [(24.0, "unit", 2, 2, True)]
    assert made.world.inventory.contained[2].tolist() == [0, 0, 0, 1]


def test_an_order_that_takes_a_freed_slot_is_added_before_the_next_pick() -> None:
    """Two slots, three orders of one unit: order 2 takes the slot of order 0 at 24 s.

    At this moment the pod has one request left, that of order 1, which is picked next; so order 2
    is added to the task, and picked at 34 s.
    """
    made = HandMade({"robots": 1, "slots": 2}, poa={"fast_lane": False})
    made.stock(0, s0=2, s1=1)
    made.order(s0=1)
    made.order(s0=1)
    made.order(at_s=5.0, s1=1)
    picks = made.run().of("unit")
    assert picks == [
        (14.0, "unit", 0, 0, False),
        (24.0, "unit", 1, 0, False),
        (34.0, "unit", 2, 1, True),
    ]


def test_bundles_are_added_as_well() -> None:
    """The pod is on its way from 2 s to 19 s; the bundle that comes at 10 s is stored second."""
    made = HandMade({"robots": 1}, rps={"buffer_threshold": 0.0}, ta={"pick_weight": 0})
    made.bundle()
    made.bundle(at_s=10.0)
    diary = made.run()
    assert diary.of("store", "replenish") == [
        (0.0, "replenish", 0, 1),
        (19.0, "store", 0),
        (29.0, "store", 1),
    ]

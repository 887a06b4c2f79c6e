"""Due times that are departures of trucks."""

from __future__ import annotations

import pytest
from scenario_tools import DAY_US, SITE, FakeState, drive, scenario

import rmfs
from rmfs.errors import InputError
from rmfs.scenario import order_intake
from rmfs.scenario.departures import Departures
from rmfs.scenario.due import DepartureDue

TRUCKS = {"mode": "departures", "times_s": [36000.0, 64800.0], "lead_s": 1800.0}


def test_the_next_departure():
    """Trucks at 100 and 400 of every 1000 s, 250 s of the cycle gone at time zero."""
    given = DepartureDue(times_s=(100.0, 400.0), cycle_s=1000.0, lead_s=0.0)
    departures = Departures(given, 250.0)
    for time_s, next_s in [(0, 150), (150, 150), (150.000001, 850), (849, 850), (851, 1150)]:
        assert departures.next_us(round(time_s * 1e6)) == next_s * 10**6


@pytest.mark.parametrize("demand", [{"mode": "poisson"}, {"mode": "backlog", "orders": 20}])
def test_orders_go_with_the_first_truck_they_can_reach(demand, skus):
    """At 10 and 18 o'clock, two days from midnight; half an hour is needed at least."""
    given = scenario(2 * 86400.0, orders={"due": TRUCKS}, demand=demand)
    come = drive(order_intake(given, skus, SITE, 1), FakeState(), DAY_US)
    assert len(come) >= 20
    for order in come:
        reached_s = order.time_us / 1e6 + 1800.0
        trucks = [day * 86400.0 + at for day in range(3) for at in (36000.0, 64800.0)]
        assert order.due_us / 1e6 == min(at for at in trucks if at >= reached_s)


def test_the_clock_counts(skus):
    given = scenario(orders={"due": TRUCKS}, demand={"orders": 3}, time_of_day_s=35000.0)
    come = drive(order_intake(given, skus, SITE, 1), FakeState(), 0)
    assert {order.due_us for order in come} == {(64800 - 35000) * 10**6}


def test_a_file_that_says_when_its_orders_are_due_is_right(tmp_path):
    rows = ["time,order,sku,quantity,due", "10,0,1,1,500", "20,1,2,1,", "30,2,3,1,700"]
    (tmp_path / "orders.csv").write_text("\n".join(rows) + "\n", "utf-8")
    run = rmfs.simulate(
        "small",
        "small",
        "sequ",
        set={
            "scenario.duration_s": 600,
            "scenario.orders.due": TRUCKS,
            "scenario.demand": {"mode": "stream", "file": str(tmp_path / "orders.csv")},
        },
    )
    assert run.table("orders")["due_s"].tolist() == [500.0, 36000.0, 700.0]


@pytest.mark.parametrize(
    ("wrong", "told"),
    [
        ({"times_s": []}, "times_s"),
        ({"times_s": [200.0, 100.0]}, "in ascending order"),
        ({"times_s": [90000.0]}, "greater than the last of times_s = 90000"),
        ({"lead_s": -1.0}, "lead_s"),
    ],
)
def test_bad_departures_are_told_in_one_line(wrong, told):
    with pytest.raises(InputError, match=told) as error:
        rmfs.simulate("small", "small", "sequ", set={"scenario.orders.due": TRUCKS | wrong})
    assert "\n" not in str(error.value)

"""Backlogs are kept at their length, with pauses by stock level."""

from __future__ import annotations

from hand_made import HandMade

from rmfs.observer import Observer


class Levels(Observer):
    """Watches the backlogs whenever something is created."""

    def __init__(self) -> None:
        self.orders: list[tuple[float, int]] = []
        self.bundles: list[float] = []

    def run_started(self, simulation) -> None:
        self.world = simulation.world

    def order_created(self, order) -> None:
        self.orders.append((order.created_s, len(self.world.orders)))

    def bundle_created(self, bundle) -> None:
        self.bundles.append(bundle.created_s)


def test_an_assigned_order_is_replaced_at_once() -> None:
    """Backlog 3, four slots of which one is kept: six orders at time 0, then one per completion."""
    levels = Levels()
    made = HandMade(
        {"pods": 4, "pod_capacity": 100.0},
        {
            "stock": {"initial_share": 0.5},
            "demand": {"mode": "backlog", "orders": 3, "pause_by_stock": False},
            "orders": {"lines": {"mean": 1, "sd": 0, "min": 1, "max": 1}},
        },
        (levels,),
    )
    diary = made.run()
    assert max(waiting for _, waiting in levels.orders) == 3
    assert [time for time, _ in levels.orders][:6] == [0.0] * 6
    assert len(made.world.orders) == 3
    completed = {entry[0] for entry in diary.of("complete")}
    assert {time for time, _ in levels.orders[7:]} <= completed


def test_no_order_while_the_stock_is_low() -> None:
    """200 of 400 space units stored; below 49 % there are no new orders: it ends after 5 picks."""
    levels = Levels()
    made = HandMade(
        {"pods": 4, "pod_capacity": 100.0, "robots": 2},
        {
            "stock": {"initial_share": 0.5},
            "demand": {
                "mode": "backlog",
                "orders": 1,
                "pause_below_share": 0.49,
                "resume_above_share": 0.6,
            },
            "orders": {
                "lines": {"mean": 1, "sd": 0, "min": 1, "max": 1},
                "units_per_line": {"mean": 1, "sd": 0, "min": 1, "max": 1},
            },
        },
        (levels,),
    )
    made.run()
    stored = made.world.inventory.stored_space
    assert stored < 0.49 * 400
    assert (
        len(made.world.orders) + sum(len(station.orders) for station in made.world.pick_stations)
        == 0
    )
    assert made.world.orders_created == made.world.orders_completed


def test_bundles_pause_while_the_load_is_high() -> None:
    """Bundles of 4 to 12 units until the load is above 30 % of 400: each counts once."""
    levels = Levels()
    made = HandMade(
        {"pods": 4, "pod_capacity": 100.0},
        {
            "replenishment": {
                "mode": "backlog",
                "bundles": 10,
                "pause_above_share": 0.3,
                "resume_below_share": 0.2,
            }
        },
        (levels,),
        rps={"buffer_threshold": 0.0},
    )
    made.run()
    assert made.world.load > 0.3 * 400
    assert made.world.load <= 0.3 * 400 + 12
    assert made.world.bundles_stored == made.world.bundles_created


def test_after_a_failure_it_is_tried_again_when_the_time_is_up() -> None:
    """There is no stock: an order is tried at 0, 60, 120, ... s; stock comes at 150 s."""
    levels = Levels()
    made = HandMade(
        {"pods": 1},
        {"demand": {"mode": "backlog", "orders": 1, "pause_by_stock": False}},
        (levels,),
    )
    made.at(150.0, lambda: [made.world.inventory.stock(0, sku, 10) for sku in range(5)])
    made.simulation.run()
    assert levels.orders[0][0] == 180.0

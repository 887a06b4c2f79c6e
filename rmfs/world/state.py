"""The state of a warehouse: stock, orders, stations and robots, and counts of events."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from rmfs.world.backlog import BundleBacklog, OrderBacklog
from rmfs.world.inventory import Inventory, read_only
from rmfs.world.news import News
from rmfs.world.robots import Robot
from rmfs.world.stations import PickStation, ReplenishmentStation, Station
from rmfs.world.storage import Storage

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from rmfs.layout.model import Layout
    from rmfs.scenario import SkuSet
    from rmfs.world.batteries import Batteries
    from rmfs.world.orders import Order
    from rmfs.world.pickers import Staff
    from rmfs.world.put_wall import PutWall


class WorldState:
    """A warehouse with its stock, work and robots; `World` adds the operations.

    Parameters
    ----------
    layout
        The warehouse at time zero.
    skus
        The K SKUs.

    Attributes
    ----------
    now_s
        Current simulated time in s.
    inventory, storage
        Stock on pods, and where the pods are.
    orders, bundles
        The backlogs of orders and of bundles.
    pick_stations, replenishment_stations
        The stations, in the order of the layout.
    slot_news
        Notifications of changed pick stations. A pick station counts as changed when it is switched
        on or off, when a robot reaches or leaves it, and when it gains or loses an order.
    work_news
        Notifications, by number in the common numbering, of stations that gain open work or may
        have none left. Open work is work for which no pod is under way.
    work_stations
        The stations to which rules assign work: all pick and replenishment stations, in the common
        numbering (see `stations`).
    stations
        All stations in the common numbering: pick stations, then replenishment stations, then the
        others.
    need
        Open units (not yet bound to a pod) of the orders at each of the S pick stations, per SKU,
        shape (S, K).
    queued_need
        Open units of the orders in the pool of each pick station, per SKU, shape (S, K).
    lines
        Number of order lines, picked or not, of the open orders, per pick station and SKU, shape
        (S, K).
    bundles_waiting
        Number of assigned bundles not yet part of a task, per replenishment station and pod, shape
        (replenishment stations, P).
    robots
        The robots, by index.
    asking
        Robots without a task, keyed by index, in the order in which their last tasks ended.
    resting
        Robots at rest or on their way to rest, keyed by index.
    orders_created, orders_completed, bundles_created, bundles_stored, units_picked, units_stored
        Counts since time zero.
    units_initial
        Units on the pods at time zero.
    unstored_space
        Space of all bundles created and not yet stored, in space units.
    incoming
        Units of all bundles created and not yet stored, per SKU, shape (K,).
    order_redraws
        Number of times that an order line was drawn again because stock could not serve it.
    orders_short
        Number of orders that arrived although stock could not serve them.
    batteries
        The robots' batteries; None if energy is unlimited.
    put_wall
        The put wall for parts of split orders; None if the scenario has no packing.
    staff
        The pickers at the pick stations; None in scenarios without pickers.
    split_orders
        Split orders that are not complete yet, by index.
    tasks_dropped
        Number of prepared tasks that had become impossible when they were due.
    """

    def __init__(self, layout: Layout, skus: SkuSet) -> None:
        self.layout = layout
        self.skus = skus
        self.now_s = 0.0
        tier: list[int] = layout.tier.tolist()
        self.robots = [Robot(i, tier[w], w) for i, w in enumerate(layout.robot_waypoint.tolist())]
        self.inventory = Inventory(
            skus.space_per_unit, layout.pod_capacity, len(layout.pick_stations)
        )
        self.asking: dict[int, Robot] = dict(enumerate(self.robots))
        self.resting: dict[int, Robot] = {}
        self.storage = Storage(layout, self.robots)
        for robot in self.robots:
            self.storage.keep(robot, robot.waypoint)
        self.orders = OrderBacklog()
        self.bundles = BundleBacklog()
        need = np.zeros((len(layout.pick_stations), len(skus)), np.int32)
        queued_need = np.zeros_like(need)
        self._lines = np.zeros_like(need)
        waiting = np.zeros((len(layout.replenishment_stations), layout.pods), np.int32)
        self.need: NDArray[np.int32] = read_only(need)
        self.lines: NDArray[np.int32] = read_only(self._lines)
        self.queued_need: NDArray[np.int32] = read_only(queued_need)
        self.bundles_waiting: NDArray[np.int32] = read_only(waiting)
        self.slot_news = slots = News(len(layout.pick_stations))
        self.work_news = work = News(len(layout.pick_stations) + len(layout.replenishment_stations))
        self.pick_stations = [
            PickStation(i, station, tier[station.waypoint], need[i], queued_need[i], slots, work)
            for i, station in enumerate(layout.pick_stations)
        ]
        self.replenishment_stations = [
            ReplenishmentStation(
                len(self.pick_stations) + i, i, station, tier[station.waypoint], waiting[i], work
            )
            for i, station in enumerate(layout.replenishment_stations)
        ]
        self.work_stations: list[PickStation | ReplenishmentStation] = [
            *self.pick_stations,
            *self.replenishment_stations,
        ]
        self.other_stations = [
            plan.kind.part("state", Station)(
                len(self.work_stations) + i,
                sum(other.kind.name == plan.kind.name for other in layout.other_stations[:i]),
                plan.waypoint,
                tier[plan.waypoint],
            )
            for i, plan in enumerate(layout.other_stations)
        ]
        self.stations: list[Station[Any]] = [*self.work_stations, *self.other_stations]
        self.batteries: Batteries | None = None
        self.put_wall: PutWall | None = None
        self.staff: Staff | None = None
        self.split_orders: dict[int, Order] = {}
        self.tasks_dropped = 0
        self.orders_created = 0
        self.order_redraws = 0
        self.orders_completed = 0
        self.bundles_created = 0
        self.bundles_stored = 0
        self.units_picked = 0
        self.units_stored = 0
        self.unstored_space = 0.0
        self.orders_short = 0
        self._incoming = np.zeros(len(skus), np.int64)
        self.incoming: NDArray[np.int64] = read_only(self._incoming)
        self.units_initial = 0

    def _replenishment_station(self, station: int) -> ReplenishmentStation:
        """Return a replenishment station by its number among all stations."""
        return self.replenishment_stations[station - len(self.pick_stations)]

    @property
    def load(self) -> float:
        """Space of the stock on pods and of all bundles not yet stored, in space units."""
        return self.inventory.stored_space + self.unstored_space

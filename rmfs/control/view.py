"""The state of the world that a controller may read."""

from __future__ import annotations

from functools import cached_property
from math import inf
from typing import TYPE_CHECKING

from rmfs.control.trackers import Trackers
from rmfs.layout.charging import Charger
from rmfs.world.charging import RecoveryStation

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from rmfs.control.travel import Travel
    from rmfs.scenario import OrderContent
    from rmfs.world import World
    from rmfs.world.batteries import Batteries
    from rmfs.world.orders import Order
    from rmfs.world.pickers import Staff
    from rmfs.world.put_wall import PutWall
    from rmfs.world.robots import Robot


class View:
    """The state of the world as controllers see it; they may read but not change it.

    The arrays are read-only. Controllers may read the attributes of objects (orders, stations,
    robots), but must not call methods that change something.

    Attributes
    ----------
    layout, skus
        The warehouse and the SKUs.
    inventory
        The stock on pods: contained and available units, and the space reserved for bundles
        (`rmfs.world.inventory`).
    storage
        Where pods are stored, and which pods and storage locations robots have reserved
        (`rmfs.world.storage`).
    orders, bundles
        The backlogs of orders and of bundles (`rmfs.world.backlog`).
    pick_stations, replenishment_stations, stations
        The pick stations, the replenishment stations, and both together, pick stations first
        (`rmfs.world.stations`).
    all_stations
        All stations, including those of other kinds, which come last.
    slot_news, work_news
        Notifications (`rmfs.world.news`). `slot_news` reports pick stations that were switched on
        or off, that a robot reached or left, or that gained or lost an order. `work_news` reports
        stations that gained open work or may have none left.
    need
        Open units per pick station and SKU, shape (S, K): units that the station's open orders need
        and that are not bound to a pod.
    lines
        Number of order lines, picked or not, of the open orders, per pick station and SKU, shape
        (S, K).
    bundles_waiting
        Number of assigned bundles that are not yet part of a task, per replenishment station and
        pod, shape (S, P).
    recovery_stations
        Stations where robots get energy: chargers and battery swap stations.
    robots
        All robots, in order of index.
    asking, resting
        The robots that need a task, by index; and the robots that are at rest or on their way to
        rest, by index.
    queued_need
        The same as `need`, but for the orders in the stations' pools instead of the open orders.
    travel
        Travel times and distances.
    end_s
        Simulated time at which the run ends, in s; inf if unknown.
    time_of_day_s
        Time of day at time zero, in s.
    trackers
        Statistics shared by controllers (`rmfs.control.trackers`).
    """

    def __init__(
        self,
        world: World,
        travel: Travel,
        end_s: float = inf,
        draw_past_orders: Callable[[], Sequence[OrderContent]] = tuple,
        time_of_day_s: float = 0.0,
    ) -> None:
        self._world = world
        self._draw_past_orders = draw_past_orders
        self.layout = world.layout
        self.skus = world.skus
        self.inventory = world.inventory
        self.storage = world.storage
        self.orders = world.orders
        self.bundles = world.bundles
        self.pick_stations = world.pick_stations
        self.replenishment_stations = world.replenishment_stations
        self.stations = world.work_stations
        self.all_stations = world.stations
        self.slot_news, self.work_news = world.slot_news, world.work_news
        self.need = world.need
        self.lines = world.lines
        self.bundles_waiting = world.bundles_waiting
        self.recovery_stations = [s for s in world.stations if isinstance(s, RecoveryStation)]
        self.robots = world.robots
        self.asking = world.asking
        self.resting = world.resting
        self.queued_need = world.queued_need
        self.travel = travel
        self.end_s = end_s
        self.time_of_day_s = time_of_day_s
        self.trackers = Trackers(self)

    @property
    def now_s(self) -> float:
        """Current simulated time in s."""
        return self._world.now_s

    @property
    def batteries(self) -> Batteries | None:
        """The robots' batteries; None if energy is unlimited."""
        return self._world.batteries

    @property
    def put_wall(self) -> PutWall | None:
        """The put wall for parts of split orders; None if the scenario has no packing."""
        return self._world.put_wall

    @property
    def staff(self) -> Staff | None:
        """The pickers at the pick stations; None in scenarios without pickers."""
        return self._world.staff

    def unit_s(self, station: int) -> float:
        """Return the mean time per unit at a pick station, in s, at its picker's present speed.

        The additional time for layers and faces of a pod and for picking errors is not included. If
        the station has no picker, the result is the time per unit that the layout specifies.
        """
        staff = self._world.staff
        if staff is None or staff.at_station[station] is None:
            return self.layout.pick_stations[station].unit_transfer_s
        return staff.unit_s(station, self._world.now_s)

    @property
    def split_orders(self) -> Mapping[int, Order]:
        """The split orders that still have units to be picked, by index."""
        return self._world.split_orders

    @cached_property
    def chargers(self) -> list[RecoveryStation]:
        """The chargers among the recovery stations."""
        plans = self.layout.stations
        return [s for s in self.recovery_stations if isinstance(plans[s.index].kind, Charger)]

    @property
    def orders_created(self) -> int:
        """Number of orders that have arrived since time zero."""
        return self._world.orders_created

    @cached_property
    def past_orders(self) -> Sequence[OrderContent]:
        """Orders from before the run, for rules that learn from them (`rmfs.simulation.past`)."""
        return self._draw_past_orders()

    def pod_waypoint(self, pod: int) -> int:
        """Return the waypoint of a stored pod or, for a carried pod, that of its robot.

        The waypoint of a robot is the next one at which it stops (`Travel.robot_waypoint`).
        """
        place = self.storage.place_of[pod]
        return place if place >= 0 else self.travel.robot_waypoint(self.storage.claimed_by[pod])

    def work_version(self, station: int) -> tuple[int, ...]:
        """Return the version of a station's work.

        The version changes when work is added, when a pod becomes available, and when other pods
        than before may be useful for the station's pool. If no pod was found for a station, another
        search is useless until the version has changed.
        """
        return self.storage.version, *self.all_stations[station].work_version

    def has_open_work(self, station: int) -> bool:
        """Return whether a station has units to pick, or bundles, for which no pod is under way."""
        return self.all_stations[station].has_open_work

    def robot_target(self, robot: Robot) -> int:
        """Return the waypoint of the pod that a robot fetches; without one, `robot.waypoint`."""
        task = robot.task
        if task is None or task.pod < 0 or robot.pod >= 0:
            return robot.waypoint
        return self.storage.place_of[task.pod]

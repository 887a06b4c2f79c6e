"""What a controller may read."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from rmfs.control.travel import Travel
    from rmfs.world import World
    from rmfs.world.robots import Robot
    from rmfs.world.stations import ReplenishmentStation


class View:
    """The world as controllers see it: to be read, never to be changed.

    Its arrays are read-only; of its objects (orders, stations, robots) controllers read the
    attributes and leave the methods that change something to the simulation.

    Attributes
    ----------
    layout, skus
        The warehouse and the SKUs.
    inventory
        Stock: contained, available and promised (`rmfs.world.inventory`).
    storage
        Places, pods and claims (`rmfs.world.storage`).
    orders, bundles
        The two backlogs (`rmfs.world.backlog`).
    pick_stations, replenishment_stations, stations
        `stations` holds both, pick stations first (`rmfs.world.stations`).
    need
        Open units per pick station and SKU, shape (S, K).
    bundles_waiting
        Assigned bundles not yet in a task, per replenishment station and pod, shape (S, P).
    robots, asking, resting
        All robots; those that need a task; those at rest.
    travel
        Travel times.
    """

    def __init__(self, world: World, travel: Travel) -> None:
        self._world = world
        self.layout = world.layout
        self.skus = world.skus
        self.inventory = world.inventory
        self.storage = world.storage
        self.orders = world.orders
        self.bundles = world.bundles
        self.pick_stations = world.pick_stations
        self.replenishment_stations = world.replenishment_stations
        self.stations = world.stations
        self.need = world.need
        self.bundles_waiting = world.bundles_waiting
        self.robots = world.robots
        self.asking = world.asking
        self.resting = world.resting
        self.travel = travel

    @property
    def now_s(self) -> float:
        """Present simulated time."""
        return self._world.now_s

    def pod_waypoint(self, pod: int) -> int:
        """Where a pod is: its place, or the next waypoint at which the robot below it stops."""
        place = self.storage.place_of[pod]
        return place if place >= 0 else self.travel.robot_waypoint(self.storage.claimed_by[pod])

    def can_serve(self, pod: int, station: int) -> bool:
        """Whether there is work for a pod at a station of either kind."""
        if station < len(self.pick_stations):
            skus = list(self.pick_stations[station].requests.lines)
            return self.inventory.serves(pod, skus)
        return pod in self._replenishment_station(station).waiting

    def work_for(self, pod: int, station: int) -> int:
        """Open requests a pod can serve at a pick station, or bundles that wait there for it."""
        if station < len(self.pick_stations):
            need, available = self.need[station].item, self.inventory.available.item
            skus = self.pick_stations[station].requests.lines
            return sum(min(need(sku), available(sku, pod)) for sku in skus)
        return len(self._replenishment_station(station).waiting.get(pod, ()))

    def work_version(self, station: int) -> tuple[int, int]:
        """Grows with new work at a station and with pods that come to hand.

        If no pod was found for a station, none will be found before this changes.
        """
        if station < len(self.pick_stations):
            return self.pick_stations[station].requests.version, self.storage.version
        return self._replenishment_station(station).version, self.storage.version

    def has_open_work(self, station: int) -> bool:
        """Whether there are requests, or bundles, at a station for which no pod is under way."""
        if station < len(self.pick_stations):
            return self.pick_stations[station].requests.units > 0
        return bool(self._replenishment_station(station).waiting)

    def robot_target(self, robot: Robot) -> int:
        """Where a robot's present task takes it first, or where it is."""
        task = robot.task
        if task is None or task.pod < 0 or robot.pod >= 0:
            return robot.waypoint
        return self.storage.place_of[task.pod]

    def _replenishment_station(self, station: int) -> ReplenishmentStation:
        return self.replenishment_stations[station - len(self.pick_stations)]

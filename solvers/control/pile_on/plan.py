"""The plan: orders that wait for a slot, and pods that wait for a robot."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from rmfs.solvers.control.splitting import Splitting

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Mapping, Sequence

    from rmfs.control.asks import Call
    from rmfs.control.view import View
    from rmfs.solvers.control.items import Item
    from rmfs.world.orders import Order
    from rmfs.world.robots import Robot
    from rmfs.world.stations import PickStation


@dataclass(frozen=True, eq=False)
class Planned:
    """An item planned for a station.

    Attributes
    ----------
    call
        The call of the optimiser that planned the item; None if a rule planned it.
    """

    item: Item
    call: Call | None


class Called(NamedTuple):
    """A decision to bring a pod to a station, and the robot that is to fetch the pod.

    Attributes
    ----------
    call
        The call of the optimiser that made the decision; None if a rule made it.
    robot
        The robot that is to fetch the pod; -1 if any robot may.
    """

    call: Call | None
    robot: int = -1


class Plan:
    """For each pick station, items that wait for a slot, and called pods that wait for a robot.

    A planned item reserves stock: later questions omit the item, and count its units as demand of
    the station for which it is planned.

    Attributes
    ----------
    items
        Items planned for each station.
    pods
        Pods called for each station.

    Parameters
    ----------
    view
        The world.
    kept_slots
        Number of slots of each station that are reserved, mainly for orders that the pod at the
        head of the station's queue can serve (see `due`).
    later
        Whether items may be assigned before pods are called for all their lines.
    split_orders
        Maximum number of orders split at a time; None: as many as the put wall holds, or no limit
        if there is no put wall.
    """

    def __init__(
        self,
        view: View,
        kept_slots: int,
        *,
        later: bool = False,
        split_orders: int | None = None,
    ) -> None:
        self._view = view
        self._split_orders = split_orders
        self._later = later
        self._kept = [min(kept_slots, station.slots - 1) for station in view.pick_stations]
        self.items: list[list[Planned]] = [[] for _ in view.pick_stations]
        self.pods: list[dict[int, Called]] = [{} for _ in view.pick_stations]

    def keys(self) -> set[tuple[int, int]]:
        """Return the keys of all planned items."""
        return {planned.item.key for items in self.items for planned in items}

    def splitting(self, pays: Callable[[Order], bool] | None = None) -> Splitting:
        """Return the capacity left for split orders; orders with planned lines count as split.

        Parameters
        ----------
        pays
            Function that returns whether splitting an order is worth its cost; None: it always is.
        """
        planned = [one.item for items in self.items for one in items]
        orders = [item.order for item in planned if item.line is not None]
        return Splitting(self._view, self._split_orders, orders, pays)

    def extend(
        self,
        solution: Mapping[str, Any],
        items: Sequence[Item],
        call: Call | None,
        robots: Sequence[Robot] = (),
    ) -> None:
        """Add the valid parts of a solution to the plan; count the rest as stale.

        Parameters
        ----------
        solution
            For each pod, the station for which it is called (`pod_station`) and the robot that is
            to fetch it (`pod_robot`). For each item, the station at which it gets a slot
            (`station`), or whose pods can serve it although it gets no slot now (`prospect`). A
            value is -1 if there is none.
        items
            Items to which the indices in the solution refer.
        call
            The question that the solution answers; None if the optimiser failed and the method
            `greedy` decided.
        robots
            Robots to which the indices in `pod_robot` refer. Default: none; any robot may then
            fetch a called pod.
        """
        pod_station, pod_robot = (np.asarray(solution[k]) for k in ("pod_station", "pod_robot"))
        for pod in np.flatnonzero(pod_station >= 0).tolist():
            if self._view.storage.is_at_hand[pod] and not any(pod in pods for pods in self.pods):
                number = int(pod_robot[pod])
                robot = robots[number].index if robots and number >= 0 else -1
                self.pods[int(pod_station[pod])][pod] = Called(call, robot)
            else:
                self._stale(call)
        known, splitting = self.keys(), self.splitting()
        for station_of in (np.asarray(solution["station"]), np.asarray(solution["prospect"])):
            for number in np.flatnonzero(station_of >= 0).tolist():
                item = items[number]
                allowed = item.line is None or splitting.admits(item.order)
                if allowed and item.waits(self._view) and item.key not in known:
                    if item.line is not None:
                        splitting.add(item.order)
                    self.items[int(station_of[number])].append(Planned(item, call))
                else:
                    self._stale(call)

    def due(self, station: PickStation) -> Iterator[Planned]:
        """Yield items that can be assigned to a station now, one at a time.

        Items that the pod at the head of the queue can serve come first, and may use the reserved
        slots (`kept_slots`). A called pod is fetched only once it can serve an item with a slot at
        the station. As long as it can serve no such item, other items that it can serve may use
        the reserved slots, too. Items are dropped and counted as stale if they have left
        the backlog. Unless `later` is true, they are also dropped if pods called or under way no
        longer have enough units for them.
        """
        self._forget_pods(station)
        waiting = self.items[station.index]
        if not waiting or not station.active:
            return
        head = self._head(station)
        if head >= 0:
            waiting.sort(key=lambda planned: not self._serves(head, planned.item))
        for planned in list(waiting):
            item = planned.item
            covered = self._later or self._covered(item, station)
            if not item.waits(self._view) or not covered:
                waiting.remove(planned)
                self._stale(planned.call)
            elif self._has_slot(item, station, head):
                waiting.remove(planned)
                yield planned

    def _has_slot(self, item: Item, station: PickStation, head: int) -> bool:
        if item.order.index in station.orders:
            return True
        if station.free_slots > self._kept[station.index]:
            return True
        if station.free_slots <= 0:
            return False
        if head >= 0 and self._serves(head, item):
            return True
        skus = list(station.requests.lines)
        return any(
            self._serves(pod, item) and not self._view.inventory.serves(pod, skus)
            for pod in self.pods[station.index]
        )

    def _head(self, station: PickStation) -> int:
        """Return the pod at the head of the queue if it is there for picks, otherwise -1."""
        if station.robot < 0:
            return -1
        pod = self._view.robots[station.robot].pod
        return pod if pod in station.tasks else -1

    def _serves(self, pod: int, item: Item) -> bool:
        available = self._view.inventory.available.item
        return all(available(line.sku, pod) >= line.units for line in item.lines)

    def _covered(self, item: Item, station: PickStation) -> bool:
        """Whether pods under way or called have enough unreserved units for an item."""
        inventory, index = self._view.inventory, station.index
        available, need = inventory.available.item, self._view.need.item
        for line in item.lines:
            spare = inventory.inbound.item(index, line.sku) - need(index, line.sku)
            spare += sum(available(line.sku, pod) for pod in self.pods[index])
            if spare < line.units:
                return False
        return True

    def _forget_pods(self, station: PickStation) -> None:
        """Drop called pods that are no longer available, or no longer needed at the station."""
        pods = self.pods[station.index]
        for pod in list(pods):
            wanted = self.useful(pod, station) or self._is_planned_for(pod, station)
            if not (wanted and self._view.storage.is_at_hand[pod]):
                self._stale(pods.pop(pod).call)

    def _is_planned_for(self, pod: int, station: PickStation) -> bool:
        available = self._view.inventory.available.item
        return any(
            available(line.sku, pod)
            for planned in self.items[station.index]
            for line in planned.item.lines
        )

    def useful(self, pod: int, station: PickStation) -> bool:
        """Whether a pod is available, and can serve an open request of a station.

        Pods that are being carried, or are reserved for a task, are not available.
        """
        inventory, at_hand = self._view.inventory, self._view.storage.is_at_hand.item
        return bool(at_hand(pod)) and inventory.serves(pod, list(station.requests.lines))

    @staticmethod
    def _stale(call: Call | None) -> None:
        if call is not None:
            call.stale += 1

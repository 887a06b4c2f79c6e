"""The plan: visits to come, and orders that wait for their slots."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from rmfs.solvers.control.planning.snapshot import under_way
from rmfs.solvers.control.splitting import Splitting

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping, Sequence

    from rmfs.control.asks import Call
    from rmfs.control.decisions import AssignLines, AssignOrder
    from rmfs.control.view import View
    from rmfs.solvers.control.items import Item
    from rmfs.solvers.control.planning.snapshot import Memo
    from rmfs.world.stations import PickStation


@dataclass(frozen=True, eq=False)
class Planned:
    """A waiting order, or a line of a waiting order, planned for a station.

    Attributes
    ----------
    first, last
        Numbers of the first and the last visit that serve the item (the order or line), as counted
        when the plan was made.
    units
        Number of units that each pod supplies for the item, by index of the pod.
    begins_with
        The pod of the first visit that serves the item.
    """

    item: Item
    first: int
    last: int
    units: Mapping[int, int]
    begins_with: int

    @property
    def sequence(self) -> tuple[int, int, tuple[int, int]]:
        """Sort key, by which items that are served earlier come first."""
        return self.first, self.last, self.item.key


class Plan:
    """The last plan, as far as it is still valid.

    Parameters
    ----------
    split_orders
        Maximum number of orders split at a time; None: as many as the put wall holds.

    Attributes
    ----------
    pods
        For each station, the pods that are planned but not yet called, in sequence.
    """

    def __init__(self, view: View, split_orders: int | None = None) -> None:
        self._view = view
        self._split_orders = split_orders
        self.pods: list[list[int]] = [[] for _ in view.pick_stations]
        self._orders: list[list[Planned]] = [[] for _ in view.pick_stations]
        self._call: list[Call | None] = [None for _ in view.pick_stations]

    def take(self, solution: Mapping[str, Any], memo: Memo, call: Call | None) -> None:
        """Adopt a solution as the new plan for the stations that the question was about."""
        visits: dict[int, list[tuple[int, int]]] = {}
        served = zip(memo.lines, memo.order_of, solution["line_visit"].tolist(), strict=True)
        for line, number, visit in served:
            if visit >= 0:
                visits.setdefault(number, []).append((visit, line.open_units))
        stations = solution["order_station"].tolist()
        sequences = [
            [*memo.under_way[number], *(pod for pod in row if pod >= 0)]
            for number, row in enumerate(solution["pods"].tolist())
        ]
        hoped = _only_hoped_for(visits, stations, memo.expected)
        for number, sequence in enumerate(sequences):
            station, first = memo.stations[number].index, len(memo.under_way[number])
            self.pods[station] = [
                pod
                for visit, pod in enumerate(sequence[first:], first)
                if (number, visit) not in hoped
            ]
            self._orders[station] = []
            self._call[station] = call
        splitting = self.splitting(range(len(self._orders)))
        for number, (item, at) in enumerate(zip(memo.items, stations, strict=True)):
            if at >= 0 and item is not None and item.waits(self._view):
                if item.line is not None:
                    if not splitting.admits(item.order):
                        self._stale(memo.stations[at].index)
                        continue
                    splitting.add(item.order)
                planned = _planned(item, visits[number], sequences[at])
                self._orders[memo.stations[at].index].append(planned)
        for orders in self._orders:
            orders.sort(key=lambda one: one.sequence)

    def call(self, station: int) -> Call | None:
        """Return the optimiser call that made a station's plan; None if the start rule made it."""
        return self._call[station]

    def keys_of(self, stations: Sequence[int]) -> set[tuple[int, int]]:
        """Return the keys (`Item.key`) of the orders, or lines, planned for these stations."""
        return {one.item.key for station in stations for one in self._orders[station]}

    def splitting(self, stations: Iterable[int]) -> Splitting:
        """Return the capacity left for split orders, given the lines planned for these stations."""
        planned = [one.item for station in stations for one in self._orders[station]]
        orders = [item.order for item in planned if item.line is not None]
        return Splitting(self._view, self._split_orders, orders)

    def next_pod(self, station: int) -> int:
        """Return the first planned pod of a station that is still available, or -1."""
        pods = self.pods[station]
        while pods and not self._view.storage.is_at_hand[pods[0]]:
            pods.pop(0)
            self._stale(station)
        return pods[0] if pods else -1

    def due(self, station: PickStation) -> Iterator[AssignOrder | AssignLines]:
        """Yield assignments due now; the caller carries out each before requesting the next.

        An order (or line) is due if its first pod is under way. One slot is reserved for orders
        (or lines) that need only the pod at the head of the queue.
        """
        waiting = self._orders[station.index]
        if not waiting or not station.active:
            return
        head = self._head(station)
        for planned in [
            p for p in waiting if p.begins_with == head or p.begins_with in station.tasks
        ]:
            if not planned.item.waits(self._view):
                waiting.remove(planned)
                self._stale(station.index)
                continue
            streams = list(planned.units) == [head]
            joins = planned.item.order.index in station.orders
            if joins or station.free_slots > (0 if streams else 1):
                waiting.remove(planned)
                yield planned.item.decision(station.index)

    def streams(self, pod: int, station: int) -> bool:
        """Whether an order, or line, that waits for a slot of the station needs only this pod."""
        return any(list(planned.units) == [pod] for planned in self._orders[station])

    def units(self, station: PickStation) -> int:
        """Return the units that pods under way supply to the station's open and planned orders."""
        view, index = self._view, station.index
        coming = under_way(view, station)
        units = sum(len(task.picks) for task in station.tasks.values())
        units += int(np.minimum(view.need[index], view.inventory.inbound[index]).sum())
        orders = self._orders[index]
        return units + sum(one.units.get(pod, 0) for one in orders for pod in coming)

    def _head(self, station: PickStation) -> int:
        return self._view.robots[station.robot].pod if station.robot >= 0 else -1

    def _stale(self, station: int) -> None:
        call = self._call[station]
        if call is not None:
            call.stale += 1


def _only_hoped_for(
    visits: Mapping[int, Sequence[tuple[int, int]]], stations: Sequence[int], expected: int
) -> set[tuple[int, int]]:
    """Return the visits that serve only future orders, as pairs of station and number of the visit.

    Parameters
    ----------
    visits
        Visits that serve each order, with the number of units, by number of the order.
    stations
        Station of each order.
    expected
        Number of the first future order.
    """
    needed, hoped = (
        {
            (stations[number], visit)
            for number, served in visits.items()
            if (number >= expected) == to_come
            for visit, _ in served
        }
        for to_come in (False, True)
    )
    return hoped - needed


def _planned(item: Item, visits: list[tuple[int, int]], sequence: list[int]) -> Planned:
    units: dict[int, int] = {}
    for visit, count in visits:
        units[sequence[visit]] = units.get(sequence[visit], 0) + count
    numbers = [visit for visit, _ in visits]
    first = min(numbers)
    return Planned(item, first, max(numbers), units, sequence[first])

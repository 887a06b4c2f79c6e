"""Which orders go with given visits, in plain Python: what the compiled filling must do as well."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from rmfs.solvers.models.planning.values import NONE

if TYPE_CHECKING:
    from collections.abc import Sequence

    from rmfs.solvers.models.planning.data import Planning

Line = tuple[int, int, int]
"""SKU, units and number of a line."""
Window = tuple[int, int, tuple[int, ...]]
"""First and last visit of an order, and that of each line."""
Stock = dict[int, int]
"""Units per SKU."""


class Draft(NamedTuple):
    """Visits and what they serve, in plain lists.

    Attributes
    ----------
    pods
        New visits per station.
    order_station, line_visit
        As in a `Plan`.
    earned
        Worth of what is served and closed.
    value
        The same less the cost of the visits: the objective with the other sign.
    """

    pods: list[list[int]]
    order_station: list[int]
    line_visit: list[int]
    earned: float
    value: float


class Filling:
    """Fills visits with orders.

    Open orders come first, each line in the first visit that has its units. A waiting order takes
    the visits closest together that have its lines: first the orders of one visit, which keep no
    slot, then those of visits next to each other, and so on; among them those that begin first.
    """

    def __init__(self, data: Planning) -> None:
        self.data = data
        self._lines: list[list[Line]] = [[] for _ in range(data.orders)]
        rows = zip(data.line_order.tolist(), data.line_sku.tolist(), data.line_units.tolist(),
                   strict=True)  # fmt: skip
        for number, (order, sku, units) in enumerate(rows):
            self._lines[order].append((sku, units, number))
        station = data.order_station.tolist()
        self._open = [(order, at) for order, at in enumerate(station) if at >= 0]
        waiting = [(order, self._lines[order]) for order, at in enumerate(station) if at < 0]
        self._single = [(order, lines[0]) for order, lines in waiting if len(lines) == 1]
        self._several = [(order, lines) for order, lines in waiting if len(lines) > 1]
        self._order_of: list[int] = data.line_order.tolist()
        self._wanted = sorted(set(data.line_sku.tolist()))
        self._stock: dict[int, Stock] = {}
        self._order_worth: list[float] = data.order_worth.tolist()
        self._line_worth: list[float] = data.line_worth.tolist()
        self._until: list[int] = data.order_until.tolist()
        longest = data.visits + max((len(pods) for pods in data.under_way), default=0)
        self._decay = [data.decay**visit for visit in range(longest + 1)]

    def draft(self, pods: Sequence[Sequence[int]]) -> Draft:
        """Fill visits; new ones that would serve nothing are left out."""
        new = [list(one) for one in pods]
        while True:
            draft = self._fill(new)
            kept = self._useful(draft)
            if kept == new:
                return draft
            new = kept

    def cost(self, pods: Sequence[Sequence[int]]) -> float:
        """Sum the costs of new visits, s."""
        cost, decay = self.data.cost, self._decay
        return sum(
            cost.item(pod, station) * decay[visit]
            for station, new in enumerate(pods)
            for visit, pod in enumerate(new, start=len(self.data.under_way[station]))
        )

    def _useful(self, draft: Draft) -> list[list[int]]:
        """Return the new visits that serve something."""
        station_of = draft.order_station
        served = {
            (station_of[order], visit)
            for order, visit in zip(self._order_of, draft.line_visit, strict=True)
            if visit >= 0
        }
        return [
            [
                pod
                for visit, pod in enumerate(pods, start=len(self.data.under_way[station]))
                if (station, visit) in served
            ]
            for station, pods in enumerate(draft.pods)
        ]

    def _fill(self, new: list[list[int]]) -> Draft:
        data = self.data
        left = [
            [dict(self._units_on(pod)) for pod in (*before, *after)]
            for before, after in zip(data.under_way, new, strict=True)
        ]
        where = [_visits_with(pods) for pods in left]
        draft = _Growing(data, left, where)
        earned = self._serve_open(draft) + self._serve_waiting(draft)
        return Draft(new, draft.order_station, draft.line_visit, earned, earned - self.cost(new))

    def _units_on(self, pod: int) -> Stock:
        """Units of wanted SKUs on a pod."""
        found = self._stock.get(pod)
        if found is None:
            row = self.data.stock[pod, self._wanted].tolist()
            found = {sku: units for sku, units in zip(self._wanted, row, strict=True) if units}
            self._stock[pod] = found
        return found

    def _serve_open(self, draft: _Growing) -> float:
        """Serve open orders as soon as possible; returns what that is worth."""
        earned = 0.0
        for order, station in self._open:
            left, where, kept = draft.left[station], draft.where[station], draft.kept[station]
            last, missing = self._until[order], False
            for sku, units, number in self._lines[order]:
                visit = _first_with(units, sku, where, left)
                if visit < 0:
                    missing = True
                    continue
                left[visit][sku] -= units
                draft.line_visit[number] = visit
                earned += self._line_worth[number] * self._decay[visit]
                last = max(last, visit)
            if missing:
                last = len(left)
            elif last >= 0:
                earned += self._order_worth[order] * self._decay[last]
            for visit in range(last):
                kept[visit] += 1
        return earned

    def _serve_waiting(self, draft: _Growing) -> float:
        """Give waiting orders a station and visits; returns what that is worth."""
        earned, decay, station_of = 0.0, self._decay, draft.order_station
        for _, _, order, station, window in self._chances(draft):
            if station_of[order] >= 0:
                continue
            lines, left = self._lines[order], draft.left[station]
            chosen: Window | None = window
            for (sku, units, _), visit in zip(lines, window[2], strict=True):
                if left[visit][sku] < units:  # others have taken them meanwhile
                    chosen = _closest(lines, draft.where[station], left)
                    break
            if chosen is None or not draft.keep(station, chosen):
                continue
            for (sku, units, number), visit in zip(lines, chosen[2], strict=True):
                left[visit][sku] -= units
                draft.line_visit[number] = visit
                earned += self._line_worth[number] * decay[visit]
            earned += self._order_worth[order] * decay[chosen[1]]
            station_of[order] = station
        return earned

    def _chances(self, draft: _Growing) -> list[tuple[int, int, int, int, Window]]:
        """Which order could go where: length, begin, order, station and its visits, sorted."""
        found = []
        for station, (left, where) in enumerate(zip(draft.left, draft.where, strict=True)):
            for order, lines in self._several:
                if lines[0][0] in where and lines[1][0] in where:
                    window = _closest(lines, where, left)
                    if window is not None:
                        found.append((window[1] - window[0], window[0], order, station, window))
            for order, (sku, units, _) in self._single:
                for visit in where.get(sku, ()):
                    if left[visit][sku] >= units:
                        found.append((0, visit, order, station, (visit, visit, (visit,))))
                        break
        found.sort()
        return found


class _Growing:
    """A draft while orders are put into it."""

    def __init__(
        self, data: Planning, left: list[list[Stock]], where: list[dict[int, list[int]]]
    ) -> None:
        self.left = left
        self.where = where
        self.kept = [[0] * len(pods) for pods in left]
        self.order_station: list[int] = data.order_station.tolist()
        self.line_visit = [NONE] * data.lines
        self._most = data.kept

    def keep(self, station: int, window: Window) -> bool:
        """Keep a slot from the first to the last visit, if there is one."""
        first, last, _ = window
        if first < last:
            kept = self.kept[station]
            if max(kept[first:last]) >= self._most[station]:
                return False
            for visit in range(first, last):
                kept[visit] += 1
        return True


def _visits_with(pods: Sequence[Stock]) -> dict[int, list[int]]:
    """Visits of each SKU, in their order."""
    found: dict[int, list[int]] = {}
    for visit, stock in enumerate(pods):
        for sku in stock:
            found.setdefault(sku, []).append(visit)
    return found


def _first_with(units: int, sku: int, where: dict[int, list[int]], left: Sequence[Stock]) -> int:
    """Return the first visit with so many units of a SKU, or -1."""
    for visit in where.get(sku, ()):
        if left[visit][sku] >= units:
            return visit
    return NONE


def _closest(
    lines: Sequence[Line], where: dict[int, list[int]], left: Sequence[Stock]
) -> Window | None:
    """Find the visits closest together with the units of all lines, the first if there are more."""
    if len(lines) == 1:
        sku, units, _ = lines[0]
        visit = _first_with(units, sku, where, left)
        return None if visit < 0 else (visit, visit, (visit,))
    choices = []
    for sku, units, _ in lines:
        visits = [visit for visit in where.get(sku, ()) if left[visit][sku] >= units]
        if not visits:
            return None
        choices.append(visits)
    # the heads of the lists are a window; whoever holds it back moves on
    at = [0] * len(choices)
    chosen = [visits[0] for visits in choices]
    best: Window | None = None
    while True:
        first, last = min(chosen), max(chosen)
        if best is None or last - first < best[1] - best[0]:
            best = first, last, tuple(chosen)
            if first == last:
                return best
        slow = chosen.index(first)
        at[slow] += 1
        if at[slow] == len(choices[slow]):
            return best
        chosen[slow] = choices[slow][at[slow]]

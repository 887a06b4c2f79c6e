"""Check of planning: future visits of pods to each station, and the lines that they serve."""

from __future__ import annotations

from math import fsum, inf
from typing import TYPE_CHECKING

from rmfs.solvers.decisions.checking.wrong import once, require, within

if TYPE_CHECKING:
    from rmfs.solvers.decisions.schema import Plain


def value(data: Plain, values: Plain) -> float:
    """Return the cost of new visits, less the value of lines served and orders completed."""
    stations, orders = len(data["slots"]), len(data["order_station"])
    at, visit_of = values["order_station"].tolist(), values["line_visit"].tolist()
    within("order_station", at, -1, stations)
    visits = _visits(data, values["pods"])
    parts = _cost(data, values["pods"])
    lines: list[list[int]] = [[] for _ in range(orders)]
    for line, order in enumerate(data["line_order"].tolist()):
        lines[order].append(line)
    for order, mine in enumerate(lines):
        _order(data, order, at[order], [visit_of[line] for line in mine])
        for line in mine:
            end = len(visits[at[order]]) if at[order] >= 0 else 0
            within(f"line_visit of line {line}", [visit_of[line]], -1, end)
    _stock(data, visits, at, visit_of)
    _slots(data, visits, at, lines, visit_of)
    decay = data["decay"]
    for line, visit in enumerate(visit_of):
        if visit >= 0:
            parts.append(-float(data["line_worth"][line]) * decay**visit)
    for order, mine in enumerate(lines):
        last = _last(data, order, [visit_of[line] for line in mine])
        if at[order] >= 0 and 0 <= last < inf:
            parts.append(-float(data["order_worth"][order]) * decay ** int(last))
    return fsum(parts)


def _visits(data: Plain, new: list[list[int]]) -> list[list[int]]:
    """Return the pods of each station's visits, those under way first."""
    visits: list[list[int]] = [[] for _ in data["slots"]]
    for pod, station in zip(data["coming"].tolist(), data["coming_to"].tolist(), strict=True):
        visits[station].append(pod)
    once("pods", (pod for pods in new for pod in pods))
    for station, pods in enumerate(new):
        within(f"pods[{station}]", pods, 0, len(data["stock"]))
        require(len(pods) <= data["visits"], f"pods[{station}]: more than {data['visits']} visits")
        visits[station] += pods
    return visits


def _cost(data: Plain, new: list[list[int]]) -> list[float]:
    parts = []
    coming_to = data["coming_to"].tolist()
    for station, pods in enumerate(new):
        first = coming_to.count(station)
        for number, pod in enumerate(pods):
            cost = float(data["cost"][pod, station])
            require(abs(cost) < inf, f"pods[{station}]: pod {pod} may not be called")
            parts.append(cost * data["decay"] ** (first + number))
    return parts


def _order(data: Plain, order: int, at: int, visits: list[int]) -> None:
    """Check that an open order keeps its station, and a waiting order is served whole or not."""
    station = int(data["order_station"][order])
    if station >= 0:
        require(
            at == station, f"order_station[{order}]: must be {station}, where the order is open"
        )
        return
    served = [visit >= 0 for visit in visits]
    whole = all(served) if at >= 0 else not any(served)
    require(whole, f"order {order}: must have a station and all its lines served, or neither")


def _last(data: Plain, order: int, visits: list[int]) -> float:
    """Return the visit that completes an order; inf if a line is not served, -1 without visits."""
    if any(visit < 0 for visit in visits):
        return inf
    return max([int(data["order_until"][order]), *visits])


def _stock(data: Plain, visits: list[list[int]], at: list[int], visit_of: list[int]) -> None:
    used: dict[tuple[int, int, int], int] = {}
    busy: set[tuple[int, int]] = set()
    for line, visit in enumerate(visit_of):
        if visit >= 0:
            station = at[int(data["line_order"][line])]
            busy.add((station, visit))
            key = station, visit, int(data["line_sku"][line])
            used[key] = used.get(key, 0) + int(data["line_units"][line])
    for (station, visit, sku), units in used.items():
        pod = visits[station][visit]
        have = int(data["stock"][pod, sku])
        require(units <= have, f"station {station}, visit {visit}: pod {pod} lacks SKU {sku}")
    coming_to = data["coming_to"].tolist()
    for station, pods in enumerate(visits):
        for visit in range(coming_to.count(station), len(pods)):
            require((station, visit) in busy, f"station {station}, visit {visit}: serves no line")


def _slots(
    data: Plain, visits: list[list[int]], at: list[int], lines: list[list[int]], visit_of: list[int]
) -> None:
    """Check that between two visits, each station has fewer open orders than slots.

    If as many orders as slots or more are open now and not completed in the first visit, their
    number is the limit instead.
    """
    kept: dict[tuple[int, int], int] = {}
    open_now = [0] * len(visits)
    for order, mine in enumerate(lines):
        station = at[order]
        if station < 0:
            continue
        was_open = int(data["order_station"][order]) >= 0
        if was_open and (mine or int(data["order_until"][order]) > 0):
            open_now[station] += 1
        mine_at = [visit_of[line] for line in mine]
        last = _last(data, order, mine_at)
        begin = 0 if was_open else min(mine_at)
        for visit in range(begin, len(visits[station]) - 1):
            if visit < last:
                kept[station, visit] = kept.get((station, visit), 0) + 1
    for (station, visit), count in kept.items():
        most = max(int(data["slots"][station]) - 1, open_now[station])
        require(
            count <= most,
            f"station {station}, visit {visit}: {count} orders stay open (most: {most})",
        )

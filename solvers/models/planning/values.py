"""A plan, its objective, and its feasibility."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from numpy.typing import NDArray

    from rmfs.solvers.models.planning.data import Integers, Planning

NONE = -1
_NEVER = np.iinfo(np.int64).max


@dataclass(frozen=True)
class Plan:
    """Which pods come, in which sequence, and which lines each visit serves.

    Attributes
    ----------
    pods
        Pods of the new visits of each station, in the sequence of the visits.
    order_station
        Station of each order, or -1 if the order keeps waiting, shape (O,).
    line_visit
        Number of the visit that serves each line, at the station of the line's order; -1 if the
        line is not served; shape (L,).
    """

    pods: Sequence[Sequence[int]]
    order_station: Integers
    line_visit: Integers


def nothing(data: Planning) -> Plan:
    """Return the plan without new visits or served lines; open orders stay at their station."""
    none: tuple[tuple[int, ...], ...] = ((),) * data.stations
    return Plan(none, data.order_station.copy(), np.full(data.lines, NONE))


def objective(data: Planning, plan: Plan) -> float:
    """Return the cost of new visits minus the rewards for served lines and closed orders, in s."""
    total = 0.0
    for station, pods in enumerate(plan.pods):
        first = len(data.under_way[station])
        for visit, pod in enumerate(pods, start=first):
            total += float(data.cost[pod, station]) * data.decay**visit
    served = plan.line_visit >= 0
    total -= float((data.line_worth[served] * data.decay ** plan.line_visit[served]).sum())
    closed = _is_closed(data, plan)
    last = _last_visit(data, plan)[closed]
    return total - float((data.order_worth[closed] * data.decay**last).sum())


def violations(data: Planning, plan: Plan) -> list[str]:
    """Return a message for each violation found; an empty list if the plan is feasible."""
    return [*_wrong_pods(data, plan), *_wrong_orders(data, plan), *_wrong_visits(data, plan)]


def _is_closed(data: Planning, plan: Plan) -> NDArray[np.bool_]:
    """Return whether each order is closed by the end of the plan, shape (O,)."""
    closed: NDArray[np.bool_] = plan.order_station >= 0
    closed = closed & (_last_visit(data, plan) >= 0)
    closed[data.line_order[plan.line_visit < 0]] = False
    return closed


def _last_visit(data: Planning, plan: Plan) -> Integers:
    """Return the last visit with units for each order, or -1, shape (O,)."""
    last = data.order_until.copy()
    np.maximum.at(last, data.line_order, plan.line_visit)
    return last


def _wrong_pods(data: Planning, plan: Plan) -> Iterator[str]:
    if len(plan.pods) != data.stations:
        yield "pods must have one list per station"
    called = [pod for pods in plan.pods for pod in pods]
    if len(set(called)) < len(called):
        yield "a pod makes two new visits"
    for station, pods in enumerate(plan.pods):
        if len(pods) > data.visits:
            yield f"station {station}: more than {data.visits} new visits"
        for pod in pods:
            if not np.isfinite(data.cost[pod, station]):
                yield f"station {station}: pod {pod} may not be called there"


def _wrong_orders(data: Planning, plan: Plan) -> Iterator[str]:
    is_open = data.order_station >= 0
    if (plan.order_station != data.order_station)[is_open].any():
        yield "an open order changes its station"
    waits = ~is_open[data.line_order]
    placed = plan.order_station[data.line_order] >= 0
    if (waits & (placed != (plan.line_visit >= 0))).any():
        yield "a waiting order must have all its lines served and a station, or neither"


def _wrong_visits(data: Planning, plan: Plan) -> Iterator[str]:
    at = plan.order_station[data.line_order]
    last, first = _last_visit(data, plan), np.full(data.orders, _NEVER)
    served = plan.line_visit >= 0
    np.minimum.at(first, data.line_order[served], plan.line_visit[served])
    first[data.order_station >= 0] = -1
    last[data.line_order[~served & (at >= 0)]] = _NEVER
    for station, new in enumerate(plan.pods):
        pods = [*data.under_way[station], *new]
        if (plan.line_visit[at == station] >= len(pods)).any():
            yield f"station {station}: a line is served by a visit that does not exist"
        for visit, pod in enumerate(pods):
            here = (at == station) & (plan.line_visit == visit)
            used = np.bincount(data.line_sku[here], data.line_units[here], data.stock.shape[1])
            if (used > data.stock[pod]).any():
                yield f"station {station}, visit {visit}: pod {pod} holds too few units"
            if visit >= len(data.under_way[station]) and not here.any():
                yield f"station {station}, visit {visit}: serves no line"
            mine = plan.order_station == station
            if visit + 1 < len(pods):
                kept = int((mine & (first <= visit) & (last > visit)).sum())
                if kept > data.kept[station]:
                    yield (
                        f"station {station}, visit {visit}: {kept} orders stay open, but only "
                        f"{data.kept[station]} may"
                    )

"""Check of rack allocation: assignment of orders and pods to stations."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rmfs.solvers.decisions.checking.wrong import require, within

if TYPE_CHECKING:
    from rmfs.solvers.decisions.schema import Plain


def value(data: Plain, values: Plain) -> float:
    """Return the number of pods used."""
    order_station, pod_station = values["order_station"].tolist(), values["pod_station"].tolist()
    slots = data["slots"].tolist()
    within("order_station", order_station, -1, len(slots))
    within("pod_station", pod_station, -1, len(slots))
    for station, most in enumerate(slots):
        count = order_station.count(station)
        require(
            count == most, f"order_station: station {station} must get {most} orders, not {count}"
        )
    skus = data["units"].shape[1]
    have = [[0] * skus for _ in slots]
    for pod, station in enumerate(pod_station):
        if station >= 0:
            for sku in data["stock"][pod].nonzero()[0].tolist():
                have[station][sku] += int(data["stock"][pod, sku])
    for order, station in enumerate(order_station):
        if station >= 0:
            for sku in data["units"][order].nonzero()[0].tolist():
                have[station][sku] -= int(data["units"][order, sku])
                require(have[station][sku] >= 0, f"pod_station: station {station} lacks SKU {sku}")
    return float(sum(station >= 0 for station in pod_station))

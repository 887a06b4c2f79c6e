"""The value that PPS rules give to the requests of an order."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal

if TYPE_CHECKING:
    from rmfs.world.orders import Order

RequestValue = Literal["picks", "age", "lateness"]


def value_of(order: Order, now_s: float, metric: RequestValue, *, positive: bool) -> float:
    """Return the value of one open request of an order, or of a part of a split order.

    A request is one unit that the order needs; it is open until it is bound to a pod.

    Parameters
    ----------
    order
        The order or part to which the request belongs. Other parts of a split order do not matter.
    metric
        `picks`: the value is 1. `age`: the seconds since the order or part took its slot (if it is
        only in a station's pool: since it joined the pool), divided by the number of its open
        requests.
        `lateness`: the seconds since the order was due (negative if it is not due yet), divided by
        the number of its open requests; if late, also multiplied by the weight of the order's
        class.
    positive
        Whether the value for `lateness` is 0 instead of negative before the due time.
    """
    if metric == "picks":
        return 1.0
    if metric == "age":
        since_s = order.slot_s if order.station >= 0 else order.queued_s
        return (now_s - since_s) / order.open_units
    late_s = now_s - order.due_s
    if late_s > 0:
        late_s *= order.weight
    return (max(late_s, 0.0) if positive else late_s) / order.open_units

"""Check of the run bound: an upper bound, by a linear program, on units picked per hour."""

from __future__ import annotations

from math import floor, fsum, inf
from typing import TYPE_CHECKING

from rmfs.solvers.decisions.checking.wrong import require

if TYPE_CHECKING:
    from rmfs.solvers.decisions.schema import Plain

TOLERANCE = 1e-9
"""Relative error allowed in sums of times and units."""


def value(data: Plain, values: Plain) -> float:
    """Check that the values satisfy all inequalities, and return the units picked per hour."""
    given = {name: array.tolist() for name, array in values.items()}
    window, robots = float(data["duration_s"]), data["robots"]
    slack = TOLERANCE * max(1.0, window * max(1, robots))
    for name, numbers in given.items():
        for place, one in enumerate(numbers):
            require(one >= -slack, f"{name}[{place}]: is negative")
    busy = [*_picking(data, given, slack), *_refill(data, given, slack)]
    most = robots * (window + _outside(data))
    require(fsum(busy) <= most + slack, f"robots work {fsum(busy)} s, but have only {most} s")
    total = fsum(given["units"])
    bundled = data["refill.bundle_units"] * fsum(given["bundles"])
    held = _content(data["stock.pod_units"].tolist(), fsum(given["visits"]))
    require(
        total <= held + bundled + slack,
        f"units: {total} are picked, but pods hold only {held + bundled}",
    )
    require(total <= data["orders.units"] + slack, "units: more are picked than ordered")
    if data["orders.lone_units"] < inf and data["orders.largest_order_units"] < inf:
        lone = fsum(given["lone_units"])
        require(lone <= data["orders.lone_units"] + slack, "lone_units: more than ordered")
        for s, units in enumerate(given["units"]):
            slots = int(data["picking.order_slots"][s]) * data["orders.largest_order_units"]
            limit = given["lone_units"][s] + slots * (given["visits"][s] + 1)
            require(units <= limit + slack, f"units[{s}]: at most {limit}, by the order slots")
    return total / (window / 3600.0)


def _picking(data: Plain, given: dict[str, list[float]], slack: float) -> list[float]:
    """Check each pick station; return the time of robots there."""
    busy = []
    window = float(data["duration_s"])
    for s, (units, visits) in enumerate(zip(given["units"], given["visits"], strict=True)):
        pick = float(data["picking.unit_pick_s"][s])
        cadence = max(float(data["picking.unit_transfer_s"][s]), pick)
        change = max(
            float(data["picking.unit_transfer_s"][s]),
            pick + float(data["picking.changeover_s"][s]),
        )
        used = cadence * units + (change - cadence) * visits
        require(
            used <= window + change + slack, f"units[{s}]: would occupy the station for {used} s"
        )
        fits = floor(window / cadence * (1.0 + TOLERANCE)) + 1
        works = data["picking.order_slots"][s] > 0 and data["robots"] > 0
        works = works and len(data["stock.pod_units"]) > 0
        for name in ("units", "visits", "lone_units"):
            limit = fits if works else 0
            require(given[name][s] <= limit + slack, f"{name}[{s}]: at most {limit}")
        require(visits <= units + slack, f"visits[{s}]: there must be at least one unit per visit")
        most = _visit_units(data, s)
        require(units <= most * visits + slack, f"units[{s}]: at most {most} per visit")
        ways = float(data["picking.inbound_s"][s]) + float(data["picking.outbound_s"][s])
        busy.append(cadence * units + (ways + pick - cadence) * visits)
    return busy


def _visit_units(data: Plain, station: int) -> float:
    largest = float(data["stock.largest_pod_units"])
    if data["orders.join_visits"] or data["orders.largest_order_units"] == inf:
        return largest
    asked = int(data["picking.order_slots"][station]) * data["orders.largest_order_units"]
    return min(largest, float(asked))


def _refill(data: Plain, given: dict[str, list[float]], slack: float) -> list[float]:
    """Check each replenishment station; return the time of robots there."""
    busy = []
    for q, (bundles, visits) in enumerate(
        zip(given["bundles"], given["refill_visits"], strict=True)
    ):
        each = float(data["refill.bundle_transfer_s"][q])
        fits = floor(float(data["duration_s"]) / each * (1.0 + TOLERANCE)) + 1
        require(bundles <= fits + slack, f"bundles[{q}]: at most {fits}")
        require(visits <= fits + slack, f"refill_visits[{q}]: at most {fits}")
        most = data["refill.bundles_per_visit"]
        require(bundles <= most * visits + slack, f"bundles[{q}]: at most {most} per visit")
        ways = float(data["refill.inbound_s"][q]) + float(data["refill.outbound_s"][q])
        busy.append(each * bundles + ways * visits)
    return busy


def _outside(data: Plain) -> float:
    """Return the robot time that may lie outside the window: a trip in, a service, a trip out."""
    picks = range(len(data["picking.inbound_s"]))
    fills = range(len(data["refill.inbound_s"]))
    ways_in = [float(data["picking.inbound_s"][s]) for s in picks]
    ways_in += [float(data["refill.inbound_s"][q]) for q in fills]
    ways_out = [
        float(data["picking.outbound_s"][s]) + float(data["picking.unit_pick_s"][s]) for s in picks
    ]
    ways_out += [
        float(data["refill.outbound_s"][q]) + float(data["refill.bundle_transfer_s"][q])
        for q in fills
    ]
    return max(ways_in, default=0.0) + max(ways_out, default=0.0)


def _content(pods: list[int], visits: float) -> float:
    """Return the number of units in the fullest pods, counting one pod per visit."""
    total, left = 0.0, visits
    for units in sorted(pods, reverse=True):
        taken = min(1.0, max(0.0, left))
        total += units * taken
        left -= taken
    return total

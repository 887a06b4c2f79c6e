"""Check of zones: pods of each class per zone of storage locations, in the steady state."""

from __future__ import annotations

from math import fsum
from typing import TYPE_CHECKING

from rmfs.solvers.decisions.checking.wrong import require

if TYPE_CHECKING:
    from rmfs.solvers.decisions.schema import Plain

TOLERANCE = 1e-9
"""Tolerance for counts of pods, as a share of all pods."""


def value(data: Plain, values: Plain) -> float:
    """Return the robot time per hour, in s, of travel and of delays by the traffic in the zones."""
    standing = values["standing"].tolist()
    pods, places = data["pods"].tolist(), data["places"].tolist()
    rate = data["rate_per_h"].tolist()
    slack = TOLERANCE * max(1.0, fsum(pods))
    parts = []
    for one, row in enumerate(standing):
        require(
            min(row, default=0.0) >= 0.0,
            f"standing[{one}]: the number of pods must not be negative",
        )
        require(abs(fsum(row) - pods[one]) <= slack, f"standing[{one}]: must add up to {pods[one]}")
        parts += [rate[one] * float(data["visit_s"][one, at]) * x for at, x in enumerate(row)]
    for at, most in enumerate(places):
        there = fsum(row[at] for row in standing)
        require(
            there <= most + slack,
            f"standing: zone {at} has {most} locations, but gets {there} pods",
        )
        traffic = fsum(rate[one] * row[at] for one, row in enumerate(standing))
        parts.append(float(data["congestion_s_h"][at]) * traffic * traffic)
    return fsum(parts)

"""Check of replenishment: assignment of bundles to pods, and of these pods to stations."""

from __future__ import annotations

from fractions import Fraction
from math import fsum, isfinite
from typing import TYPE_CHECKING

from rmfs.solvers.decisions.checking.wrong import require, within

if TYPE_CHECKING:
    from rmfs.solvers.decisions.schema import Plain


def value(data: Plain, values: Plain) -> float:
    """Return the costs of trips and of bundles left out, less the value of bundles stored."""
    pod, station = values["pod"].tolist(), values["station"].tolist()
    within("pod", pod, -1, len(data["pod_space"]))
    within("station", station, -1, len(data["station_space"]))
    parts: list[float] = []
    in_pod = [Fraction(0)] * len(data["pod_space"])
    at = [Fraction(0)] * len(data["station_space"])
    for bundle, one in enumerate(pod):
        if one < 0:
            parts.append(float(data["leave_s"][bundle]))
            require(isfinite(parts[-1]), f"pod[{bundle}]: the bundle must be stored")
            continue
        parts.append(-float(data["worth_s"][bundle, one]))
        require(isfinite(parts[-1]), f"pod[{bundle}]: pod {one} is not allowed")
        require(
            station[one] >= 0,
            f"station[{one}]: the pod gets a bundle, but is brought to no station",
        )
        space = Fraction(float(data["space"][bundle]))
        in_pod[one] += space
        at[station[one]] += space
    for name, used, most in (("pod", in_pod, "pod_space"), ("station", at, "station_space")):
        for number, full in enumerate(used):
            limit = float(data[most][number])
            require(
                full <= limit,
                f"{name} {number}: has {limit} space units free, but gets {float(full)}",
            )
    for one, to in enumerate(station):
        if to >= 0:
            parts.append(float(data["trip_s"][one, to]))
            require(isfinite(parts[-1]), f"station[{one}]: station {to} is not allowed")
    return fsum(parts)

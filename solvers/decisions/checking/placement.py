"""Check of placement: assignment of returning pods to free storage locations (places)."""

from __future__ import annotations

from math import fsum, inf
from typing import TYPE_CHECKING

from rmfs.solvers.decisions.checking.wrong import once, require, within

if TYPE_CHECKING:
    from rmfs.solvers.decisions.schema import Plain


def value(data: Plain, values: Plain) -> float:
    """Return the robot time for storing the pods now, and for the visits expected later."""
    place = values["place"].tolist()
    within("place", place, 0, len(data["access_s"]))
    once("place", place)
    parts = []
    for pod, at in enumerate(place):
        way = float(data["travel_s"][pod, at])
        require(way < inf, f"place[{pod}]: location {at} is not allowed")
        parts += [way, float(data["visits"][pod]) * float(data["access_s"][at])]
    return fsum(parts)

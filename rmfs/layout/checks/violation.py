"""Violations: which element of a layout violates which condition, and how severely."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from rmfs.layout.model import Layout

Severity = Literal["impossible", "not well-formed"]

IMPOSSIBLE: Severity = "impossible"
NOT_WELL_FORMED: Severity = "not well-formed"

MOST_SHOWN = 5
"""Maximum number of elements with the same fault reported individually; the rest are counted."""


@dataclass(frozen=True, slots=True)
class Violation:
    """A fault of a layout.

    Attributes
    ----------
    severity
        "impossible": some task can never be done, or robots or pods would overlap; the layout is
        always refused. "not well-formed": one of the conditions W1-W3 of deadlock freedom
        (docs/safety.md) does not hold, or a waypoint lies outside its tier; the layout is refused
        unless the user allows such layouts.
    element
        The element concerned: its kind, number and position.
    message
        What is wrong with the element.
    """

    severity: Severity
    element: str
    message: str

    def __str__(self) -> str:
        """Return the violation in one line."""
        return f"{self.severity}: {self.element}: {self.message}"


def at(layout: Layout, waypoint: int) -> str:
    """Return the position of a waypoint as text."""
    place = f"x {layout.x_m[waypoint]:g} m, y {layout.y_m[waypoint]:g} m"
    return place if len(layout.tiers) == 1 else f"{place}, tier {layout.tier[waypoint]}"


def waypoint_label(layout: Layout, waypoint: int) -> str:
    """Return a name for a waypoint: its kind (such as "queue place"), index and position."""
    if layout.is_storage[waypoint]:
        kind = "storage location"
    elif layout.is_queue[waypoint]:
        kind = "queue place"
    else:
        kind = "waypoint"
    return f"{kind} {waypoint} ({at(layout, waypoint)})"


def station_label(layout: Layout, station: int) -> str:
    """Return a name for a station: its kind, its number within the kind, and its position."""
    found = layout.stations[station]
    number = sum(other.kind.name == found.kind.name for other in layout.stations[:station])
    return f"{found.kind.name} station {number} ({at(layout, found.waypoint)})"


def grouped(severity: Severity, elements: Iterable[str], message: str) -> Iterator[Violation]:
    """Yield one violation for each of the first `MOST_SHOWN` elements, and one for the rest."""
    names = list(elements)
    for name in names[:MOST_SHOWN]:
        yield Violation(severity, name, message)
    further = len(names) - MOST_SHOWN
    if further > 0:
        yield Violation(severity, f"{further} more elements", message)

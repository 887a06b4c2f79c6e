"""Checks that a layout has robots, pick stations and replenishment stations."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rmfs.layout.checks.violation import IMPOSSIBLE, Violation

if TYPE_CHECKING:
    from collections.abc import Iterator

    from rmfs.layout.model import Layout


def population(layout: Layout) -> Iterator[Violation]:
    """Yield a violation for each kind that is missing: robots, pick or replenishment stations."""
    counts = {
        "robots": layout.robots,
        "pick stations": len(layout.pick_stations),
        "replenishment stations": len(layout.replenishment_stations),
    }
    for what, count in counts.items():
        if count == 0:
            yield Violation(IMPOSSIBLE, what, "there are none; a run needs at least one")

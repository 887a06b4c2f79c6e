"""Pacing: what a decision costs in simulated time (design: section 5)."""

from __future__ import annotations

from typing import Protocol

from rmfs.errors import InputError
from rmfs.simulation.agenda import NEVER_US


class Pacing(Protocol):
    """Says how far the simulation may advance, given the calls of controllers in flight."""

    def limit_us(self, now_us: int) -> int:
        """Latest simulated time that may be simulated now; waits until it is past `now_us`."""
        ...


class Instant:
    """Decisions take no simulated time, so nothing is ever in flight."""

    def limit_us(self, now_us: int) -> int:
        """No limit."""
        return NEVER_US


def pacing(mode: str) -> Pacing:
    """Return the pacing of a mode given on the command line.

    Raises
    ------
    InputError
        If there is no such mode.
    """
    if mode == "instant":
        return Instant()
    raise InputError(f"pacing {mode}: no such mode; valid: instant")

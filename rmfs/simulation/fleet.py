"""The interface to the robots: the few calls of traffic that other parts of a run need."""

from __future__ import annotations

from typing import Protocol


class Fleet(Protocol):
    """Drives robots (`rmfs.traffic.Traffic`)."""

    def command(self, robot: int, program: list[tuple[int, int]], /) -> None:
        """Give a robot its next steps, as pairs of a `Step` and its argument."""
        ...

    def rest_waypoint(self, robot: int) -> int:
        """Return the waypoint where a robot stands, or where its plan ends."""
        ...

"""What the parts of a run need of the robots: the few calls that traffic serves."""

from __future__ import annotations

from typing import Protocol


class Fleet(Protocol):
    """Drives robots (`rmfs.traffic.Traffic`)."""

    def command(self, robot: int, program: list[tuple[int, int]], /) -> None:
        """Give a robot its next steps, each a kind of step and what it refers to."""
        ...

    def rest_waypoint(self, robot: int) -> int:
        """Return where a robot stands, or where its plan ends."""
        ...

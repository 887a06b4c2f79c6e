"""The interface by which `Dispatch` drives robots: those methods of `Traffic` that it calls."""

from __future__ import annotations

from typing import Protocol


class Fleet(Protocol):
    """Drives robots; implemented by `rmfs.traffic.Traffic`."""

    def command(self, robot: int, program: list[tuple[int, int]], /) -> None:
        """Give a robot its next steps, each as a pair of a `Step` and the argument of that step."""
        ...

    def rest_waypoint(self, robot: int) -> int:
        """Return the waypoint where a robot's plan ends or, without a plan, where it stands."""
        ...

"""The server's knowledge of robots outside the simulation."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

from rmfs.errors import InputError

if TYPE_CHECKING:
    from collections.abc import Sequence

    from rmfs.demonstrator.server.pursuit import Pursuit
    from rmfs.layout.model import Layout


@dataclass
class RealRobot:
    """The server's knowledge of a robot outside the simulation.

    Attributes
    ----------
    index
        Index of the robot in the layout.
    heading_rad
        Its heading after its last completed order.
    pursuit
        Its latest order, in progress or completed; None before the first.
    is_present
        Whether there is a session with it.
    heard_us
        Time of its last message, in microseconds.
    given_up
        Whether other robots are planned around it.
    astray
        The waypoint at which it has lost its way.
    """

    index: int
    heading_rad: float
    pursuit: Pursuit | None = None
    is_present: bool = False
    heard_us: int = 0
    given_up: bool = False
    astray: int | None = None

    @property
    def is_busy(self) -> bool:
        """Whether it has not completed its order."""
        return self.pursuit is not None and not self.pursuit.done

    def heading_at(self, layout: Layout, waypoint: int) -> float:
        """Return its heading at a waypoint to which it was not sent.

        If it was pushed aside, this is the heading of its run; if it turned wrongly, the direction
        in which it has driven.
        """
        pursuit = self.pursuit
        if pursuit is None:
            return self.heading_rad
        last = [pursuit.move.from_waypoint, *pursuit.waypoints][pursuit.passed]
        dx = float(layout.x_m[waypoint] - layout.x_m[last])
        dy = float(layout.y_m[waypoint] - layout.y_m[last])
        is_moved, is_aside = max(abs(dx), abs(dy)) > 1e-6, min(abs(dx), abs(dy)) > 1e-6
        if is_moved and not is_aside:
            return round(math.atan2(dy, dx) / (math.pi / 2)) * math.pi / 2
        return pursuit.move.heading_rad if pursuit.turned else pursuit.heading_before_rad


def check_floor(layout: Layout, tags: Sequence[str]) -> None:
    """Check that robots that follow lines and read tags can use a layout; else raise InputError."""
    if layout.elevators:
        raise InputError(f"{layout.name}: elevators cannot be driven by real robots")
    if len(tags) != layout.waypoints or len(set(tags)) != len(tags):
        raise InputError(
            f"{layout.name}: every waypoint needs a tag of its own: {layout.waypoints} waypoints, "
            f"{len(set(tags))} tags"
        )
    for v in range(layout.waypoints):
        for w in layout.edge_target[layout.edge_start[v] : layout.edge_start[v + 1]]:
            dx, dy = layout.x_m[w] - layout.x_m[v], layout.y_m[w] - layout.y_m[v]
            if min(abs(dx), abs(dy)) > 1e-6:
                raise InputError(
                    f"{layout.name}: the edge {v} -> {w} is not along x or y; "
                    "robots turn by 90 degrees"
                )

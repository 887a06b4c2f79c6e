"""What the server knows about real (physical or emulated) robots, and a check of their layout."""

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
    """What the server knows about a real (physical or emulated) robot.

    Here, an order is a route order: the server's command to turn and drive (`Pursuit`).

    Attributes
    ----------
    index
        Index of the robot in the layout.
    heading_rad
        Last known or estimated heading, in rad; not updated while an order is in progress.
    pursuit
        Latest order, in progress or completed; None before the first order. If the robot has left
        its path, this is also None from the time of its new plan until the next order.
    is_present
        Whether there is a session with the robot.
    heard_us
        Time of the last message, in microseconds.
    given_up
        Whether the other robots are routed around this one because it is silent or in trouble.
    astray
        Waypoint where the robot is after it has left its path; None if it is on its path.
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
        """Whether the robot has an order that it has not completed."""
        return self.pursuit is not None and not self.pursuit.done

    def heading_at(self, layout: Layout, waypoint: int) -> float:
        """Return the robot's probable heading, in rad, at a waypoint that is not on its path.

        If this waypoint and the last one that the robot has confirmed differ only in x or only in
        y, the robot has probably taken a wrong turn: its heading is the direction from the
        confirmed waypoint to this one. Otherwise, the robot has probably been pushed aside and has
        kept the heading that it had on its path.
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
    """Raise InputError if real robots cannot use a layout.

    The layout must have no elevators, all edges must be parallel to x or y, and each waypoint must
    have a different tag.
    """
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

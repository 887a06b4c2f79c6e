"""Where to get energy: the place, and how rules choose it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal

import numpy as np

if TYPE_CHECKING:
    from rmfs.control.view import View
    from rmfs.world.charging import RecoveryStation
    from rmfs.world.robots import Robot

PlaceRule = Literal["least-queued", "nearest"]


def has_room(view: View, station: RecoveryStation) -> bool:
    """Whether another robot may be sent there: its queue has a place."""
    return len(station.tasks) < len(view.layout.stations[station.index].queue)


def choose(view: View, robot: Robot, rule: PlaceRule, *, full_too: bool = False) -> int:
    """Choose a station for a robot; -1 if none has room.

    Parameters
    ----------
    rule
        `least-queued`: fewest robots there and on their way, then the nearest; `nearest`: shortest
        unhindered time, then the fewest robots.
    full_too
        Whether the robot may be sent where the queue has no place left, to wait outside.
    """
    found = [s for s in view.recovery_stations if full_too or has_room(view, s)]
    if not found:
        return -1
    at = view.travel.robot_waypoint(robot.index)
    away = [float(view.travel.to(s.waypoint, loaded=False)[at]) for s in found]
    bound = [len(station.tasks) for station in found]
    keys = (away, bound) if rule == "least-queued" else (bound, away)
    best = int(np.lexsort(keys)[0])
    return found[best].index if np.isfinite(away[best]) else -1

"""Energy stations (chargers and swap stations), and the rules that choose one."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal

import numpy as np

from rmfs.layout.charging import Charger

if TYPE_CHECKING:
    from collections.abc import Sequence

    from rmfs.control.view import View
    from rmfs.world.charging import RecoveryStation
    from rmfs.world.robots import Robot

PlaceRule = Literal["least-queued", "nearest", "soonest"]


def has_room(view: View, station: RecoveryStation) -> bool:
    """Return whether the queue of a station has room for another robot besides those on the way."""
    return len(station.tasks) < len(view.layout.stations[station.index].queue)


def busy_s(view: View, station: RecoveryStation) -> float:
    """Return the total charging or swap time, in s, of all robots at a station or bound for it."""
    kind, batteries = view.layout.stations[station.index].kind, view.batteries
    if not isinstance(kind, Charger) or batteries is None:
        return len(station.tasks) * float(getattr(kind.parameters, "swap_s", 0.0))
    return sum(
        batteries.seconds(
            batteries.share(robot), min(task.until_share, batteries.given.full_share), kind.head_w
        )
        for robot, task in station.tasks.items()
    )


def choose(
    view: View,
    robot: Robot,
    rule: PlaceRule,
    *,
    full_too: bool = False,
    among: Sequence[RecoveryStation] | None = None,
) -> int:
    """Return the number of the energy station chosen for a robot, or -1.

    The result is -1 if no station may be chosen, or if the chosen station cannot be reached.

    Parameters
    ----------
    rule
        `least-queued`: the station with the fewest robots there or on their way; ties go to the
        nearest. `nearest`: the station with the shortest unhindered travel time; ties go to the one
        with the fewest robots there or on their way. `soonest`: the station with the least total
        charging or swap time of the robots there or on their way; ties go to the nearest.
    full_too
        Whether a station whose queue has no room may be chosen; the robot may then have to wait
        outside the queue. Otherwise, only stations with room may be chosen.
    among
        The stations to choose from. Default: all.
    """
    stations = view.recovery_stations if among is None else among
    found = [s for s in stations if full_too or has_room(view, s)]
    if not found:
        return -1
    at = view.travel.robot_waypoint(robot.index)
    away = [float(view.travel.to(s.waypoint, loaded=False)[at]) for s in found]
    bound = [len(station.tasks) for station in found]
    busy = [busy_s(view, station) for station in found] if rule == "soonest" else bound
    keys = (bound, away) if rule == "nearest" else (away, busy)
    best = int(np.lexsort(keys)[0])
    return found[best].index if np.isfinite(away[best]) else -1

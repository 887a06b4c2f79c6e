"""Check of the family `sequence`: routes on which robots store and fetch pods."""

from __future__ import annotations

from math import fsum, inf
from typing import TYPE_CHECKING

from rmfs.solvers.decisions.checking.wrong import once, require, within

if TYPE_CHECKING:
    from rmfs.solvers.decisions.schema import Plain

SLACK_S = 1e-6
"""Tolerance for rounding errors in sums of milliseconds."""


def value(data: Plain, values: Plain) -> float:
    """Return the sum of driving, weighted lateness and costs of tasks left out."""
    place, first = values["place"].tolist(), values["robot_place"].tolist()
    places, count = len(data["fetch_s"]), len(place)
    within("place", place, -1, places)
    within("robot_place", first, -1, places)
    once("place", (at for at in (*place, *first) if at >= 0))
    parts: list[float] = []
    done: list[int] = []
    for robot, tasks in enumerate(values["tasks"]):
        within(f"tasks[{robot}]", tasks, 0, count)
        done += tasks
        carries = bool(data["carrying"][robot])
        require(
            (first[robot] >= 0) == carries,
            f"robot_place[{robot}]: must be -1 if and only if the robot carries no pod",
        )
        parts += _route(data, robot, tasks, place, first[robot])
    once("tasks", done)
    left = set(range(count)) - set(done)
    for task, at in enumerate(place):
        require(
            (at < 0) == (task in left),
            f"place[{task}]: must be -1 if and only if the task is left undone",
        )
    for task in left:
        parts.append(float(data["skip_s"][task]))
        require(parts[-1] < inf, f"task {task} must be done")
    return fsum(parts)


def _route(data: Plain, robot: int, tasks: list[int], place: list[int], at: int) -> list[float]:
    """Return the parts of the cost of one route."""
    parts: list[float] = []
    time = float(data["ready_s"][robot])
    if at >= 0:
        parts.append(_way(data["stow_s"], robot, at, "stow_s"))
        time += parts[-1]
    for task in tasks:
        require(
            place[task] >= 0, f"place[{task}]: is missing, although robot {robot} does the task"
        )
        way = (
            _way(data["reach_s"], robot, task, "reach_s")
            if at < 0
            else _way(data["fetch_s"], at, task, "fetch_s")
        )
        inward = way + float(data["bring_s"][task])
        arrive = max(time + inward, float(data["earliest_s"][task]))
        latest = float(data["latest_s"][task])
        require(
            arrive <= latest + SLACK_S,
            f"task {task}: the pod arrives at {arrive} s, later than {latest} s",
        )
        due = float(data["due_s"][task])
        at = place[task]
        outward = _way(data["store_s"], task, at, "store_s")
        parts += [inward, outward]
        if arrive > due:
            parts.append(data["late_weight"] * (arrive - due))
        time = arrive + float(data["service_s"][task]) + outward
    return parts


def _way(table: object, one: int, other: int, name: str) -> float:
    way = float(table[one, other])  # type: ignore[index]
    require(way < inf, f"{name}[{one}, {other}]: is not allowed")
    return way

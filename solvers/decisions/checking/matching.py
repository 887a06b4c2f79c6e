"""Check of matching: assignment of robots to tasks."""

from __future__ import annotations

from math import fsum
from typing import TYPE_CHECKING

from rmfs.solvers.decisions.checking.wrong import once, require, within

if TYPE_CHECKING:
    from rmfs.solvers.decisions.schema import Plain


def value(data: Plain, values: Plain) -> float:
    """Return the total travel time plus the costs of tasks left out."""
    robot = values["robot"].tolist()
    travel = data["travel_s"]
    within("robot", robot, -1, len(travel))
    once("robot", (one for one in robot if one >= 0))
    parts = []
    for task, one in enumerate(robot):
        cost = float(data["leave_s"][task] if one < 0 else travel[one, task])
        require(cost < float("inf"), f"robot[{task}]: the value {one} is not allowed")
        parts.append(cost)
    return fsum(parts)

"""Check of the family `balance`: assignment of robots to tasks, with queues and due times."""

from __future__ import annotations

from math import fsum, inf
from typing import TYPE_CHECKING

from rmfs.solvers.decisions.checking.wrong import once, require, within

if TYPE_CHECKING:
    from rmfs.solvers.decisions.schema import Plain


def value(data: Plain, values: Plain) -> float:
    """Return the sum of travel, weighted lateness, waits in queues, and costs of tasks left out."""
    robot = values["robot"].tolist()
    within("robot", robot, -1, len(data["arrive_s"]))
    once("robot", (one for one in robot if one >= 0))
    parts: list[float] = []
    sent = [0] * len(data["room"])
    for task, one in enumerate(robot):
        if one < 0:
            parts.append(float(data["leave_s"][task]))
            require(parts[-1] < inf, f"robot[{task}]: the task must be done")
            continue
        arrive, due = float(data["arrive_s"][one, task]), float(data["due_s"][task])
        require(arrive < inf, f"robot[{task}]: robot {one} may not do the task")
        parts.append(arrive)
        if due < arrive:
            parts.append(data["late_weight"] * (arrive - due))
        station = int(data["station"][task])
        parts.append(
            (int(data["queue"][station]) + sent[station]) * float(data["service_s"][station])
        )
        sent[station] += 1
    for station, (count, room) in enumerate(zip(sent, data["room"].tolist(), strict=True)):
        require(count <= room, f"robot: station {station} has room for {room}, not {count}")
    return fsum(parts)

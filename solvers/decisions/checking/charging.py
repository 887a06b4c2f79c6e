"""Check of charging: stays of robots at chargers and swap stations."""

from __future__ import annotations

from math import exp, fsum, inf
from typing import TYPE_CHECKING, Any

from rmfs.solvers.decisions.checking.wrong import require, within

if TYPE_CHECKING:
    from rmfs.solvers.decisions.schema import Plain

NONE = -1


def value(data: Plain, values: Plain) -> float:
    """Follow each robot through the time slots, and return the cost of the plan.

    The cost includes missing energy, drives, time away from work, and too few robots at work.
    """
    group, begin, length = (values[name].tolist() for name in ("group", "begin", "length"))
    cases, slots = data["wanted"].shape
    within("group", group, NONE, len(data["gain"]))
    slot_s, idle = float(data["slot_s"]), _or(data, "idle", 0.0)
    gone, used = [0] * slots, [[0] * slots for _ in data["gain"]]
    parts = []
    for robot, (at, first, count) in enumerate(zip(group, begin, length, strict=True)):
        if at == NONE:
            require(
                first == 0 and count == 0,
                f"begin[{robot}], length[{robot}]: must be 0 without a stay",
            )
        else:
            _allowed(data, robot, at, first, count)
        low, end = _levels(data, robot, at, first, count)
        worth = end + _or(data, "curve", 0.2) * (end - end * end)
        parts.append(float(data["worth_s"]) * (1 - worth))
        parts.append(_or(data, "short_s", 36000.0) * max(_or(data, "least", 0.15) - low, 0.0))
        parts.append(float(data["way_s"][robot, at]) if at != NONE else 0.0)
        for slot in range(slots):
            stays = at != NONE and first <= slot < first + count
            waits = data["waits"][robot] and (at == NONE or slot < first)
            gone[slot] += bool(stays or waits)
            if stays:
                used[at][slot] += 1
    parts.append(idle * slot_s * sum(gone))
    for at, row in enumerate(used):
        for slot, count in enumerate(row):
            require(
                count <= data["places"][at, slot],
                f"group: group {at} has too few places in slot {slot}",
            )
    for slot in range(slots):
        there = len(group) - gone[slot]
        missed = sum(max(int(data["wanted"][case, slot]) - there, 0) for case in range(cases))
        parts.append((1 - idle) * slot_s * missed / cases)
    return fsum(parts)


def _or(data: Plain, name: str, otherwise: float) -> float:
    given: Any = data.get(name)
    return otherwise if given is None else float(given)


def _allowed(data: Plain, robot: int, at: int, first: int, count: int) -> None:
    """Refuse a stay that a robot may not have."""
    slots = data["wanted"].shape[1]
    most = 1 if data["swapped"][at] > 0 else int(_or(data, "longest", 8))
    require(1 <= count <= most, f"length[{robot}]: must be from 1 to {most}, is {count}")
    require(
        first >= 0 and first + count <= slots, f"begin[{robot}]: the stay lies outside the slots"
    )
    require(data["way_s"][robot, at] < inf, f"group[{robot}]: group {at} is not allowed")
    if data["here"][robot] != NONE:
        require(at == data["here"][robot], f"group[{robot}]: the robot is at another group")
        require(first == 0, f"begin[{robot}]: must be 0, as the robot is at the group")
    elif not data["waits"][robot]:
        require(first >= data["ready"][robot], f"begin[{robot}]: the robot is not ready")


def _levels(data: Plain, robot: int, at: int, first: int, count: int) -> tuple[float, float]:
    """Return the lowest level of a battery that counts, and its final level."""
    slots = data["wanted"].shape[1]
    level, drain = float(data["level"][robot]), float(data["drain"][robot])
    waits, here = bool(data["waits"][robot]), data["here"][robot] != NONE
    if at == NONE:
        end = level if waits else level - drain * slots
        return end, end
    before = level if waits or here else level - drain * first
    if data["swapped"][at] > 0:
        after = max(float(data["swapped"][at]), before)
    else:
        way = 0.0 if here else float(data["way_s"][robot, at]) / float(data["slot_s"])
        after = _charged(data, before, float(data["gain"][at]), max(count - way, 0.0))
    end = after - drain * (slots - first - count)
    return min(before, end), end


def _charged(data: Plain, level: float, gain: float, time: float) -> float:
    """Charge at constant power up to the bend, then tapering, and not beyond full."""
    full, bend = _or(data, "full", 0.98), _or(data, "taper_from", 0.8)
    if level >= full or gain <= 0:
        return level
    steady = min(time, max(bend - level, 0.0) / gain) if bend < 1 else time
    reached, rest = level + gain * steady, time - steady
    if rest > 0:
        reached = 1 - (1 - reached) * exp(-rest * gain / (1 - bend))
    return max(level, min(reached, full))

r"""The problem: robots, places where batteries are charged or swapped, and demand for robots.

Time is divided into T time slots. Each robot makes at most one stay at a place; during its stay it
is away from work. A stay is given by the group g of its place (a group consists of identical
places), its first time slot b and its number n of time slots.

.. math::

    \min \sum_r \bigl(lost(end_r) + short \cdot (least - low_r)^+ + way_{r g_r}
    + idle \cdot slot \cdot slots_r\bigr)
    + (1 - idle) \frac{slot}{Q} \sum_{q,t} \bigl(wanted_{qt} - (R - away_t)\bigr)^+

:math:`end_r` and :math:`low_r` are the final and the lowest battery level of robot r,
:math:`way_{r g_r}` is the time of its drive back from its place (0 without a stay), :math:`slots_r`
is its number of time slots away from work, :math:`away_t` is the number of robots away in time slot
t, and R is the number of robots. The demand for robots is given as Q equally likely cases. The
other symbols, except lost, are fields of `Charging` (without the ending `_s`).

:math:`lost(l) = worth\,(1 - l - \kappa (l - l^2))` is the worth, in robot time, of the energy that
a battery with final level l lacks. If :math:`\kappa > 0`, energy is worth more in an empty battery
than in a full one. A battery is charged with constant power up to the level `taper_from`. Above
this level, the power falls linearly with the level, to 0 in a full battery. A swap takes one time
slot.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rmfs.solvers.models.checks import costs, flags, integers, number, reals, require

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]

AWAY = -1
"""Group of a robot that has no stay: it is away from all places."""


@dataclass(frozen=True)
class Charging:
    r"""Input of the charging model: robots, groups of places, and demand for robots.

    Parameters
    ----------
    level
        Current level of each battery, as a share of its capacity, shape (R,).
    drain
        Consumption of each robot per time slot of work, as a share of the capacity, shape (R,).
    ready
        First time slot in which each robot may leave its work, shape (R,).
    waits
        Whether a robot is already on its way to a place, waits there or swaps its battery, shape
        (R,). Such a robot is away from work, and its battery does not drain, from time slot 0 to
        the end of its stay. If the plan contains no stay for the robot, this holds in all time
        slots.
    here
        Group of the place where a robot is being charged, or `AWAY` if it is not being charged,
        shape (R,). A robot that is being charged either leaves now, or has a stay that begins at
        the same group in time slot 0.
    way_s
        Driving time of each robot to a place of each group, shape (R, G), in s; +inf if the robot
        may not use the group. A stay begins with this drive, unless the robot is already there.
        The cost of a stay includes the drive back, which takes the same time.
    places
        Number of robots that each group can hold in each time slot, shape (G, T).
    gain
        Share of a battery's capacity that each group charges per time slot at constant power, shape
        (G,).
    swapped
        Battery level after a swap at each group, shape (G,); a swap takes one time slot. 0: the
        group charges instead.
    wanted
        Number of robots needed for work in each of Q equally likely cases and in each time slot,
        shape (Q, T).
    slot_s
        Length of a time slot, positive, in s.
    worth_s
        Worth of a full battery at the end of the last time slot, in s of robot time.
    longest
        Maximum number of time slots of a stay. Default 8.
    taper_from
        Level above which charging slows down; 1: never. Default 0.8.
    full
        Level that counts as full. Default 0.98.
    least
        Level below which no battery should fall. Default 0.15.
    short_s
        Penalty, in s, per unit by which the lowest level of a robot's battery falls below `least`.
        Default 36000.
    idle
        Cost of a time slot away from work if the robot is not needed, as a share of the cost if it
        is needed, from 0 to 1. Default 0.
    curve
        :math:`\kappa` in the objective (see the module), from 0 to 1; with 0, energy is worth the
        same at every battery level. Default 0.2.

    Raises
    ------
    ModelError
        If a shape or a value is wrong.
    """

    level: Floats
    drain: Floats
    ready: Integers
    waits: NDArray[np.bool_]
    here: Integers
    way_s: Floats
    places: Integers
    gain: Floats
    swapped: Floats
    wanted: Integers
    slot_s: float
    worth_s: float
    longest: int = 8
    taper_from: float = 0.8
    full: float = 0.98
    least: float = 0.15
    short_s: float = 36000.0
    idle: float = 0.0
    curve: float = 0.2

    def __post_init__(self) -> None:
        level = reals("level", self.level, (None,), low=0)
        way_s = costs("way_s", self.way_s, (len(level), None), low=0)
        robots, groups = way_s.shape
        wanted = integers("wanted", self.wanted, (None, None), low=0)
        cases, slots = wanted.shape
        require(cases > 0, "wanted", "must have at least one case")
        require(slots > 0, "wanted", "must have at least one slot")
        slot_s = number("slot_s", self.slot_s, low=0)
        require(slot_s > 0, "slot_s", "must be positive")
        checked = {
            "level": level,
            "drain": reals("drain", self.drain, (robots,), low=0),
            "ready": integers("ready", self.ready, (robots,), low=0),
            "waits": flags("waits", self.waits, (robots,)),
            "here": integers("here", self.here, (robots,), low=AWAY, high=groups - 1),
            "way_s": way_s,
            "places": integers("places", self.places, (groups, slots), low=0),
            "gain": reals("gain", self.gain, (groups,), low=0),
            "swapped": reals("swapped", self.swapped, (groups,), low=0, high=1),
            "wanted": wanted,
            "slot_s": slot_s,
            "worth_s": number("worth_s", self.worth_s, low=0),
            "longest": int(integers("longest", self.longest, (), low=1)),
            "taper_from": number("taper_from", self.taper_from, low=0, high=1),
            "full": number("full", self.full, low=0, high=1),
            "least": number("least", self.least, low=0, high=1),
            "short_s": number("short_s", self.short_s, low=0),
            "idle": number("idle", self.idle, low=0, high=1),
            "curve": number("curve", self.curve, low=0, high=1),
        }
        for field, value in checked.items():
            object.__setattr__(self, field, value)
        plugged = self.here != AWAY
        require(
            not (plugged & self.waits).any(),
            "waits",
            "must be false for a robot that is at a group (`here`)",
        )
        swaps = np.append(self.swapped > 0, False)[self.here]
        require(
            not swaps.any(),
            "here",
            "must not be a group that swaps batteries: set `waits` for a robot that is swapping",
        )

    @property
    def robots(self) -> int:
        """Number of robots R."""
        return len(self.level)

    @property
    def slots(self) -> int:
        """Number of time slots T."""
        return int(self.wanted.shape[1])

    def charged(self, level: Floats, gain: Floats, slots: Floats) -> Floats:
        """Return the battery levels after charging, which stops at `full`.

        Parameters
        ----------
        level, gain, slots
            Levels before charging, share of the capacity charged per time slot at constant power,
            and number of time slots; arrays that broadcast to a common shape.
        """
        bend = self.taper_from
        steady = level + gain * slots
        if bend < 1:
            before = np.divide(
                bend - level, gain, out=np.full(steady.shape, np.inf), where=gain > 0
            )
            begun = np.maximum(level, bend)
            tapering = np.maximum(slots - np.maximum(before, 0.0), 0.0)
            slowed = 1 - np.maximum(1 - begun, 0) * np.exp(-tapering * gain / (1 - bend))
            steady = np.where(steady > bend, slowed, steady)
        reached: Floats = np.maximum(level, np.minimum(steady, self.full))
        return reached

    def lost_s(self, level: Floats) -> Floats:
        """Return the worth, in s of robot time, of the energy that is missing at these levels."""
        lost: Floats = self.worth_s * (1 - level - self.curve * (level - level**2))
        return lost

    def missing_s(self, away: Integers) -> Floats:
        """Return the cost of missing robots in each time slot, shape (T,), in s.

        The cost is `missed_s` times the number of missing robots, averaged over the cases. In
        addition, every time slot of a robot away from work costs `idle * slot_s`, whether the robot
        is needed or not.

        Parameters
        ----------
        away
            Number of robots away from work in each time slot, shape (T,).
        """
        missed = np.maximum(self.wanted - (self.robots - away), 0).mean(axis=0)
        time_s: Floats = self.missed_s * missed
        return time_s

    @property
    def missed_s(self) -> float:
        """Additional cost of a time slot away from work if the robot is needed, in s.

        The total cost is then `slot_s`; the share `idle` of it is incurred even if the robot is not
        needed.
        """
        return self.slot_s * (1 - self.idle)


@dataclass(frozen=True)
class ChargePlan:
    """The stay of each robot.

    Parameters
    ----------
    group
        Group of the place of each robot's stay; `AWAY` for robots without a stay, shape (R,).
    begin, length
        First time slot and number of time slots of the stay, shape (R,); 0 without a stay.
    """

    group: Integers
    begin: Integers
    length: Integers


def costs_s(data: Charging, robot: Integers, plan: ChargePlan) -> Floats:
    """Return the costs of stays, excluding the cost of missing robots, shape (N,), in s.

    Parameters
    ----------
    data
        The problem.
    robot
        Robot of each stay, shape (N,).
    plan
        The stays; its arrays have one entry per stay, shape (N,).
    """
    stays, group = plan.group != AWAY, np.maximum(plan.group, 0)
    waits, here = data.waits[robot], data.here[robot] != AWAY
    level, drain = data.level[robot], data.drain[robot]
    if data.way_s.shape[1]:
        way_s, gain = data.way_s[robot, group], data.gain[group]
        swapped = data.swapped[group]
    else:
        way_s = gain = swapped = np.zeros(len(robot))
    before = np.where(waits | here, level, level - drain * plan.begin)
    way = np.where(np.isfinite(way_s) & ~here, way_s / data.slot_s, 0.0)
    after = data.charged(before, gain, np.maximum(plan.length - way, 0.0))
    after = np.where(swapped > 0, np.maximum(swapped, before), after)
    left = data.slots - plan.begin - plan.length
    idle = np.where(waits, level, level - drain * data.slots)
    end = np.where(stays, after - drain * left, idle)
    low = np.where(stays, np.minimum(before, end), end)
    back_s = np.where(stays, way_s, 0.0)
    back_s = back_s + data.idle * data.slot_s * away(data, robot, plan).sum(axis=1)
    cost_s: Floats = data.lost_s(end) + data.short_s * np.maximum(data.least - low, 0.0) + back_s
    return cost_s


def away(data: Charging, robot: Integers, plan: ChargePlan) -> NDArray[np.bool_]:
    """Return for each stay and time slot whether the robot is away from work, shape (N, T).

    Parameters
    ----------
    data, robot, plan
        As for `costs_s`.
    """
    stays = plan.group != AWAY
    waits = data.waits[robot]
    first = np.where(waits, 0, plan.begin)
    end = np.where(stays, plan.begin + plan.length, np.where(waits, data.slots, 0))
    return during(first, end, data.slots)


def during(first: Integers, end: Integers, slots: int) -> NDArray[np.bool_]:
    """Return whether each of N intervals [first, end) contains each time slot, shape (N, T)."""
    slot = np.arange(slots)
    within: NDArray[np.bool_] = (slot >= first[:, np.newaxis]) & (slot < end[:, np.newaxis])
    return within


def objective(data: Charging, plan: ChargePlan) -> float:
    """Return the cost of a plan (the objective of this module), in s of robot time.

    Parameters
    ----------
    data
        The problem.
    plan
        The stay of every robot.
    """
    robot = np.arange(data.robots)
    missed_s = data.missing_s(away(data, robot, plan).sum(axis=0))
    return math.fsum(costs_s(data, robot, plan).tolist()) + math.fsum(missed_s.tolist())


def violations(data: Charging, plan: ChargePlan) -> list[str]:
    """Return descriptions of the constraints that a plan violates; empty if it is feasible.

    Parameters
    ----------
    data
        The problem.
    plan
        The stay of every robot.
    """
    groups, robots = len(data.gain), data.robots
    if any(part.shape != (robots,) for part in (plan.group, plan.begin, plan.length)):
        return ["group, begin and length must have one value for each robot"]
    stays = plan.group != AWAY
    if ((plan.group < AWAY) | (plan.group >= groups)).any():
        return ["a robot is sent to a group that does not exist"]
    if ((plan.begin != 0) | (plan.length != 0))[~stays].any():
        return ["begin and length must be 0 for a robot without a stay"]
    group, begin, length = plan.group[stays], plan.begin[stays], plan.length[stays]
    found = []
    if ((begin < 0) | (begin + length > data.slots)).any():
        found.append("a stay lies outside the slots")
    limit = np.where(data.swapped[group] > 0, 1, data.longest)
    if ((length < 1) | (length > limit)).any():
        found.append("a stay is too short or too long")
    here = data.here[stays]
    free = ~data.waits[stays] & (here == AWAY)
    if (begin < data.ready[stays])[free].any():
        found.append("a stay begins before its robot is ready")
    if ((here != AWAY) & ((here != group) | (begin != 0))).any():
        found.append("a robot that is at a group must stay there, from slot 0")
    if np.isinf(data.way_s[np.flatnonzero(stays), group]).any():
        found.append("a robot is sent to a group that it may not use")
    used = np.zeros((groups, data.slots), np.int64)
    np.add.at(used, group, during(begin, begin + length, data.slots))
    if (used > data.places).any():
        found.append("a group has more robots than places in a slot")
    return found

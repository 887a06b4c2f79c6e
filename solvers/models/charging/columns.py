"""All possible stays of each robot at charging or swapping places, one row per stay."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rmfs.solvers.models.charging.data import (
    AWAY,
    ChargePlan,
    Charging,
    Floats,
    Integers,
    away,
    costs_s,
    during,
)


@dataclass(frozen=True)
class Columns:
    """All possible stays of all robots, including "no stay" for each robot.

    Parameters
    ----------
    robot, group, begin, length
        Robot, group of places, first time slot and number of time slots of each stay, sorted by
        robot, shape (N,). The first row of each robot means "no stay".
    cost_s
        Cost of each stay, in s, excluding the cost of missing robots, shape (N,).
    away, used
        Whether the robot of each stay is away from work (`away`), and whether it occupies a place
        (`used`), in each time slot, shape (N, T).
    first
        First row of each robot, followed by N, shape (R + 1,).
    """

    robot: Integers
    group: Integers
    begin: Integers
    length: Integers
    cost_s: Floats
    away: NDArray[np.bool_]
    used: NDArray[np.bool_]
    first: Integers

    def plan(self, rows: Integers) -> ChargePlan:
        """Return the plan in which robot r makes the stay of row `rows[r]`."""
        return ChargePlan(self.group[rows], self.begin[rows], self.length[rows])

    def rows(self, plan: ChargePlan) -> Integers:
        """Return the row of each robot's stay in a feasible plan, shape (R,)."""
        found = [
            np.flatnonzero(
                (self.group[low:high] == plan.group[robot])
                & (self.begin[low:high] == plan.begin[robot])
                & (self.length[low:high] == plan.length[robot])
            )[0]
            + low
            for robot, (low, high) in enumerate(
                zip(self.first[:-1].tolist(), self.first[1:].tolist(), strict=True)
            )
        ]
        return np.array(found, np.int64)


def columns(data: Charging) -> Columns:
    """Return all possible stays of all robots.

    Parameters
    ----------
    data
        The problem.
    """
    robots, groups = data.way_s.shape
    shape = (robots, groups, data.slots, min(data.longest, data.slots))
    robot, group, begin, length = (
        part.ravel() for part in np.meshgrid(*map(np.arange, shape), indexing="ij")
    )
    length = length + 1
    here, waits = data.here[robot], data.waits[robot]
    may = (begin + length <= data.slots) & np.isfinite(data.way_s[robot, group])
    may &= (data.swapped[group] == 0) | (length == 1)
    may &= (begin >= data.ready[robot]) | waits | (here != AWAY)
    may &= (here == AWAY) | ((here == group) & (begin == 0))
    nothing = np.arange(robots)
    robot = np.concatenate([nothing, robot[may]])
    group = np.concatenate([np.full(robots, AWAY), group[may]])
    begin = np.concatenate([np.zeros(robots, np.int64), begin[may]])
    length = np.concatenate([np.zeros(robots, np.int64), length[may]])
    order = np.argsort(robot, kind="stable")
    robot, plan = robot[order], ChargePlan(group[order], begin[order], length[order])
    return Columns(
        robot=robot,
        group=plan.group,
        begin=plan.begin,
        length=plan.length,
        cost_s=costs_s(data, robot, plan),
        away=away(data, robot, plan),
        used=during(plan.begin, plan.begin + plan.length, data.slots),
        first=np.searchsorted(robot, np.arange(robots + 1)).astype(np.int64),
    )

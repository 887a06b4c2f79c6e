"""CA breaks: robots charge during breaks, at fixed times of a cycle that repeats."""

from __future__ import annotations

from itertools import pairwise
from math import inf
from typing import TYPE_CHECKING, Annotated

import pydantic

from rmfs.control.ca.levels import ByLevel, Level, LevelParameters, Share

if TYPE_CHECKING:
    from rmfs.world.robots import Robot

Break = tuple[
    Annotated[float, pydantic.Field(ge=0, allow_inf_nan=False)],
    Annotated[float, pydantic.Field(gt=0, allow_inf_nan=False)],
]


class BreaksParameters(LevelParameters):
    """Parameters of CA breaks."""

    below_share: Share = 0.25
    """Outside breaks, a robot charges if its battery level is below this share of the capacity."""
    until_share: Level = 0.9
    """Battery level (share of the capacity) up to which robots charge."""
    breaks_s: tuple[Break, ...] = ((14400.0, 16200.0), (28800.0, 30600.0))
    """Breaks in order of time: pairs of start and end, in seconds since the start of a cycle."""
    cycle_s: Annotated[float, pydantic.Field(gt=0, allow_inf_nan=False)] = 43200.0
    """Length of a cycle in seconds, after which the breaks repeat. The first cycle begins at
    midnight (time of day 0)."""

    @pydantic.model_validator(mode="after")
    def _breaks_in_order(self) -> BreaksParameters:
        times = [time for pair in self.breaks_s for time in pair]
        if any(a >= b for a, b in pairwise(times)) or (times and times[-1] > self.cycle_s):
            raise ValueError("breaks_s must be in order, must not overlap and must end by cycle_s")
        return self


class Breaks(ByLevel[BreaksParameters]):
    """Sends robots to charge during breaks; at other times, only robots whose level is low.

    This is known as interim charging. Robots finish their tasks first. If robots outnumber
    the charging places, some of them wait in queues.
    """

    parameters_model = BreaksParameters

    def next_event_s(self) -> float:
        """Return the simulated time in s at which the next break starts; inf if there is none."""
        given, view = self.parameters, self.view
        if view.batteries is None or not given.breaks_s:
            return inf
        now_s = view.now_s + view.time_of_day_s
        begin_s = now_s // given.cycle_s * given.cycle_s
        starts = [
            begin_s + cycle * given.cycle_s + start
            for cycle in (0, 1)
            for start, _ in given.breaks_s
        ]
        return min(start for start in starts if start > now_s) - view.time_of_day_s

    def wanted_share(self, robot: Robot, share: float) -> float:
        """Return `until_share` during a break or if the robot's level is low, else 0."""
        given = self.parameters
        time_s = (self.view.now_s + self.view.time_of_day_s) % given.cycle_s
        is_break = any(start <= time_s < end for start, end in given.breaks_s)
        return given.until_share if is_break or share < given.below_share else 0.0

    def target_share(self) -> float:
        """Return the level up to which robots charge, `until_share`."""
        return self.parameters.until_share

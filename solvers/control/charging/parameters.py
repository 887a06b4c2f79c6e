"""Parameters of CA schedule."""

from __future__ import annotations

from typing import Annotated, Literal

import pydantic

from rmfs.control.ca.levels import LevelParameters, Share
from rmfs.solvers.models.solution import Limits

Count = Annotated[int, pydantic.Field(ge=1)]
Positive = Annotated[float, pydantic.Field(gt=0, allow_inf_nan=False)]
NotNegative = Annotated[float, pydantic.Field(ge=0, allow_inf_nan=False)]


class ScheduleParameters(LevelParameters):
    """Parameters of CA schedule."""

    method: Literal["highs", "cp_sat", "greedy"] = "highs"
    """Who decides: HiGHS or CP-SAT, beginning with the greedy rule, or that rule alone."""
    period_s: Positive = 60.0
    """Seconds after which the schedule is made anew."""
    slot_share: Annotated[float, pydantic.Field(gt=0, le=1)] = 0.1
    """A slot is as long as a place takes to charge this share of a battery."""
    slots: Count = 10
    """Slots to look ahead."""
    longest: Count = 7
    """Slots of a stay, at most."""
    worth: NotNegative = 1.15
    """Robot time that energy is worth, relative to what a place takes to give it."""
    idle: Share = 0.6
    """What the time of a robot costs that work has no use for, relative to one that is missed."""
    curve: Share = 0.2
    """How much more the first energy of a battery is worth than the last."""
    margin_share: Share = 0.0
    """How far above the level at which robots go for energy in any case nobody should be lower."""
    window_s: Positive = 1200.0
    """Seconds of the past from which it is told how many robots work has use for."""
    cases: Count = 4
    """Cases of that to look at."""
    nodes: Count = 20
    """Limit of HiGHS in nodes."""
    work_s: Positive = 0.25
    """Limit of CP-SAT in deterministic seconds: about the same in wall time."""
    gap: NotNegative = 0.005
    """Relative gap between value and bound at which the search ends."""

    @property
    def limits(self) -> Limits:
        """The same as limits of the model."""
        return Limits(deterministic_s=self.work_s, nodes=self.nodes, gap=self.gap)

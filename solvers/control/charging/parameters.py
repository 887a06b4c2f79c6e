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
    """Solution method: HiGHS or CP-SAT, starting from the greedy rule, or the greedy rule alone."""
    period_s: Positive = 60.0
    """Seconds between schedules."""
    slot_share: Annotated[float, pydantic.Field(gt=0, le=1)] = 0.1
    """Length of a time slot, given as the share of a battery that the most powerful charging place
    charges in it."""
    slots: Count = 10
    """Number of time slots to plan ahead."""
    longest: Count = 7
    """Maximum length of a stay at a charging place, in time slots."""
    worth: NotNegative = 1.15
    """Value of energy: the robot time that it is worth, as a multiple of the time in which the most
    powerful charging place supplies it."""
    idle: Share = 0.6
    """Cost of time away from work of a robot that is not needed, as a share of the cost of time for
    which a robot is missing."""
    curve: Share = 0.2
    """Curvature of the value of energy: it is (1 + `curve`) times its average in an empty battery,
    and (1 - `curve`) times its average in a full one."""
    margin_share: Share = 0.0
    """Safety margin, as a share of the capacity, above the level that is enough for any task. The
    model penalises levels below the sum of the two."""
    window_s: Positive = 1200.0
    """Length in seconds of the past period from which the number of needed robots is forecast."""
    cases: Count = 4
    """Number of equally likely cases of the number of needed robots in the forecast."""
    nodes: Count = 20
    """Maximum number of branch-and-bound nodes for HiGHS."""
    work_s: Positive = 0.25
    """Limit of CP-SAT in deterministic seconds, which are close to wall time."""
    gap: NotNegative = 0.005
    """Relative gap between value and bound at which the search ends."""

    @property
    def limits(self) -> Limits:
        """Return `work_s`, `nodes` and `gap` as limits of the model."""
        return Limits(deterministic_s=self.work_s, nodes=self.nodes, gap=self.gap)

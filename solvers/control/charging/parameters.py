"""Parameters of CA schedule."""

from __future__ import annotations

from typing import Annotated, Literal

import pydantic

from rmfs.control.ca.levels import Level, LevelParameters, Share
from rmfs.solvers.models.solution import Limits

Count = Annotated[int, pydantic.Field(ge=1)]
Positive = Annotated[float, pydantic.Field(gt=0, allow_inf_nan=False)]
NotNegative = Annotated[float, pydantic.Field(ge=0, allow_inf_nan=False)]


class ScheduleParameters(LevelParameters):
    """Parameters of CA schedule."""

    hand_over_share: Level | None = None
    """Until the first answer, and after a failure: a charging robot gives up its place if its level
    suffices for any task and exceeds the level of a robot in the queue by more than this share of
    the capacity. Default: never. At all other times, the schedule determines who leaves."""
    below_share: Share = 0.3
    """Until the first answer, and after a failure: a robot charges when its battery level falls
    below this share of the capacity."""
    until_share: Level = 0.8
    """Until the first answer, and after a failure: battery level (share of the capacity) up to
    which a robot charges."""
    method: Literal["highs", "cp_sat", "greedy"] = "highs"
    """Solution method: `greedy` (a rule), or `highs` or `cp_sat`, which start from the solution of
    `greedy`."""
    period_s: Positive = 60.0
    """Time, in seconds, between two schedules."""
    slot_share: Annotated[float, pydantic.Field(gt=0, le=1)] = 0.1
    """Length of a time slot, expressed as the share of a battery's capacity that the most powerful
    charger supplies in this time."""
    slots: Count = 10
    """Number of time slots planned ahead."""
    longest: Count = 7
    """Maximum length of a stay at a charging place, in time slots."""
    worth: NotNegative = 1.15
    """Value of energy in robot time, as a multiple of the time in which the most powerful charger
    supplies the energy."""
    idle: Share = 0.6
    """Cost of a second that a robot spends away from work while it is not needed. A second away
    from work while the robot is needed costs 1."""
    curve: Share = 0.2
    """Curvature of the value of energy: the first unit of energy in an empty battery is worth (1 +
    `curve`) times the average, and the last one in a full battery (1 - `curve`) times."""
    margin_share: Share = 0.0
    """Safety margin, as a share of the capacity: battery levels are penalised if they are less than
    this margin above the level that suffices for any task."""
    window_s: Positive = 1200.0
    """Length in seconds of the past period from which the number of needed robots is forecast."""
    cases: Count = 4
    """Number of equally likely cases in the forecast of the number of needed robots."""
    nodes: Count = 20
    """Maximum number of branch-and-bound nodes of HiGHS."""
    work_s: Positive = 0.25
    """Limit of the search by CP-SAT in deterministic seconds, which are close to wall time."""
    gap: NotNegative = 0.005
    """Relative gap between objective value and bound at which the search ends."""

    @property
    def limits(self) -> Limits:
        """Return `work_s`, `nodes` and `gap` as limits of the model."""
        return Limits(deterministic_s=self.work_s, nodes=self.nodes, gap=self.gap)

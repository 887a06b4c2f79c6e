"""CA by-demand: robots charge early while few orders arrive."""

from __future__ import annotations

from collections import deque
from typing import TYPE_CHECKING, Annotated, Any

import pydantic

from rmfs.control.ca.levels import ByLevel, Level, LevelParameters, Share
from rmfs.control.problems import Trigger

if TYPE_CHECKING:
    import numpy as np

    from rmfs.control.view import View
    from rmfs.world.robots import Robot


class ByDemandParameters(LevelParameters):
    """Parameters of CA by-demand."""

    below_share: Share = 0.25
    """Level below which a robot charges while many orders arrive."""
    calm_below_share: Share = 0.6
    """Level below which a robot charges while few orders arrive."""
    until_share: Level = 0.8
    """Level up to which it charges."""
    window_s: Annotated[float, pydantic.Field(gt=0, allow_inf_nan=False)] = 900.0
    """Length in seconds of the window in which arrivals are counted."""
    calm_share: Annotated[float, pydantic.Field(gt=0, allow_inf_nan=False)] = 0.8
    """Demand is low if the rate in the window is below this share of the mean rate of the run."""

    @pydantic.model_validator(mode="after")
    def _calm_in_order(self) -> ByDemandParameters:
        if not self.below_share <= self.calm_below_share < self.until_share:
            raise ValueError(
                f"calm_below_share = {self.calm_below_share:g} must be at least below_share and "
                "less than until_share"
            )
        return self


class ByDemand(ByLevel[ByDemandParameters]):
    """Sends robots to charge at a higher level while few orders arrive than while many arrive.

    Fewer robots then need to charge while many orders arrive.
    """

    parameters_model = ByDemandParameters
    hears = frozenset({Trigger.NEW_ORDER})

    def __init__(
        self, parameters: ByDemandParameters, view: View, rng: np.random.Generator
    ) -> None:
        super().__init__(parameters, view, rng)
        self._arrivals: deque[float] = deque()
        self._begun_s = view.now_s
        self._count = 0

    def hear(self, trigger: Trigger, subject: Any) -> None:
        """Count an order."""
        self._arrivals.append(self.view.now_s)
        self._count += 1

    def wanted_share(self, robot: Robot, share: float) -> float:
        """The upper level if the robot is below the lower level that applies now, else 0."""
        given = self.parameters
        low = given.calm_below_share if self.is_calm() else given.below_share
        return given.until_share if share < low else 0.0

    def target_share(self) -> float:
        """The upper level, `until_share`."""
        return self.parameters.until_share

    def is_calm(self) -> bool:
        """Whether few orders arrived in the last window; never before two windows have passed.

        `calm_share` compares their rate with the mean rate since the rule was installed.
        """
        now_s, window_s = self.view.now_s, self.parameters.window_s
        while self._arrivals and self._arrivals[0] < now_s - window_s:
            self._arrivals.popleft()
        passed_s = now_s - self._begun_s
        if passed_s < 2 * window_s or not self._count:
            return False
        mean_rate = self._count / passed_s
        return len(self._arrivals) / window_s < self.parameters.calm_share * mean_rate

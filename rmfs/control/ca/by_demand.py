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
    """Battery level (share of the capacity) below which a robot charges while many orders
    arrive."""
    calm_below_share: Share = 0.6
    """Battery level (share of the capacity) below which a robot charges while few orders arrive."""
    until_share: Level = 0.8
    """Battery level (share of the capacity) up to which a robot charges."""
    window_s: Annotated[float, pydantic.Field(gt=0, allow_inf_nan=False)] = 900.0
    """Length, in seconds, of the most recent period in which arriving orders are counted."""
    calm_share: Annotated[float, pydantic.Field(gt=0, allow_inf_nan=False)] = 0.8
    """Demand counts as low if the rate of arriving orders in the most recent period (`window_s`) is
    below this share of the mean rate since the rule was installed. Orders that are there at the
    start of the run do not count as arriving."""

    @pydantic.model_validator(mode="after")
    def _calm_in_order(self) -> ByDemandParameters:
        if not self.below_share <= self.calm_below_share < self.until_share:
            raise ValueError(
                f"calm_below_share = {self.calm_below_share:g} must be at least below_share and "
                "less than until_share"
            )
        return self


class ByDemand(ByLevel[ByDemandParameters]):
    """Lets robots charge earlier, that is, at a higher battery level, while few orders arrive.

    As a result, fewer robots need to charge while many orders arrive.
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
        """Count an order, unless it is there from the start."""
        if self.view.now_s <= self._begun_s:
            return
        self._arrivals.append(self.view.now_s)
        self._count += 1

    def wanted_share(self, robot: Robot, share: float) -> float:
        """Return `until_share` if the robot's level is below the present threshold, else 0."""
        given = self.parameters
        low = given.calm_below_share if self.is_calm() else given.below_share
        return given.until_share if share < low else 0.0

    def target_share(self) -> float:
        """Return the level up to which robots charge, `until_share`."""
        return self.parameters.until_share

    def is_calm(self) -> bool:
        """Return whether few orders arrived in the last window.

        The result is true if their rate is below `calm_share` times the mean rate since the rule
        was installed. Until two windows have passed, it is always false.
        """
        now_s, window_s = self.view.now_s, self.parameters.window_s
        while self._arrivals and self._arrivals[0] < now_s - window_s:
            self._arrivals.popleft()
        passed_s = now_s - self._begun_s
        if passed_s < 2 * window_s or not self._count:
            return False
        mean_rate = self._count / passed_s
        return len(self._arrivals) / window_s < self.parameters.calm_share * mean_rate

"""When an order is due, counted from its arrival."""

from __future__ import annotations

from functools import partial
from itertools import pairwise
from typing import TYPE_CHECKING, Annotated, Any, Literal

import pydantic
from pydantic import Field

from rmfs.scenario.distributions import Normal
from rmfs.scenario.quantities import Block, NotNegative, Positive, Share, not_below

if TYPE_CHECKING:
    from collections.abc import Callable


class PriorityDue(Block):
    """Two classes of orders: a share of urgent ones, and the rest."""

    mode: Literal["priority"] = "priority"
    urgent_share: Share = Field(0.2, description="share of orders that are urgent")
    urgent_offset_s: Positive = Field(
        1800.0, description="s from arrival to due time, urgent orders"
    )
    ordinary_offset_s: Positive = Field(
        7200.0, description="s from arrival to due time, all others"
    )

    def sampler(self) -> Callable[[float], float]:
        """Return the function that turns a number in [0, 1) into an offset in seconds."""
        share, urgent, ordinary = self.urgent_share, self.urgent_offset_s, self.ordinary_offset_s
        return partial(_by_priority, share, urgent, ordinary)


class NormalDue(Block):
    """Offsets are normal, cut to [min_s, max_s], in whole milliseconds."""

    mode: Literal["normal"] = "normal"
    mean_s: Positive = Field(10800.0, description="s from arrival to due time, before the cut")
    sd_s: Positive = Field(900.0, description="s, before the cut")
    min_s: Positive = Field(7200.0, description="s, least offset")
    max_s: Positive = Field(14400.0, description="s, greatest offset")

    @pydantic.field_validator("max_s")
    @classmethod
    def _in_order(cls, value: float, info: pydantic.ValidationInfo) -> float:
        return not_below(value, info, "min_s")

    @pydantic.model_validator(mode="after")
    def _holds_enough(self) -> NormalDue:
        self._offsets()
        return self

    def sampler(self) -> Callable[[float], float]:
        """Return the function that turns a number in [0, 1) into an offset in seconds."""
        quantile = self._offsets().quantile
        return partial(_in_ms, quantile)

    def _offsets(self) -> Normal:
        return Normal(mean=self.mean_s, sd=self.sd_s, min=self.min_s, max=self.max_s)


class DepartureDue(Block):
    """Orders are due when a truck leaves: the first that leaves so long after their arrival."""

    mode: Literal["departures"] = "departures"
    times_s: Annotated[tuple[NotNegative, ...], pydantic.Strict(strict=False)] = Field(
        min_length=1, description="s of the cycle at which trucks leave, in order"
    )
    cycle_s: float = Field(
        86400.0, ge=1, validate_default=True, description="s after which everything comes again"
    )
    lead_s: NotNegative = Field(
        3600.0, description="an order that comes less s before a truck leaves goes with the next"
    )

    @pydantic.field_validator("cycle_s")
    @classmethod
    def _in_order(cls, value: float, info: pydantic.ValidationInfo) -> float:
        times_s = info.data.get("times_s", ())
        if any(later <= sooner for sooner, later in pairwise(times_s)):
            raise ValueError("times_s must be in order")
        if times_s and times_s[-1] >= value:
            raise ValueError(f"must be more than the last of times_s = {times_s[-1]:g}")
        return value

    def sampler(self) -> Callable[[float], float]:
        """Return the function that turns a number in [0, 1) into an offset in seconds."""
        return partial(_always, self.lead_s)


Due = Annotated[PriorityDue | NormalDue | DepartureDue, Field(discriminator="mode")]


def _by_priority(share: float, urgent_s: float, ordinary_s: float, uniform: float) -> float:
    return urgent_s if uniform < share else ordinary_s


def _always(offset_s: float, _uniform: float) -> float:
    return offset_s


def _in_ms(quantile: Callable[[float], Any], uniform: float) -> float:
    return round(float(quantile(uniform)), 3)

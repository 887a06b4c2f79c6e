"""How a Poisson rate changes over time."""

from __future__ import annotations

from typing import Annotated, Literal

import pydantic
from pydantic import Field

from rmfs.scenario.parameters.calendar import DAY_S, Cycle
from rmfs.scenario.quantities import Block, NotNegative, Positive

# hours 0 to 23 in RAWSim-O: orders peak in the evening, bundles in the afternoon
ORDER_WEIGHTS = (
    *(20, 10, 5, 5, 10, 10, 20, 20, 40, 80, 80, 90),
    *(110, 80, 90, 130, 180, 120, 190, 250, 220, 150, 110, 50),
)
BUNDLE_WEIGHTS = (
    *(20, 40, 80, 80, 90, 110, 80, 90, 130, 180, 120, 190),
    *(250, 220, 150, 110, 50, 20, 10, 5, 5, 10, 10, 20),
)

Weights = Annotated[tuple[NotNegative, ...], pydantic.Strict(strict=False), Field(min_length=1)]


class ConstantRate(Block):
    """The same rate at all times."""

    kind: Literal["constant"] = "constant"


class Steps(Block):
    """A rate that changes in steps, which are repeated in every cycle.

    The mean rate over a cycle is `orders_per_h` or `bundles_per_h`.
    """

    kind: Literal["steps"] = "steps"
    cycle_s: Cycle = DAY_S
    weights: Weights
    starts_s: Weights | None = Field(
        None, description="start of each step, in s of the cycle; default: steps of equal length"
    )

    @pydantic.field_validator("weights")
    @classmethod
    def _one_positive(cls, value: tuple[float, ...]) -> tuple[float, ...]:
        if not any(value):
            raise ValueError("at least one weight must be positive")
        return value

    @pydantic.field_validator("starts_s")
    @classmethod
    def _in_order(
        cls, value: tuple[float, ...] | None, info: pydantic.ValidationInfo
    ) -> tuple[float, ...] | None:
        cycle_s, weights = info.data.get("cycle_s"), info.data.get("weights")
        if value is None or cycle_s is None or weights is None:
            return value
        if len(value) != len(weights):
            raise ValueError(f"must have as many entries as weights ({len(weights)})")
        ends_s = (*value[1:], cycle_s)
        if value[0] != 0 or any(end <= start for start, end in zip(value, ends_s, strict=True)):
            raise ValueError(f"must start with 0, ascend and stay below cycle_s = {cycle_s:g}")
        return value


class OrderSteps(Steps):
    """Steps of the order rate."""

    weights: Weights = Field(ORDER_WEIGHTS, description="relative rate of each step")


class BundleSteps(Steps):
    """Steps of the bundle rate."""

    weights: Weights = Field(BUNDLE_WEIGHTS, description="relative rate of each step")


class HighLowRate(Block):
    """A rate that switches between a low and a high value, starting with the low value.

    The lengths of low and high periods are exponentially distributed. If orders and bundles have
    the same values of `low_to_high_per_h` and `high_to_low_per_h`, their high periods coincide.
    """

    kind: Literal["high-low"] = "high-low"
    high_per_h: NotNegative = Field(description="rate in high periods, which replaces the low one")
    low_to_high_per_h: Positive = Field(
        0.5, description="number of switches to a high period per h of low periods"
    )
    high_to_low_per_h: Positive = Field(
        2.0, description="number of switches to a low period per h of high periods"
    )


OrderRates = Annotated[ConstantRate | OrderSteps | HighLowRate, Field(discriminator="kind")]
BundleRates = Annotated[ConstantRate | BundleSteps | HighLowRate, Field(discriminator="kind")]
AnyRate = ConstantRate | Steps | HighLowRate

TiedTo = Literal["nothing", "pick-stations", "replenishment-stations"]
TIED_TO = "stations whose active share multiplies the rate; at least one counts as active"

"""Down periods and batches, which occur at given times of a cycle, usually a day."""

from __future__ import annotations

import itertools
from typing import Annotated

import pydantic
from pydantic import Field

from rmfs.scenario.quantities import Block, Count, NotNegative, Positive

DAY_S = 86400.0
LEAST_OPEN_S = 1.0

Cycle = Annotated[
    float, Field(ge=1, description="length of the cycle in s, after which everything repeats")
]

Period = Annotated[tuple[NotNegative, Positive], pydantic.Strict(strict=False)]
Periods = Annotated[tuple[Period, ...], pydantic.Strict(strict=False)]
Number = Annotated[tuple[NotNegative, Count], pydantic.Strict(strict=False)]
Numbers = Annotated[tuple[Number, ...], pydantic.Strict(strict=False)]
Level = Annotated[
    tuple[NotNegative, Annotated[float, Field(gt=0, le=1)]], pydantic.Strict(strict=False)
]
Levels = Annotated[tuple[Level, ...], pydantic.Strict(strict=False)]


class DownPeriods(Block):
    """Periods in which nothing but batches arrives.

    A backlog is not topped up, a Poisson rate is zero, and a stream from a file holds back its
    arrivals until the period ends. At time zero, the initial orders and bundles of Poisson arrivals
    (`initial_orders`, `initial_bundles`) are generated even in a down period.
    """

    cycle_s: Cycle = DAY_S
    periods_s: Periods = Field(
        min_length=1, description="periods as pairs of start and end, in s of the cycle, in order"
    )

    @pydantic.field_validator("periods_s")
    @classmethod
    def _in_order(
        cls, value: tuple[Period, ...], info: pydantic.ValidationInfo
    ) -> tuple[Period, ...]:
        cycle_s = info.data.get("cycle_s")
        if cycle_s is None:
            return value
        last_s = 0.0
        for begin_s, end_s in value:
            if not last_s <= begin_s < end_s <= cycle_s:
                raise ValueError(
                    f"must be in order, not overlap and end by cycle_s = {cycle_s:g}: "
                    f"[{begin_s:g}, {end_s:g}] does not"
                )
            last_s = end_s
        if sum(end_s - begin_s for begin_s, end_s in value) > cycle_s - LEAST_OPEN_S:
            raise ValueError(f"must leave at least {LEAST_OPEN_S:g} s of the cycle")
        return value


class _Batches(Block):
    cycle_s: Cycle = DAY_S
    fill_to: tuple[tuple[float, float], ...]
    add: Numbers = Field(
        (),
        description="pairs of a time of the cycle in s and the number that arrive then, in "
        "addition",
    )

    @pydantic.field_validator("fill_to", "add")
    @classmethod
    def _in_order(
        cls, value: tuple[tuple[float, float], ...], info: pydantic.ValidationInfo
    ) -> tuple[tuple[float, float], ...]:
        cycle_s = info.data.get("cycle_s")
        times_s = [time_s for time_s, _ in value]
        if cycle_s is not None and times_s and times_s[-1] >= cycle_s:
            raise ValueError(f"times must be less than cycle_s = {cycle_s:g}")
        if any(later <= sooner for sooner, later in itertools.pairwise(times_s)):
            raise ValueError("times must be in ascending order")
        return value

    @pydantic.model_validator(mode="after")
    def _not_empty(self) -> _Batches:
        if not self.fill_to and not self.add:
            raise ValueError("fill_to or add must list at least one batch")
        return self


class OrderBatches(_Batches):
    """Batches of orders, in addition to all other orders; each batch arrives all at once."""

    fill_to: Numbers = Field(
        (),
        description="pairs of a time of the cycle in s and a backlog: orders arrive until that "
        "many wait",
    )
    per_station: bool = Field(True, description="whether numbers of orders are per pick station")


class BundleBatches(_Batches):
    """Batches of bundles, in addition to all other bundles; each batch arrives all at once."""

    fill_to: Levels = Field(
        (),
        description="pairs of a time of the cycle in s and a share of the pods' capacity: "
        "bundles arrive until the load (stored, under way and waiting) reaches it",
    )

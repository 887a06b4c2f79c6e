"""Due times of orders. An offset is the due time of an order minus its arrival time."""

from __future__ import annotations

from bisect import bisect_right
from functools import partial
from itertools import accumulate, pairwise
from typing import TYPE_CHECKING, Annotated, Any, Literal

import pydantic
from pydantic import Field

from rmfs.scenario.distributions import Normal
from rmfs.scenario.quantities import Block, NotNegative, Positive, Share, not_below

if TYPE_CHECKING:
    from collections.abc import Callable


class PriorityDue(Block):
    """Orders are urgent or ordinary; each of these two kinds has its own constant offset."""

    mode: Literal["priority"] = "priority"
    urgent_share: Share = Field(0.2, description="share of orders that are urgent")
    urgent_offset_s: Positive = Field(
        1800.0, description="time from arrival to due time of urgent orders, s"
    )
    ordinary_offset_s: Positive = Field(
        7200.0, description="time from arrival to due time of all others, s"
    )

    def sampler(self) -> Callable[[float], float]:
        """Return the function that turns a number in [0, 1) into a due-time offset in seconds."""
        share, urgent, ordinary = self.urgent_share, self.urgent_offset_s, self.ordinary_offset_s
        return partial(_by_priority, share, urgent, ordinary)


class OrderClass(Block):
    """A class of orders with the same offset and weight."""

    name: Annotated[str, Field(pattern=r"^[A-Za-z0-9][A-Za-z0-9 ._-]{0,39}$")] = Field(
        description="name in tables and files of orders; up to 40 letters, digits, spaces, . _ -"
    )
    share: Share = Field(description="share of the orders")
    offset_s: Positive = Field(description="time from arrival to due time, s")
    weight: Annotated[float, Field(ge=0.001, le=1000)] = Field(
        1.0,
        description="weight of lateness relative to that of other orders, from 0.001 to 1000",
    )


class ClassesDue(Block):
    """Any number of classes of orders, each with a share, an offset and a weight."""

    mode: Literal["classes"] = "classes"
    classes: Annotated[tuple[OrderClass, ...], pydantic.Strict(strict=False)] = Field(
        min_length=1,
        max_length=20,
        description="the most urgent class first; the shares must sum to 1",
    )

    @pydantic.field_validator("classes")
    @classmethod
    def _whole(cls, value: tuple[OrderClass, ...]) -> tuple[OrderClass, ...]:
        names = [one.name for one in value]
        twice = [name for name in names if names.count(name) > 1]
        if twice:
            raise ValueError(f"the name {twice[0]} occurs twice")
        if abs((total := sum(one.share for one in value)) - 1.0) > 1e-6:
            raise ValueError(f"shares must sum to 1 (their sum is {total:g})")
        return value

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the classes."""
        return tuple(one.name for one in self.classes)

    def sampler(self) -> Callable[[float], float]:
        """Return the function that turns a number in [0, 1) into a due-time offset in seconds."""
        return partial(_by_class, self._bounds(), tuple(one.offset_s for one in self.classes))

    def class_of(self, uniform: float) -> int:
        """Return the index of the class whose offset the sampler gives for a number in [0, 1)."""
        return bisect_right(self._bounds(), uniform)

    def _bounds(self) -> tuple[float, ...]:
        """Cumulative shares without the last, so that rounding leaves no order without a class."""
        return tuple(accumulate(one.share for one in self.classes))[:-1]


class NormalDue(Block):
    """Offsets are normal, truncated to [min_s, max_s], and rounded to whole milliseconds."""

    mode: Literal["normal"] = "normal"
    mean_s: Positive = Field(
        10800.0, description="mean time from arrival to due time before truncation, s"
    )
    sd_s: Positive = Field(900.0, description="standard deviation before truncation, s")
    min_s: Positive = Field(7200.0, description="shortest time from arrival to due time, s")
    max_s: Positive = Field(14400.0, description="longest time from arrival to due time, s")

    @pydantic.field_validator("max_s")
    @classmethod
    def _in_order(cls, value: float, info: pydantic.ValidationInfo) -> float:
        return not_below(value, info, "min_s")

    @pydantic.model_validator(mode="after")
    def _holds_enough(self) -> NormalDue:
        self._offsets()
        return self

    def sampler(self) -> Callable[[float], float]:
        """Return the function that turns a number in [0, 1) into a due-time offset in seconds."""
        quantile = self._offsets().quantile
        return partial(_in_ms, quantile)

    def _offsets(self) -> Normal:
        return Normal(mean=self.mean_s, sd=self.sd_s, min=self.min_s, max=self.max_s)


class DepartureDue(Block):
    """Orders are due at the first truck departure that is at least `lead_s` after their arrival."""

    mode: Literal["departures"] = "departures"
    times_s: Annotated[tuple[NotNegative, ...], pydantic.Strict(strict=False)] = Field(
        min_length=1, description="departure times of trucks, in s of the cycle, in order"
    )
    cycle_s: float = Field(
        86400.0,
        ge=1,
        validate_default=True,
        description="length of the cycle in s, after which departures repeat",
    )
    lead_s: NotNegative = Field(
        3600.0,
        description="an order that arrives less than this many s before a departure goes with "
        "the next one",
    )

    @pydantic.field_validator("cycle_s")
    @classmethod
    def _in_order(cls, value: float, info: pydantic.ValidationInfo) -> float:
        times_s = info.data.get("times_s", ())
        if any(later <= sooner for sooner, later in pairwise(times_s)):
            raise ValueError("times_s must be in ascending order")
        if times_s and times_s[-1] >= value:
            raise ValueError(f"must be greater than the last of times_s = {times_s[-1]:g}")
        return value

    def sampler(self) -> Callable[[float], float]:
        """Return a function that always returns `lead_s`.

        `Departures` then postpones the due time to the next departure.
        """
        return partial(_always, self.lead_s)


Due = Annotated[PriorityDue | ClassesDue | NormalDue | DepartureDue, Field(discriminator="mode")]

NO_CLASS = -1
"""Class of an order if the due times of the scenario are not `ClassesDue`."""


def class_of(due: Due, uniform: float) -> int:
    """Return the index of an order's class; `NO_CLASS` unless `due` is a `ClassesDue`.

    Parameters
    ----------
    uniform
        The number in [0, 1) from which the offset of the order was drawn.
    """
    return due.class_of(uniform) if isinstance(due, ClassesDue) else NO_CLASS


def _by_class(bounds: tuple[float, ...], offsets_s: tuple[float, ...], uniform: float) -> float:
    return offsets_s[bisect_right(bounds, uniform)]


def _by_priority(share: float, urgent_s: float, ordinary_s: float, uniform: float) -> float:
    return urgent_s if uniform < share else ordinary_s


def _always(offset_s: float, _uniform: float) -> float:
    return offset_s


def _in_ms(quantile: Callable[[float], Any], uniform: float) -> float:
    return round(float(quantile(uniform)), 3)

"""Distributions of real numbers in scenarios; unbounded ones are truncated to a range.

Every distribution is sampled by inversion: `quantile` converts a uniform number to a value, and
truncation to [min, max] only narrows the range of the uniform number. The values therefore follow
the distribution *conditional* on lying in [min, max], as with rejection sampling, but each value
takes only one uniform number.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import TYPE_CHECKING, Annotated, Literal

import numpy as np
import pydantic
from scipy import special

from rmfs.scenario.quantities import Block, NotNegative, Positive, not_below

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    Floats = NDArray[np.floating]

LEAST_MASS = 1e-9
"""Minimum probability of the range, below which inversion loses precision."""


class Constant(Block):
    """Distribution with a single possible value."""

    distribution: Literal["constant"] = "constant"
    value: Positive = 1.0

    def quantile(self, uniform: ArrayLike) -> NDArray[np.float64]:
        """Return the value for each uniform number in [0, 1)."""
        return np.full(np.shape(uniform), self.value)


class Uniform(Block):
    """Uniform distribution between `min` and `max`."""

    distribution: Literal["uniform"] = "uniform"
    min: Positive
    max: Positive

    @pydantic.field_validator("max")
    @classmethod
    def _in_order(cls, value: float, info: pydantic.ValidationInfo) -> float:
        return not_below(value, info, "min")

    def quantile(self, uniform: ArrayLike) -> NDArray[np.float64]:
        """Return the value for each uniform number in [0, 1)."""
        return self.min + np.asarray(uniform) * (self.max - self.min)


class _Cut(Block, ABC):
    """A distribution truncated to the range from `min` to `max`."""

    distribution: str
    min: NotNegative = 0.0
    max: Positive | None = None

    @pydantic.field_validator("max")
    @classmethod
    def _in_order(cls, value: float | None, info: pydantic.ValidationInfo) -> float | None:
        return None if value is None else not_below(value, info, "min")

    @pydantic.model_validator(mode="after")
    def _holds_enough(self) -> _Cut:
        below, above = self._below(self._limits), self._above(self._limits)
        mass = max(below[1] - below[0], above[0] - above[1])
        if mass < LEAST_MASS and self.min != self.max:
            raise ValueError(f"almost no value lies between min and max (probability {mass:.1g})")
        return self

    @property
    def _limits(self) -> Floats:
        return np.array([self.min, np.inf if self.max is None else self.max])

    def quantile(self, uniform: ArrayLike) -> NDArray[np.float64]:
        """Return the value for each uniform number in [0, 1)."""
        share = np.asarray(uniform, dtype=np.float64)
        low, high = self._below(self._limits)
        if low < 0.5:
            values = self._below_inverse(low + share * (high - low))
        else:
            # in the upper tail the probability below is 1 up to rounding
            low, high = self._above(self._limits)
            values = self._above_inverse(low - share * (low - high))
        return np.clip(values, *self._limits).astype(np.float64)

    @abstractmethod
    def _below(self, x: Floats) -> Floats:
        """Probability of a value below x."""

    @abstractmethod
    def _above(self, x: Floats) -> Floats:
        """Probability of a value above x."""

    @abstractmethod
    def _below_inverse(self, p: Floats) -> Floats:
        """Return the value with probability p below it."""

    @abstractmethod
    def _above_inverse(self, p: Floats) -> Floats:
        """Return the value with probability p above it."""


class Normal(_Cut):
    """Normal distribution, truncated to [min, max]; `mean` and `sd` are those before truncation."""

    distribution: Literal["normal"] = "normal"
    mean: float
    sd: Positive

    def _below(self, x: Floats) -> Floats:
        return special.ndtr((x - self.mean) / self.sd)

    def _above(self, x: Floats) -> Floats:
        return special.ndtr((self.mean - x) / self.sd)

    def _below_inverse(self, p: Floats) -> Floats:
        return self.mean + self.sd * special.ndtri(p)

    def _above_inverse(self, p: Floats) -> Floats:
        return self.mean - self.sd * special.ndtri(p)


class Gamma(_Cut):
    """Gamma distribution, truncated to [min, max]; its mean before truncation is shape x scale."""

    distribution: Literal["gamma"] = "gamma"
    shape: Positive
    scale: Positive

    def _below(self, x: Floats) -> Floats:
        return special.gammainc(self.shape, x / self.scale)

    def _above(self, x: Floats) -> Floats:
        return special.gammaincc(self.shape, x / self.scale)

    def _below_inverse(self, p: Floats) -> Floats:
        return special.gammaincinv(self.shape, p) * self.scale

    def _above_inverse(self, p: Floats) -> Floats:
        return special.gammainccinv(self.shape, p) * self.scale


class Exponential(_Cut):
    """Exponential distribution, truncated to [min, max]; its mean before truncation is 1 / rate."""

    distribution: Literal["exponential"] = "exponential"
    rate: Positive

    def _below(self, x: Floats) -> Floats:
        below: Floats = -np.expm1(-self.rate * x)
        return below

    def _above(self, x: Floats) -> Floats:
        above: Floats = np.exp(-self.rate * x)
        return above

    def _below_inverse(self, p: Floats) -> Floats:
        return -np.log1p(-p) / self.rate

    def _above_inverse(self, p: Floats) -> Floats:
        return -np.log(p) / self.rate


Popularity = Annotated[
    Constant | Uniform | Normal | Gamma | Exponential, pydantic.Field(discriminator="distribution")
]
"""Distribution of the relative frequency with which SKUs are ordered."""

Space = Annotated[Constant | Uniform | Normal, pydantic.Field(discriminator="distribution")]
"""Distribution of the space units taken by one unit of a SKU."""

"""Distributions of whole numbers in scenarios."""

from __future__ import annotations

from abc import ABC, abstractmethod
from functools import partial
from typing import TYPE_CHECKING, Annotated, Literal

import numpy as np
import pydantic
from scipy import special

from rmfs.scenario.categorical import Categorical
from rmfs.scenario.distributions import LEAST_MASS
from rmfs.scenario.quantities import Block, Count, NotNegative, not_below

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray


class _Range(Block, ABC):
    """Whole numbers from `min` to `max`, inclusive."""

    distribution: str
    min: Count
    max: Count

    @pydantic.field_validator("max")
    @classmethod
    def _in_order(cls, value: int, info: pydantic.ValidationInfo) -> int:
        return not_below(value, info, "min")

    @abstractmethod
    def probabilities(self) -> NDArray[np.float64]:
        """Return the probabilities of `min`, `min` + 1, ..., `max`."""

    def sampler(self) -> Callable[[float], int]:
        """Return the function that turns a number in [0, 1) into a count."""
        pick, least = Categorical(self.probabilities()).pick, self.min
        return partial(_count, least, pick)


class UniformCount(_Range):
    """Uniform distribution of the whole numbers from `min` to `max`."""

    distribution: Literal["uniform"] = "uniform"

    def probabilities(self) -> NDArray[np.float64]:
        """Return the probabilities of `min`, `min` + 1, ..., `max`."""
        n = self.max - self.min + 1
        return np.full(n, 1.0 / n)


class NormalCount(_Range):
    """Normal distribution, truncated to [min - 0.5, max + 0.5) and rounded.

    `mean` and `sd` are those before truncation. If `sd` is 0, the count is the rounded mean.
    """

    distribution: Literal["normal"] = "normal"
    mean: NotNegative
    sd: NotNegative

    @pydantic.model_validator(mode="after")
    def _holds_enough(self) -> NormalCount:
        if self._mass().sum() < LEAST_MASS:
            raise ValueError("mean and sd put almost no count between min and max")
        return self

    def probabilities(self) -> NDArray[np.float64]:
        """Return the probabilities of `min`, `min` + 1, ..., `max`."""
        mass = self._mass()
        probabilities: NDArray[np.float64] = mass / mass.sum()
        return probabilities

    def _mass(self) -> NDArray[np.float64]:
        """Return the probability of each count before truncation."""
        counts = np.arange(self.min, self.max + 1)
        if self.sd == 0:
            return np.equal(counts, np.floor(self.mean + 0.5)).astype(np.float64)
        low, high = (counts - 0.5 - self.mean) / self.sd, (counts + 0.5 - self.mean) / self.sd
        # above the mean the difference is taken between upper tails, for precision
        lower = special.ndtr(high) - special.ndtr(low)
        return np.where(low > 0, special.ndtr(-low) - special.ndtr(-high), lower)


Weights = Annotated[
    tuple[NotNegative, ...], pydantic.Strict(strict=False), pydantic.Field(max_length=1000)
]


class ListedCount(Block):
    """The values 1, 2, ..., n, each with a relative weight; n is at most 1000."""

    distribution: Literal["listed"] = "listed"
    weights: Weights

    @pydantic.field_validator("weights")
    @classmethod
    def _ends_with_one(cls, value: tuple[float, ...]) -> tuple[float, ...]:
        if not value or not value[-1]:
            raise ValueError("must end with a weight above 0")
        return value

    @property
    def max(self) -> int:
        """Largest count."""
        return len(self.weights)

    def probabilities(self) -> NDArray[np.float64]:
        """Return the probabilities of 1, 2, ..., `max`."""
        weights = np.array(self.weights)
        made: NDArray[np.float64] = weights / weights.sum()
        return made

    def sampler(self) -> Callable[[float], int]:
        """Return the function that turns a number in [0, 1) into a count."""
        return partial(_count, 1, Categorical(self.probabilities()).pick)


NormalOrListed = Annotated[NormalCount | ListedCount, pydantic.Field(discriminator="distribution")]

Counts = Annotated[UniformCount | NormalCount, pydantic.Field(discriminator="distribution")]


def _count(least: int, pick: Callable[[float], int], uniform: float) -> int:
    return least + pick(uniform)

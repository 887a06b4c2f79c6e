"""Numbers that are equal on every processor.

Sums, products, quotients and square roots are rounded the same way everywhere; logarithms, error
functions and their inverses may differ in the last bits. As popularities and spaces of SKUs may be
computed with such functions, this module rounds them to far fewer digits before they are used.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

SIGNIFICANT_BITS = 30
"""Precision that `significant` keeps: about nine decimal digits."""

SPACE_STEPS = 2**20
"""Number of steps in a space unit; up to 2**33 space units still add up exactly."""


def significant(values: NDArray[np.float64]) -> NDArray[np.float64]:
    """Round to `SIGNIFICANT_BITS` significant bits."""
    mantissa, exponent = np.frexp(values)
    whole = np.rint(np.ldexp(mantissa, SIGNIFICANT_BITS))
    rounded: NDArray[np.float64] = np.ldexp(whole, exponent - SIGNIFICANT_BITS)
    return rounded


def space(values: NDArray[np.float64]) -> NDArray[np.float64]:
    """Round down to multiples of 1 / `SPACE_STEPS` space units, with a minimum of one step.

    Sums and differences of such values are exact, so the space used on a pod does not drift and
    does not depend on the order of operations. Values are rounded down so that ten units that take
    0.1 space units each fit into one space unit.
    """
    return np.maximum(np.floor(values * SPACE_STEPS), 1.0) / SPACE_STEPS

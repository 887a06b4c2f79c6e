"""Sequential stopping: runs are added until a confidence interval is narrow enough."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rmfs.experiments.statistics.intervals import interval

if TYPE_CHECKING:
    from collections.abc import Sequence


def narrow_enough(values: Sequence[float], relative: float, confidence: float = 0.95) -> bool:
    """Return whether the t interval of a mean is narrow enough relative to the mean.

    This is the stopping rule of the sequential procedure of Law and Kelton (Simulation Modeling and
    Analysis, section on confidence intervals with specified precision, after Chow and Robbins
    1965). The half width must be at most relative / (1 + relative) times the absolute value of the
    mean. If the interval covers the true mean, the error relative to the true mean is then at most
    `relative`.

    The procedure tends to stop when the sample happens to vary little. If it starts with few runs,
    the interval therefore covers the true mean with a probability somewhat below `confidence` (see
    `tests.tools.coverage`).

    Parameters
    ----------
    relative
        Maximum permitted relative error of the mean.
    """
    if len(values) < 2:
        return False
    found = interval(values, confidence)
    return found.half_width <= relative / (1.0 + relative) * abs(found.mean)

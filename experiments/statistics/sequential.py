"""Sequential stopping: runs until a confidence interval is narrow enough."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rmfs.experiments.statistics.intervals import interval

if TYPE_CHECKING:
    from collections.abc import Sequence


def narrow_enough(values: Sequence[float], relative: float, confidence: float = 0.95) -> bool:
    """Whether the t interval of a mean is narrow in relation to it.

    The sequential procedure of Law and Kelton (Simulation Modeling and Analysis, section on
    confidence intervals with specified precision, after Chow and Robbins 1965): the half width is
    compared with relative / (1 + relative) times the mean, so that the true mean is missed by no
    more than `relative` of itself. As it stops where the sample happens to vary little, its
    coverage lies somewhat below `confidence` when few runs are the start
    (`tests.tools.coverage`).

    Parameters
    ----------
    relative
        Half width wanted, as a share of the mean.
    """
    if len(values) < 2:
        return False
    found = interval(values, confidence)
    return found.half_width <= relative / (1.0 + relative) * abs(found.mean)

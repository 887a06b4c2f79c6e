"""A diagnostic, not a bound: what stations would do at the pile-on a run had."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike

from solvers.models.checks import reals, require


def units_per_h_at_pile_on(
    pile_on: float, unit_transfer_s: ArrayLike, unit_pick_s: ArrayLike, changeover_s: ArrayLike
) -> float:
    r"""Return the units per hour of stations that never wait for pods of this pile-on.

    The formula of the reference system (RAWSim-O, "UnitThroughputRateUB"; see
    `reference/rawsimo-inputs-outputs.md`, 4.3), summed over the stations:

    .. math::

        \frac{3600\, p}{\max(c + \pi - \tau, 0) + p \tau}

    A run with another pile-on may pass it, so it says how well the stations were fed and nothing
    about what is possible; compare `units_per_h_bound`.

    Parameters
    ----------
    pile_on
        Units per visit p that a run measured; nan if it had no visit.
    unit_transfer_s, unit_pick_s
        Time one unit keeps the station (tau) and the robot (pi), shape (S,), in s.
    changeover_s
        Time c from one robot's leaving until the next one can be served, shape (S,), in s.

    Returns
    -------
    Units per hour; 0 without visits.

    Raises
    ------
    ModelError
        If a shape or a value is wrong.
    """
    transfer = reals("unit_transfer_s", unit_transfer_s, (None,), low=0)
    pick = reals("unit_pick_s", unit_pick_s, transfer.shape, low=0)
    change = reals("changeover_s", changeover_s, transfer.shape, low=0)
    if math.isnan(pile_on) or pile_on == 0:
        return 0.0
    require(pile_on > 0, "pile_on", f"must not be negative, is {pile_on}")
    visit_s = np.maximum(change + pick - transfer, 0.0) + pile_on * transfer
    require(bool((visit_s > 0).all()), "unit_transfer_s", "no station is infinitely fast")
    return float((3600.0 * pile_on / visit_s).sum())

"""The proven upper bound on the units picked per hour in a run, computed by `rmfs.solvers`.

Importing this module does not import `rmfs.solvers`. The function that computes the bound is given
by its name and imported only when it is needed.
"""

from __future__ import annotations

import importlib
import warnings
from dataclasses import replace
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from rmfs.control.travel import TravelTimes
    from rmfs.layout.model import Layout
    from rmfs.scenario import SkuSet
    from rmfs.world.pickers import Staff

BOUND = "rmfs.solvers.run_bound:units_per_h_bound"
"""Module and function that compute the bound."""


class BoundExceededWarning(UserWarning):
    """A run exceeded its proven bound, so there is a defect in the simulator or in the proof."""


def units_per_h_bound(layout: Layout, skus: SkuSet, times: TravelTimes, duration_s: float) -> float:
    """Return an upper bound on the units picked per hour in any run of a warehouse.

    The bound is infinite if some handling takes no time. The page `docs/bounds.md` contains the
    proof.

    Parameters
    ----------
    times
        Travel times without hindrance, which are lower bounds on the actual travel times.
    duration_s
        Length of the period in which units are counted, in s.
    """
    module, _, name = BOUND.partition(":")
    bound: float = getattr(importlib.import_module(module), name)(layout, skus, times, duration_s)
    return bound


def at_best(layout: Layout, staff: Staff | None) -> Layout | None:
    """Return the layout with the shortest times per unit that the pickers in `staff` can achieve.

    Returns
    -------
    Layout or None
        A copy with changed pick stations, or the layout itself if `staff` is None (there are no
        pickers). None if the time per unit at a pick station can be arbitrarily short.
    """
    if staff is None:
        return layout
    stations = []
    for station in layout.pick_stations:
        full_s = station.unit_transfer_s
        # the simulation rounds to microseconds
        least_s = staff.least_s(full_s) * (1.0 - 1e-9) - 1e-6
        if least_s <= 0.0:
            return None
        pick_s = max(station.unit_pick_s * (least_s / full_s) - 1e-6, 0.0)
        stations.append(replace(station, unit_transfer_s=least_s, unit_pick_s=pick_s))
    return replace(layout, pick_stations=type(layout.pick_stations)(stations))


def warn_if_exceeded(units_per_h: float, bound: float) -> None:
    """Issue a `BoundExceededWarning` if a run picked more than its upper bound.

    Parameters
    ----------
    units_per_h
        Units picked per hour.
    bound
        Upper bound on the units per hour; see `units_per_h_bound`.
    """
    if units_per_h > bound:
        told = f"{units_per_h} units per hour were picked, but at most {bound} are possible"
        warnings.warn(f"{told}: please report this defect", BoundExceededWarning, stacklevel=2)

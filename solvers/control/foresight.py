"""Forecast of the visits of pods to pick stations, from stock, popularity and backlog."""

from __future__ import annotations

from math import inf
from typing import TYPE_CHECKING

from rmfs.control.trackers.frequency import Frequency
from rmfs.solvers.models.storage.placement import expected_visits

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from rmfs.control.view import View

_PRIOR_VISITS = 20.0
_PRIOR_PILE_ON = 2.0
_PRIOR_H = 0.1


class Foresight:
    """Forecasts the visits of pods to pick stations; a forecast is kept for `kept_s` seconds.

    The units needed within the horizon are those already ordered but not yet picked, and those of
    the new orders expected. Pods are expected to supply these units in proportion to their stock,
    `pile_on` units per visit. New orders are expected to need as many units per hour as have been
    picked per hour so far, distributed over SKUs in proportion to the units ordered so far.

    To stabilise the estimates at the beginning of a run, fictitious observations are included: six
    minutes in which all pick stations pick without a pause (for the units picked per hour), and
    twenty visits of two units each (for the units picked per visit).

    Parameters
    ----------
    view
        The world.
    horizon_s
        How far ahead visits are forecast, in s; positive.
    kept_s
        Seconds after which the forecast is recomputed.
    """

    def __init__(self, view: View, horizon_s: float, kept_s: float) -> None:
        self._view = view
        self._frequency = view.trackers.get(Frequency)
        self._horizon_h = horizon_s / 3600.0
        self._kept_s = kept_s
        self._found_s = -inf
        self._rate_per_h: NDArray[np.float64] | None = None
        self._before_units = self._picked()
        self._before_s = view.now_s
        stations = view.layout.pick_stations
        self._most_per_h = sum(3600.0 / station.unit_transfer_s for station in stations)

    @property
    def units_per_h(self) -> NDArray[np.float64]:
        """Expected number of units of each SKU ordered per hour, shape (K,)."""
        units = self._frequency.units
        hours = (self._view.now_s - self._before_s) / 3600.0
        picked = self._picked() - self._before_units + _PRIOR_H * self._most_per_h
        rate: NDArray[np.float64] = units * (picked / (hours + _PRIOR_H) / max(units.sum(), 1))
        return rate

    @property
    def pile_on(self) -> float:
        """Units picked per visit so far, including the fictitious visits; at least 1."""
        visits = sum(station.visits for station in self._view.pick_stations)
        units = _PRIOR_VISITS * _PRIOR_PILE_ON + self._picked()
        return max(1.0, float(units / (_PRIOR_VISITS + visits)))

    @property
    def visits_per_h(self) -> NDArray[np.float64]:
        """Expected number of visits per hour of each pod to pick stations, shape (P,)."""
        now_s = self._view.now_s
        if self._rate_per_h is None or now_s >= self._found_s + self._kept_s:
            inventory = self._view.inventory
            visits = expected_visits(
                inventory.available,
                inventory.wanted,
                self.units_per_h,
                horizon_h=self._horizon_h,
                pile_on=self.pile_on,
            )
            self._rate_per_h = visits / self._horizon_h
            self._found_s = now_s
        return self._rate_per_h

    def _picked(self) -> int:
        inventory = self._view.inventory
        done = int(inventory.ordered.sum() - inventory.wanted.sum())
        return done - inventory.withdrawn_units

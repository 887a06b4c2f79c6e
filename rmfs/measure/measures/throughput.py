"""Throughput: counts, hourly rates, and the rates that the stations could have reached."""

from __future__ import annotations

from math import nan
from typing import TYPE_CHECKING, Any

from rmfs.measure.base import Measure
from rmfs.measure.bound import at_best, units_per_h_bound, warn_if_exceeded
from rmfs.measure.columns import INTEGER, MORE, REAL, Column
from rmfs.measure.measures.reckoning import ratio

if TYPE_CHECKING:
    from rmfs.measure.ended import EndedRun


class Throughput(Measure):
    """Orders, lines, units and bundles handled, in total and per hour."""

    columns = (
        Column(
            "orders_completed",
            INTEGER,
            "orders",
            "Orders that were completely picked and have left their pick stations",
            better=MORE,
        ),
        Column(
            "lines_picked",
            INTEGER,
            "lines",
            "Order lines whose last unit was picked",
            better=MORE,
        ),
        Column("units_picked", INTEGER, "units", "Units picked from pods into orders", better=MORE),
        Column(
            "bundles_stored",
            INTEGER,
            "bundles",
            "Replenishment bundles put into pods",
            better=MORE,
        ),
        Column("orders_per_h", REAL, "1/h", "orders_completed / duration", better=MORE),
        Column("lines_per_h", REAL, "1/h", "lines_picked / duration", better=MORE),
        Column("units_per_h", REAL, "1/h", "units_picked / duration", better=MORE),
        Column("bundles_per_h", REAL, "1/h", "bundles_stored / duration", better=MORE),
        Column("units_stored", INTEGER, "units", "Units in the stored bundles", better=MORE),
    )

    def footprint(self, run: EndedRun) -> dict[str, Any]:
        """Return the counts over all stations, the hourly rates, and the number of units stored."""
        handled = ("orders_completed", "lines_picked", "units_picked", "bundles_stored")
        counts = {name: run.handled(name) for name in handled}
        hours = run.logs.duration_s / 3600.0
        rates = {
            f"{name.partition('_')[0]}_per_h": ratio(count, hours) for name, count in counts.items()
        }
        return {**counts, **rates, "units_stored": int(run.logs.stored_now["units"].sum())}


class Potential(Measure):
    """Units per hour that the pick stations could have picked, and the units score."""

    columns = (
        Column(
            "units_per_h_bound",
            REAL,
            "1/h",
            "Proven upper bound on units_per_h for this layout, these SKUs and this duration, "
            "whatever the controllers, the demand and the seed (docs/bounds.md)",
        ),
        Column(
            "units_score", REAL, "share", "units_per_h / units_per_h_bound; at most 1", better=MORE
        ),
        Column(
            "units_per_h_at_pile_on",
            REAL,
            "1/h",
            "Units per hour that the pick stations would pick, with the pile-on of this run, if "
            "they never waited longer for a pod than motion requires (docs/measures.md); sum "
            "over stations; empty if the scenario has pickers",
            better=MORE,
        ),
    )

    def footprint(self, run: EndedRun) -> dict[str, Any]:
        """Return the bound on units per hour, the units score, and `units_per_h_at_pile_on`.

        All three are nan if pickers may handle units in arbitrarily short times;
        `units_per_h_at_pile_on` is nan in every scenario with pickers. A warning is issued if the
        bound is exceeded.
        """
        duration_s = run.logs.duration_s
        layout = at_best(run.layout, run.world.staff)
        if layout is None:
            return dict.fromkeys((column.name for column in self.columns), nan)
        bound = units_per_h_bound(layout, run.world.skus, run.recorder.traffic, duration_s)
        rate = ratio(run.handled("units_picked") * 3600.0, duration_s)
        warn_if_exceeded(rate, bound)
        return {
            "units_per_h_bound": bound,
            "units_score": ratio(rate, bound),
            "units_per_h_at_pile_on": run.tables["stations"]["units_per_h_at_pile_on"].sum(
                skipna=run.world.staff is None
            ),
        }

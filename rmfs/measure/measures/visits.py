"""Visits of pods to stations, and what is handled in each."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from rmfs.measure.base import Measure
from rmfs.measure.columns import INTEGER, MORE, REAL, Column
from rmfs.measure.measures.reckoning import ratio

if TYPE_CHECKING:
    from rmfs.measure.ended import EndedRun


class Visits(Measure):
    """Number of visits, and units, lines, orders and bundles per visit."""

    columns = (
        Column(
            "pick_visits",
            INTEGER,
            "visits",
            "Visits of a pod to a pick station in which at least one unit was picked; a pod that "
            "stays for further requests makes a single visit",
        ),
        Column(
            "units_per_visit", REAL, "units", "Pile-on: units_picked / pick_visits", better=MORE
        ),
        Column("lines_per_visit", REAL, "lines", "lines_picked / pick_visits", better=MORE),
        Column("orders_per_visit", REAL, "orders", "orders_completed / pick_visits", better=MORE),
        Column(
            "bundles_per_visit",
            REAL,
            "bundles",
            "bundles_stored / replenishment_visits",
            better=MORE,
        ),
        Column(
            "replenishment_visits",
            INTEGER,
            "visits",
            "Visits of a pod to a replenishment station in which at least one bundle was stored",
        ),
        Column(
            "late_bound_units_per_visit",
            REAL,
            "units",
            "Picked units that were bound to their pod after a robot had got the task to bring "
            "it, per pick visit",
            better=MORE,
        ),
    )

    def footprint(self, run: EndedRun) -> dict[str, Any]:
        """Return the number of visits in which at least one unit or bundle was handled.

        Units, lines, orders and bundles are returned as means per such visit.
        """
        picks = int((run.logs.visits["units"] > 0).sum())
        refills = int((run.logs.visits["bundles"] > 0).sum())
        late_bound = int(run.logs.units_now["late_bound"].sum())
        return {
            "pick_visits": picks,
            "replenishment_visits": refills,
            "units_per_visit": ratio(run.handled("units_picked"), picks),
            "lines_per_visit": ratio(run.handled("lines_picked"), picks),
            "orders_per_visit": ratio(run.handled("orders_completed"), picks),
            "bundles_per_visit": ratio(run.handled("bundles_stored"), refills),
            "late_bound_units_per_visit": ratio(late_bound, picks),
        }

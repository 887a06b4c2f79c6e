"""A measure for studies of congestion: the share of trip time that is delay.

Trips to stations are left out, as in the column `trip_delay_mean_s`, because the time that they
would take without other robots depends on the place in the queue.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from rmfs.measure.base import Measure
from rmfs.measure.columns import LESS, REAL, Column
from rmfs.measure.measures.reckoning import ratio

if TYPE_CHECKING:
    from rmfs.measure.ended import EndedRun


class TripDelay(Measure):
    """The delay of trips as a share of their time."""

    columns = (
        Column(
            "trip_delay_share",
            REAL,
            "share",
            "Sum of hindered_s / total time, over the trips that do not end at stations",
            better=LESS,
        ),
    )

    def footprint(self, run: EndedRun) -> dict[str, Any]:
        """Return the share of trip time that is delay, from the table of trips."""
        trips = run.tables["trips"]
        trips = trips[trips["kind"] != "to_station"]
        lasted_s = (trips["end_s"] - trips["start_s"]).sum()
        return {"trip_delay_share": ratio(trips["hindered_s"].sum(), lasted_s)}

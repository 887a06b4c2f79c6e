"""Times of bundles, and the fill level of pods."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from rmfs.measure.base import Measure
from rmfs.measure.columns import INTEGER, LESS, REAL, Column
from rmfs.measure.measures.reckoning import spread, spread_columns
from rmfs.measure.steps import Steps
from rmfs.measure.tables.series import inventory_share

if TYPE_CHECKING:
    from rmfs.measure.ended import EndedRun


class Replenishment(Measure):
    """Times and backlog of bundles."""

    columns = (
        *spread_columns(
            "bundle_turnover", "the time from the arrival of a bundle until it is stored"
        ),
        *spread_columns(
            "bundle_throughput_time",
            "the time from the assignment of a bundle to a pod and a station until it is stored",
        ),
        Column("bundles_created", INTEGER, "bundles", "Bundles that arrived"),
        Column(
            "backlog_bundles_mean",
            REAL,
            "bundles",
            "Time average of the number of bundles not yet assigned to both a pod and a station",
            better=LESS,
        ),
        Column(
            "backlog_bundles_end",
            INTEGER,
            "bundles",
            "Bundles not yet assigned to both a pod and a station at the end",
            better=LESS,
        ),
    )

    def footprint(self, run: EndedRun) -> dict[str, Any]:
        """Return the number of bundles that arrived, the backlog, and times of stored bundles."""
        stored, bundles = run.logs.stored_now, run.logs.bundles
        waiting = Steps.between(bundles["created_s"], bundles["assigned_s"])
        return {
            **spread("bundle_turnover", stored["time_s"] - stored["created_s"]),
            **spread("bundle_throughput_time", stored["time_s"] - stored["assigned_s"]),
            "bundles_created": int((bundles["created_s"] >= run.start_s).sum()),
            "backlog_bundles_mean": waiting.mean(run.start_s, run.end_s),
            "backlog_bundles_end": int(waiting.at(run.end_s)),
        }


class Inventory(Measure):
    """Fill level of the pods."""

    columns = (
        Column(
            "inventory_share_mean",
            REAL,
            "share",
            "Time average of the fill level: space used by stored units / capacity of all pods",
        ),
    )

    def footprint(self, run: EndedRun) -> dict[str, Any]:
        """Return the time average of the fill level, as a share of the capacity of all pods."""
        return {"inventory_share_mean": inventory_share(run.logs).mean(run.start_s, run.end_s)}

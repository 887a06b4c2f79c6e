"""Utilisation of the stations."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from rmfs.measure.base import Measure
from rmfs.measure.columns import LESS, REAL, Column
from rmfs.measure.measures.reckoning import NOTHING

if TYPE_CHECKING:
    from rmfs.measure.ended import EndedRun

KINDS = ("pick", "replenishment")


class Stations(Measure):
    """Share of time for which stations are idle, and share for which they are switched on."""

    columns = (
        Column(
            "pick_station_idle_share",
            REAL,
            "share",
            "1 - (total time in which pick stations handle units) / (pick stations x duration)",
            better=LESS,
        ),
        Column(
            "replenishment_station_idle_share",
            REAL,
            "share",
            "1 - (total time in which replenishment stations handle bundles) / (replenishment "
            "stations x duration)",
        ),
        Column(
            "pick_station_active_share",
            REAL,
            "share",
            "Share of the measured time in which pick stations are switched on, mean over the "
            "stations",
        ),
        Column(
            "replenishment_station_active_share",
            REAL,
            "share",
            "Share of the measured time in which replenishment stations are switched on, mean "
            "over the stations",
        ),
    )

    def footprint(self, run: EndedRun) -> dict[str, Any]:
        """Return the mean idle and active shares of pick stations and of replenishment stations.

        A station is active while it is switched on. If there are no stations of a kind, the shares
        of this kind are nan.
        """
        stations = run.tables["stations"]
        told: dict[str, float] = {}
        for share in ("idle", "active"):
            means = {kind: own[f"{share}_share"].mean() for kind, own in stations.groupby("kind")}
            told |= {f"{kind}_station_{share}_share": means.get(kind, NOTHING) for kind in KINDS}
        return told

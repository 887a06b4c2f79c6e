"""Breakdown of the turnover times of orders."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from rmfs.measure.base import Measure
from rmfs.measure.columns import LESS, NEITHER, REAL, Column
from rmfs.measure.measures.reckoning import ratio
from rmfs.measure.tables.delays import PARTS, by_order

if TYPE_CHECKING:
    from rmfs.measure.ended import EndedRun

_LESS = (
    *("drive_hindered", "queue", "wait_assignment", "wait_pod", "wait_robot", "wait_plan"),
    "wait_order",
)


class Delays(Measure):
    """The parts into which the turnover time of orders is divided, such as driving and service."""

    columns = tuple(
        Column(
            f"{part}_share",
            REAL,
            "share",
            f"Share of the total turnover time of completed orders: {what}. The time of an order "
            "is the mean of the times of its lines; the time of a line is that of its last unit. "
            "The share is empty if no order was completed",
            better=LESS if part in _LESS else NEITHER,
        )
        for part, what in PARTS.items()
    )

    def footprint(self, run: EndedRun) -> dict[str, Any]:
        """Return the share of each part in the total turnover time of all completed orders."""
        total = by_order(run.tables["delays"]).sum()
        whole = float(total["turnover_s"])
        return {f"{part}_share": ratio(float(total[f"{part}_s"]), whole) for part in PARTS}

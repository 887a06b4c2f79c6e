"""The columns that identify a run: its inputs, seed and times, and the size of its warehouse."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from rmfs.measure.base import Measure
from rmfs.measure.columns import INTEGER, LESS, REAL, TEXT, Column

if TYPE_CHECKING:
    from rmfs.measure.ended import EndedRun


class Heading(Measure):
    """Seed, times, size of the warehouse, and names of layout, scenario and controllers."""

    columns = (
        Column("layout", TEXT, "", "Name of the layout"),
        Column("scenario", TEXT, "", "Name of the scenario"),
        Column(
            "controllers",
            TEXT,
            "",
            "Name of the set of controllers; controllers exchanged interactively during the run "
            "are appended",
        ),
        Column("seed", INTEGER, "", "Seed of all random streams of the run"),
        Column("warmup_s", REAL, "s", "Simulated time before the measured time"),
        Column("duration_s", REAL, "s", "Length of the measured time"),
        Column("tiers", INTEGER, "tiers", "Number of floors"),
        Column("robots", INTEGER, "robots", "Number of robots", better=LESS),
        Column("pods", INTEGER, "pods", "Number of pods", better=LESS),
        Column("pick_stations", INTEGER, "stations", "Number of pick stations", better=LESS),
        Column(
            "replenishment_stations",
            INTEGER,
            "stations",
            "Number of replenishment stations",
            better=LESS,
        ),
        Column("skus", INTEGER, "SKUs", "Number of SKUs in the scenario"),
    )

    def footprint(self, run: EndedRun) -> dict[str, Any]:
        """Return the columns that identify the run."""
        layout = run.layout
        return {
            **dict(zip(("layout", "scenario", "controllers"), run.names, strict=True)),
            "seed": run.seed,
            "warmup_s": run.warmup_s,
            "duration_s": run.duration_s,
            "tiers": len(layout.tiers),
            "robots": layout.robots,
            "pods": layout.pods,
            "pick_stations": len(layout.pick_stations),
            "replenishment_stations": len(layout.replenishment_stations),
            "skus": len(run.world.skus),
        }

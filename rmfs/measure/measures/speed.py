"""Wall time and memory of the simulation."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from rmfs.measure.base import Measure
from rmfs.measure.columns import LESS, MORE, REAL, Column
from rmfs.measure.measures.reckoning import ratio
from rmfs.measure.memory import peak_rss_mb

if TYPE_CHECKING:
    from rmfs.measure.ended import EndedRun


class Speed(Measure):
    """Wall time and memory."""

    columns = (
        Column(
            "wall_s",
            REAL,
            "s",
            "Wall time of the simulation, without loading the inputs",
            measured=True,
            better=LESS,
        ),
        Column(
            "sim_per_wall",
            REAL,
            "s/s",
            "(warmup_s + duration_s) / wall_s",
            measured=True,
            better=MORE,
        ),
        Column(
            "peak_rss_mb",
            REAL,
            "MB",
            "Peak memory of the process",
            measured=True,
            better=LESS,
        ),
    )

    def footprint(self, run: EndedRun) -> dict[str, Any]:
        """Return wall time, simulated seconds per wall second, and this process's peak memory."""
        return {
            "wall_s": run.wall_s,
            "sim_per_wall": ratio(run.end_s, run.wall_s),
            "peak_rss_mb": peak_rss_mb(),
        }

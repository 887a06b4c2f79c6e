"""Measures of disturbances and of motions that started late."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from rmfs.measure.base import Measure
from rmfs.measure.columns import INTEGER, REAL, Column

if TYPE_CHECKING:
    from rmfs.measure.ended import EndedRun


class Disturbances(Measure):
    """Number and duration of disturbances, and motions that started late."""

    columns = (
        Column(
            "disturbances",
            INTEGER,
            "disturbances",
            "Number of breakdowns, periods of slow robots, closures of waypoints, and outages of "
            "chargers and elevators that overlap the measured time",
        ),
        Column(
            "disturbed_s",
            REAL,
            "s",
            "Total duration of the disturbances within the measured time; simultaneous "
            "disturbances are added up",
        ),
        Column(
            "late_motions",
            INTEGER,
            "motions",
            "Motions that started late; 0 unless the scenario makes motions start late",
        ),
        Column("lateness_s", REAL, "s", "Sum of the delays with which late motions started"),
        Column(
            "plans_repaired",
            INTEGER,
            "plans",
            "Plans that were replaced because another robot started a motion late",
        ),
    )

    def footprint(self, run: EndedRun) -> dict[str, Any]:
        """Return numbers and total times of disturbances and of late motions.

        Also return how many plans were repaired after late motions.
        """
        counters = run.recorder.counters
        return {
            "disturbances": int(counters["disturbances"]),
            "disturbed_s": counters["disturbed_s"],
            "late_motions": int(counters["late_motions"]),
            "lateness_s": counters["lateness_s"],
            "plans_repaired": int(counters["repairs"]),
        }

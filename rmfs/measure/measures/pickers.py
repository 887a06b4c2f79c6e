"""Measures of pickers at the pick stations; empty if the scenario has no pickers."""

from __future__ import annotations

from math import nan
from typing import TYPE_CHECKING, Any

from rmfs.measure.base import Measure
from rmfs.measure.columns import COUNT_OR_EMPTY, LESS, REAL, Column
from rmfs.measure.measures.reckoning import ratio

if TYPE_CHECKING:
    from rmfs.measure.ended import EndedRun


class Pickers(Measure):
    """Times, work, fatigue and errors of pickers."""

    columns = (
        Column(
            "pickers_mean",
            REAL,
            "pickers",
            "Time average of the number of pickers present; this column and the following ones "
            "up to face_turns are empty if the scenario has no pickers",
        ),
        Column(
            "pick_time_mean_s",
            REAL,
            "s",
            "Mean time that a picker spends on a unit, rework included",
            better=LESS,
        ),
        Column(
            "pick_time_variation",
            REAL,
            "share",
            "Coefficient of variation of the times that pickers spend on units",
        ),
        Column(
            "picker_busy_share",
            REAL,
            "share",
            "Time for which pickers handle units / time for which they are present",
        ),
        Column(
            "picker_work_variation",
            REAL,
            "share",
            "Coefficient of variation of the busy shares of all pickers who were present; 0 if "
            "the work is balanced",
            better=LESS,
        ),
        Column(
            "picker_fatigue_mean",
            REAL,
            "share",
            "Mean fatigue level of the picker at the start of a pick",
            better=LESS,
        ),
        Column(
            "picker_fatigue_max",
            REAL,
            "share",
            "Highest fatigue level of a picker at the start of a pick",
            better=LESS,
        ),
        Column("pick_errors", COUNT_OR_EMPTY, "units", "Units picked wrongly", better=LESS),
        Column(
            "pick_errors_unnoticed",
            COUNT_OR_EMPTY,
            "units",
            "Wrongly picked units that were not noticed",
            better=LESS,
        ),
        Column(
            "face_turns",
            COUNT_OR_EMPTY,
            "turns",
            "Number of times that a pod was turned at a pick station to show another face",
            better=LESS,
        ),
    )

    def footprint(self, run: EndedRun) -> dict[str, Any]:
        """Return presence, times, fatigue and errors of pickers; None or nan without pickers."""
        if run.recorder.pickers.staff is None:
            return {
                column.name: None if column.dtype == COUNT_OR_EMPTY else nan
                for column in self.columns
            }
        done, people = run.logs.picks_by_hand, run.tables["pickers"]
        there = people[people["present_s"] > 0]
        mean_s, share = done["handling_s"].mean(), there["busy_share"]
        return {
            "pickers_mean": ratio(people["present_s"].sum(), run.logs.duration_s),
            "pick_time_mean_s": mean_s,
            "pick_time_variation": ratio(done["handling_s"].std(ddof=0), mean_s),
            "picker_busy_share": ratio(people["work_s"].sum(), people["present_s"].sum()),
            "picker_work_variation": ratio(share.std(ddof=0), share.mean()),
            "picker_fatigue_mean": done["fatigue"].mean(),
            "picker_fatigue_max": done["fatigue"].max(),
            "pick_errors": int(done["error"].sum()),
            "pick_errors_unnoticed": int((done["error"] & ~done["noticed"]).sum()),
            "face_turns": int(done["turned"].sum()),
        }

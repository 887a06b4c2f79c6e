"""Measures of path planning, and of the safety of the paths."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from rmfs.measure.base import Measure
from rmfs.measure.columns import COUNT_OR_EMPTY, INTEGER, LESS, REAL, Column

if TYPE_CHECKING:
    from rmfs.measure.ended import EndedRun


class Planning(Measure):
    """Plans, failed searches, search effort and times of path planning."""

    columns = (
        Column("plans", INTEGER, "plans", "Trips for which a path was planned"),
        Column("plan_failures", INTEGER, "plans", "Searches that found no path", better=LESS),
        Column(
            "replans",
            INTEGER,
            "plans",
            "Number of times that a path was replaced before the robot had completed it",
        ),
        Column(
            "expansions",
            INTEGER,
            "labels",
            "Labels (partial routes) expanded in searches for routes",
        ),
        Column(
            "planning_charged_s",
            REAL,
            "s",
            "Simulated time for which path planners were busy; 0 if planning takes no simulated "
            "time",
            better=LESS,
        ),
        Column(
            "plan_wait_s",
            REAL,
            "s",
            "Total time for which robots stood because their plans were not ready (also counted in "
            "robot_waiting_share); 0 if planning takes no simulated time",
            better=LESS,
        ),
        Column(
            "planning_wall_s",
            REAL,
            "s",
            "Wall time spent in path planning",
            measured=True,
            better=LESS,
        ),
    )

    def footprint(self, run: EndedRun) -> dict[str, Any]:
        """Return counts of plans, failures, replans and expanded labels, and times of planning."""
        counters = run.recorder.counters
        names = ("plans", "plan_failures", "replans", "expansions")
        return {
            **{name: int(counters[name]) for name in names},
            "planning_charged_s": counters["planning_charged_s"],
            "plan_wait_s": float(run.recorder.motion["awaiting_plan_s"].sum()),
            "planning_wall_s": counters["planning_s"],
        }


class Safety(Measure):
    """Collisions found by the independent trace checker."""

    columns = (
        Column(
            "collisions",
            COUNT_OR_EMPTY,
            "events",
            "Overlaps of two robots, or of a carried and a stored pod, found by the independent "
            "trace checker, warm-up included; empty if the trace was not checked",
            better=LESS,
        ),
    )

    def footprint(self, run: EndedRun) -> dict[str, Any]:
        """Return the number of collisions; None if the trace was not checked.

        A collision is an overlap of two robots, or of a carried and a stored pod.
        """
        return {"collisions": None if run.report is None else run.report.collisions}

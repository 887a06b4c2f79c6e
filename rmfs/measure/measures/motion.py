"""Distances and trips of robots, and how their time is divided among states."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from rmfs.measure.base import Measure
from rmfs.measure.columns import INTEGER, LESS, REAL, Column
from rmfs.measure.measures.reckoning import ratio
from rmfs.measure.recorder import TASKS
from rmfs.measure.tables.robots import STATES

if TYPE_CHECKING:
    from rmfs.measure.ended import EndedRun

BUSY = ("pick", "replenish", "park", "reposition")
"""The tasks in which a robot counts as busy."""


class Motion(Measure):
    """Distances, trips and lifts of the robots."""

    columns = (
        Column("distance_m", REAL, "m", "Distance driven by all robots", better=LESS),
        Column("distance_per_robot_m", REAL, "m", "distance_m / robots", better=LESS),
        Column("distance_per_unit_m", REAL, "m", "distance_m / units_picked", better=LESS),
        Column(
            "loaded_distance_m",
            REAL,
            "m",
            "Distance driven by robots that carry a pod",
            better=LESS,
        ),
        Column(
            "trips",
            INTEGER,
            "trips",
            "Completed trips to pods, stations, storage locations and resting places",
        ),
        Column(
            "trip_time_mean_s",
            REAL,
            "s",
            "Mean duration of a trip; a trip to a station counts until the robot enters the "
            "queue zone",
            better=LESS,
        ),
        Column(
            "trip_delay_mean_s",
            REAL,
            "s",
            "Mean delay of trips: duration minus a lower bound on the duration without other "
            "robots; trips to stations are excluded, because their bound depends on the place in "
            "the queue",
            better=LESS,
        ),
        Column("pods_lifted", INTEGER, "lifts", "Number of times that a pod was lifted"),
    )

    def footprint(self, run: EndedRun) -> dict[str, Any]:
        """Return distances driven, numbers of trips and lifts, and mean time and delay of trips."""
        motion, trips = run.recorder.motion, run.tables["trips"]
        lasted = trips["end_s"] - trips["start_s"]
        delay = (lasted - trips["unhindered_s"])[trips["kind"] != "to_station"]
        distance_m = float(motion["distance_m"].sum())
        return {
            "distance_m": distance_m,
            "distance_per_robot_m": ratio(distance_m, run.layout.robots),
            "distance_per_unit_m": ratio(distance_m, run.handled("units_picked")),
            "loaded_distance_m": float(motion["loaded_distance_m"].sum()),
            "trips": len(trips),
            "trip_time_mean_s": lasted.mean(),
            "trip_delay_mean_s": delay.mean(),
            "pods_lifted": len(run.logs.lifts_now),
        }


class RobotTime(Measure):
    """Shares of the robots' time by state, and number of tasks of each kind."""

    columns = (
        Column(
            "robot_busy_share",
            REAL,
            "share",
            "Share of robot time in which robots have a pick, replenish, park or reposition task",
        ),
        Column("robot_moving_share", REAL, "share", "Share of robot time spent driving"),
        Column(
            "robot_queueing_share",
            REAL,
            "share",
            "Share of robot time from entering the queue zone of a station to reaching the "
            "station; overlaps with the other shares",
            better=LESS,
        ),
        Column(
            "robot_waiting_share",
            REAL,
            "share",
            "Share of robot time spent standing during a trip or in a queue",
            better=LESS,
        ),
        Column(
            "robot_turning_share", REAL, "share", "Share of robot time spent turning on the spot"
        ),
        Column(
            "robot_served_share", REAL, "share", "Share of robot time spent standing at a station"
        ),
        Column(
            "robot_transfer_share",
            REAL,
            "share",
            "Share of robot time spent lifting or setting down a pod",
        ),
        Column("robot_riding_share", REAL, "share", "Share of robot time spent in an elevator"),
        Column("robot_idle_share", REAL, "share", "Share of robot time spent standing idle"),
        *(
            Column(f"tasks_{task}", INTEGER, "tasks", f"Number of {task} tasks started")
            for task in TASKS
        ),
    )

    def footprint(self, run: EndedRun) -> dict[str, Any]:
        """Return the busy share, the share of time in each state, and the numbers of tasks started.

        A robot is busy while it has a task of one of the kinds in `BUSY`. The tasks are counted by
        kind.
        """
        robots = run.tables["robots"]
        robot_time = run.layout.robots * run.logs.duration_s
        busy = sum(robots[f"task_{task}_s"].sum() for task in BUSY)
        return {
            "robot_busy_share": ratio(busy, robot_time),
            **{f"robot_{one}_share": ratio(robots[f"{one}_s"].sum(), robot_time) for one in STATES},
            **{f"tasks_{task}": int(robots[f"tasks_{task}"].sum()) for task in TASKS},
        }

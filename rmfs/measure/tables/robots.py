"""The table of robots, and the number of robots with a given kind of task over time."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from rmfs.measure.columns import INTEGER, REAL, Column
from rmfs.measure.energy import WH
from rmfs.measure.recorder import TASKS
from rmfs.measure.steps import Steps
from rmfs.measure.tables.logs import count
from rmfs.measure.tables.tidy import tidy

if TYPE_CHECKING:
    import pandas as pd

    from rmfs.measure.tables.logs import Logs

STATES = ("moving", "turning", "waiting", "served", "transfer", "riding", "idle", "queueing")


ROBOTS = (
    Column("robot", INTEGER, "", "Robot"),
    Column("kind", INTEGER, "", "Number of the robot's kind in the layout"),
    Column("distance_m", REAL, "m", "Distance driven"),
    Column("loaded_distance_m", REAL, "m", "Distance driven with a pod"),
    *(
        Column(f"{state}_s", REAL, "s", f"Time {what}")
        for state, what in {
            "moving": "driving",
            "turning": "turning on the spot",
            "waiting": "standing during a trip or in a queue",
            "served": "standing at a station",
            "transfer": "lifting or setting down",
            "riding": "in an elevator",
            "idle": "standing idle",
            "queueing": "from entering a queue zone to reaching its station (overlaps with the "
            "columns above)",
        }.items()
    ),
    Column(
        "awaiting_plan_s",
        REAL,
        "s",
        "Time standing because the robot's plan was not ready (part of waiting_s)",
    ),
    *(
        column
        for task in ("pick", "replenish", "park", "reposition", "rest")
        for column in (
            Column(f"tasks_{task}", INTEGER, "tasks", f"Number of {task} tasks started"),
            Column(f"task_{task}_s", REAL, "s", f"Time with a {task} task"),
        )
    ),
    Column("pods_lifted", INTEGER, "lifts", "Number of times that the robot lifted a pod"),
    Column("units_picked", INTEGER, "units", "Units picked from pods that the robot brought"),
    Column("bundles_stored", INTEGER, "bundles", "Bundles stored in pods that the robot brought"),
    *(
        Column(name, REAL, unit, f"{meaning}; empty if energy is not modelled")
        for name, unit, meaning in (
            ("energy_wh", "Wh", "Energy drawn, less recovered braking energy"),
            ("charged_wh", "Wh", "Energy charged, including by battery swaps"),
            (
                "charging_s",
                "s",
                "Time charging at chargers or at waypoints with inductive charging",
            ),
        )
    ),
    Column("level_wh", REAL, "Wh", "Energy in the battery at the end; empty without batteries"),
)


_ENERGY = (
    ("energy_wh", "used_j", WH),
    ("charged_wh", "charged_j", WH),
    ("charging_s", "charging_s", 1.0),
    ("level_wh", "level_j", WH),
)


def robots(logs: Logs) -> pd.DataFrame:
    """Return one row per robot: distances, times and counts in the measured time."""
    number, motion = logs.layout.robots, logs.recorder.motion
    columns: dict[str, Any] = {
        "robot": np.arange(number),
        "kind": np.asarray(logs.layout.robot_kind),
        "distance_m": motion["distance_m"],
        "loaded_distance_m": motion["loaded_distance_m"],
        **{f"{state}_s": motion[f"{state}_s"] for state in STATES},
        "awaiting_plan_s": motion["awaiting_plan_s"],
    }
    tasks = logs.tasks
    measured = (tasks["end_s"] - tasks["begin_s"].clip(lower=logs.start_s)).clip(lower=0.0)
    begun = tasks["begin_s"].to_numpy() >= logs.start_s
    for kind, task in enumerate(TASKS):
        own = tasks["kind"].to_numpy() == kind
        robot, time = tasks["robot"].to_numpy()[own], measured.to_numpy()[own]
        columns[f"tasks_{task}"] = count(tasks["robot"][own & begun], number)
        columns[f"task_{task}_s"] = np.bincount(robot, weights=time, minlength=number)
    columns["pods_lifted"] = count(logs.lifts_now["robot"], number)
    columns["units_picked"] = count(logs.units_now["robot"], number)
    columns["bundles_stored"] = count(logs.stored_now["robot"], number)
    energy = logs.recorder.energy.final
    for name, counted, divisor in _ENERGY:
        columns[name] = energy[counted] / divisor if energy else np.nan
    return tidy("robots", ROBOTS, columns)


def with_task(logs: Logs, task: str) -> Steps:
    """Return how many robots have a given kind of task, as a function of time from time zero on."""
    tasks = logs.tasks
    # a task under way at the end of the run still counts then; one that has just ended does not
    ends = tasks["end_s"].where(tasks["robot"].duplicated(keep="last"))
    own = tasks["kind"].to_numpy() == TASKS.index(task)
    return Steps.between(tasks["begin_s"][own], ends[own])

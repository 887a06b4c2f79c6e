"""The table of robots, and their tasks over time."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from rmfs.measure.steps import Steps
from rmfs.measure.tables import logs
from rmfs.measure.tables.tidy import log, tidy

if TYPE_CHECKING:
    import pandas as pd

    from rmfs.measure.recorder import Recorder

TASKS = ("pick", "replenish", "park", "reposition", "rest")
STATES = ("moving", "turning", "waiting", "served", "transfer", "riding", "idle", "queueing")


def robots(recorder: Recorder) -> pd.DataFrame:
    """One row per robot."""
    layout = recorder.layout
    every = np.arange(layout.robots)
    columns = {
        "robot": every,
        "kind": np.asarray(layout.robot_kind),
        "distance_m": recorder.motion["distance_m"],
        "loaded_distance_m": recorder.motion["loaded_distance_m"],
        **{f"{state}_s": recorder.motion[f"{state}_s"] for state in STATES},
    }
    stays = task_stays(recorder)
    started = logs.measured(recorder, stays, "began_s")
    clipped = stays["end_s"] - stays["begin_s"].clip(lower=recorder.start_s)
    for task in TASKS:
        own = stays["kind"] == task
        columns[f"tasks_{task}"] = _count(started["robot"][started["kind"] == task], len(every))
        columns[f"task_{task}_s"] = np.bincount(
            stays["robot"][own].to_numpy(np.int64),
            weights=clipped[own].clip(lower=0.0).to_numpy(np.float64),
            minlength=len(every),
        )
    lifts = logs.measured(recorder, log(recorder.lifts, "time_s", "pod", "robot"))
    units = logs.measured(recorder, logs.units(recorder))
    bundles = logs.measured(recorder, logs.stored(recorder))
    columns["pods_lifted"] = _count(lifts["robot"], len(every))
    columns["units_picked"] = _count(units["robot"], len(every))
    columns["bundles_stored"] = _count(bundles["robot"], len(every))
    return tidy("robots", columns)


def task_stays(recorder: Recorder) -> pd.DataFrame:
    """From when to when each robot had each task; a task lasts until the next one starts."""
    frame = log(recorder.tasks, "begin_s", "robot", "kind")
    frame = frame.sort_values(["robot", "begin_s"], kind="stable", ignore_index=True)
    following = frame.groupby("robot")["begin_s"].shift(-1)
    return frame.assign(began_s=frame["begin_s"], end_s=following.fillna(recorder.end_s))


def with_task(recorder: Recorder, task: str) -> Steps:
    """Return the number of robots with a task over time."""
    stays = task_stays(recorder)
    own = stays[stays["kind"] == task]
    # a task that reaches the end of the run is still held there
    ends = own["end_s"].mask(own["end_s"] >= recorder.end_s)
    return Steps.between(own["begin_s"].to_numpy(float), ends.to_numpy(float))


def _count(robot: pd.Series, robots: int) -> np.ndarray[tuple[int], np.dtype[np.int64]]:
    return np.bincount(robot.to_numpy(np.int64), minlength=robots)

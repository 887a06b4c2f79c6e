"""The tables of decisions and controllers."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from rmfs.measure.tables.tidy import tidy

if TYPE_CHECKING:
    import pandas as pd

    from rmfs.measure.tables.logs import Logs


def decisions(logs: Logs) -> pd.DataFrame:
    """One row per call of a controller that came to a decision."""
    calls = logs.recorder.calls
    time_s = np.array(calls.time_s)
    now = time_s >= logs.start_s
    names = np.array([*calls.number, ""])
    return tidy(
        "decisions",
        {
            "time_s": time_s[now],
            "problem": names[np.array(calls.problem)[now]],
            "decisions": np.array(calls.decisions)[now],
            "wall_s": np.array(calls.wall_s)[now],
        },
    )


def controllers(logs: Logs) -> pd.DataFrame:
    """One row per decision problem whose controller was asked in the measured time."""
    asked = dict(sorted(logs.recorder.asked.items()))
    calls = np.array([number for number, _ in asked.values()])
    wall_s = np.array([wall for _, wall in asked.values()])
    recorded = logs.recorder.calls
    now = np.array(recorded.time_s) >= logs.start_s
    number = np.array(recorded.problem)[now]
    given = np.bincount(number, weights=np.array(recorded.decisions)[now], minlength=127)
    return tidy(
        "controllers",
        {
            "problem": list(asked),
            "calls": calls,
            "decisions": [given[recorded.number.get(problem, -1)] for problem in asked],
            "wall_s": wall_s,
            "wall_mean_s": wall_s / calls,
        },
    )

"""The table of decisions."""

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

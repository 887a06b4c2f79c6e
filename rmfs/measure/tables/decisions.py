"""The table of decisions."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rmfs.measure.tables import logs
from rmfs.measure.tables.tidy import log, tidy

if TYPE_CHECKING:
    import pandas as pd

    from rmfs.measure.recorder import Recorder


def decisions(recorder: Recorder) -> pd.DataFrame:
    """One row per call of a controller that decided something or took time."""
    frame = log(recorder.decisions, "time_s", "problem", "decisions", "wall_s")
    return tidy("decisions", logs.measured(recorder, frame).reset_index(drop=True))

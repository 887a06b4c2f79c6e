"""The tables of what was handled at stations: picks, bundles and visits."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rmfs.measure.tables.tidy import tidy

if TYPE_CHECKING:
    import pandas as pd

    from rmfs.measure.tables.logs import Logs


def picks(logs: Logs) -> pd.DataFrame:
    """One row per unit picked in the measured time."""
    return tidy("picks", logs.units_now.reset_index(drop=True))


def bundles(logs: Logs) -> pd.DataFrame:
    """Every bundle that was waiting or stored during the measured time, by arrival."""
    frame = logs.bundles.rename(columns={"time_s": "stored_s"})
    frame = frame[~(frame["stored_s"] < logs.start_s)]
    frame = frame.sort_values("created_s", kind="stable", ignore_index=True)
    frame["turnover_s"] = frame["stored_s"] - frame["created_s"]
    frame["throughput_time_s"] = frame["stored_s"] - frame["assigned_s"]
    return tidy("bundles", frame)


def visits(logs: Logs) -> pd.DataFrame:
    """One row per stay of a pod at a station that had not ended before the measured time."""
    frame = logs.visits
    return tidy("visits", frame[~(frame["end_s"] < logs.start_s)].reset_index(drop=True))

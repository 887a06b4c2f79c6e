"""The table of orders."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rmfs.measure.tables.tidy import tidy

if TYPE_CHECKING:
    import pandas as pd

    from rmfs.measure.tables.logs import Logs


def orders(logs: Logs) -> pd.DataFrame:
    """Every order that was waiting, open or completed during the measured time."""
    frame = logs.orders
    frame = frame[~(frame["completed_s"] < logs.start_s)].reset_index(drop=True)
    frame["turnover_s"] = frame["completed_s"] - frame["created_s"]
    frame["throughput_time_s"] = frame["completed_s"] - frame["assigned_s"]
    frame["lateness_s"] = frame["completed_s"] - frame["due_s"]
    return tidy("orders", frame)


def completed(frame: pd.DataFrame) -> pd.DataFrame:
    """Keep the completed orders."""
    return frame[frame["completed_s"].notna()]

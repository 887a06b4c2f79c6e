"""The table of orders."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from rmfs.measure.tables.tidy import tidy

if TYPE_CHECKING:
    import pandas as pd
    from numpy.typing import NDArray

    from rmfs.measure.tables.logs import Logs


def orders(logs: Logs) -> pd.DataFrame:
    """Every order that was waiting, open or completed during the measured time."""
    frame = logs.orders
    frame = frame[~(frame["completed_s"] < logs.start_s)].reset_index(drop=True)
    frame["turnover_s"] = frame["completed_s"] - frame["created_s"]
    frame["throughput_time_s"] = frame["completed_s"] - frame["assigned_s"]
    frame["lateness_s"] = frame["completed_s"] - frame["due_s"]
    frame["pods"] = _pods(logs, frame["order"])
    return tidy("orders", frame)


def _pods(logs: Logs, order: pd.Series[int]) -> NDArray[np.int64]:
    """Return from how many pods units were picked for each order."""
    pods = logs.layout.pods
    both = np.unique(logs.units["order"].to_numpy() * pods + logs.units["pod"].to_numpy())
    number = np.bincount(both // pods, minlength=int(order.max()) + 1 if len(order) else 0)
    return number[order.to_numpy()]


def completed(frame: pd.DataFrame) -> pd.DataFrame:
    """Keep the completed orders."""
    return frame[frame["completed_s"].notna()]

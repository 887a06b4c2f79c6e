"""The recorder's lists as frames; `measured` leaves out what happened during the warm-up."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pandas as pd

from rmfs.measure.recorder import bundle_row, order_row
from rmfs.measure.tables.tidy import log

if TYPE_CHECKING:
    from rmfs.measure.recorder import Recorder

ORDER = ("order", "station", "lines", "units", "created_s", "due_s", "assigned_s", "completed_s")
BUNDLE = ("time_s", "created_s", "assigned_s", "sku", "units", "space", "pod", "station")


def measured(recorder: Recorder, frame: pd.DataFrame, time: str = "time_s") -> pd.DataFrame:
    """Keep the rows from the measured time."""
    return frame[frame[time] >= recorder.start_s]


def units(recorder: Recorder) -> pd.DataFrame:
    """All units picked."""
    return log(recorder.units, "time_s", "sku", "pod", "robot", "station", "late_bound").astype(
        {"late_bound": bool}
    )


def lines(recorder: Recorder) -> pd.DataFrame:
    """All lines finished."""
    return log(recorder.lines, "time_s", "sku", "station")


def orders(recorder: Recorder) -> pd.DataFrame:
    """All orders that ever arrived, by ordinal."""
    rows = [*recorder.finished_orders, *map(order_row, recorder.open_orders.values())]
    return log(rows, *ORDER).sort_values("order", ignore_index=True)


def stored(recorder: Recorder) -> pd.DataFrame:
    """All bundles stored."""
    return log(recorder.stored_bundles, *BUNDLE, "robot")


def bundles(recorder: Recorder) -> pd.DataFrame:
    """All bundles that ever arrived, stored or not."""
    waiting = log([bundle_row(bundle) for bundle in recorder.open_bundles.values()], *BUNDLE)
    done = stored(recorder).drop(columns="robot")
    return pd.concat([part for part in (done, waiting) if len(part)] or [done], ignore_index=True)


def visits(recorder: Recorder) -> pd.DataFrame:
    """Stays of pods at stations, with what was handled during the measured time.

    Each unit or bundle belongs to the last visit to its station that began before it.
    """
    frame = log(recorder.visits, "station", "pod", "robot", "begin_s", "end_s")
    frame = frame.sort_values(["station", "begin_s"], ignore_index=True)
    for name, handled in (("units", units(recorder)), ("bundles", stored(recorder))):
        now = measured(recorder, handled)
        which = _visit_of(frame, now["station"].to_numpy(int), now["time_s"].to_numpy(float))
        frame[name] = np.bincount(which, minlength=len(frame))
    return frame


def _visit_of(
    visits: pd.DataFrame,
    station: np.ndarray[tuple[int], np.dtype[np.int64]],
    time_s: np.ndarray[tuple[int], np.dtype[np.float64]],
) -> np.ndarray[tuple[int], np.dtype[np.int64]]:
    """Return the visit during which something was handled at a station and time."""
    found = np.zeros(len(station), np.int64)
    for one in np.unique(station):
        rows = np.flatnonzero(visits["station"].to_numpy() == one)
        begins = visits["begin_s"].to_numpy(float)[rows]
        here = station == one
        found[here] = rows[np.searchsorted(begins, time_s[here], side="right") - 1]
    return found

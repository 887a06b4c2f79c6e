"""The recorder's logs as data frames, each made once and shared by all tables of a run."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from rmfs.measure.recorder import bundle_row, order_row

if TYPE_CHECKING:
    from collections.abc import Sequence

    import pandas as pd
    from numpy.typing import NDArray

    from rmfs.measure.log import Log
    from rmfs.measure.recorder import Recorder


class Logs:
    """The recorded data of a run, as data frames.

    `picks_by_hand` and the frames whose names end in `_now` cover only the measured time. The
    others also cover the warm-up, because work that starts in the warm-up may end in the measured
    time.
    """

    def __init__(self, recorder: Recorder) -> None:
        self.recorder = recorder
        self.layout = recorder.layout
        self.world = recorder.world
        self.start_s = recorder.start_s
        self.end_s = recorder.end_s
        self.duration_s = recorder.duration_s

    @cached_property
    def units(self) -> pd.DataFrame:
        """Units picked."""
        return framed(self.recorder.units)

    @cached_property
    def units_now(self) -> pd.DataFrame:
        """Units picked in the measured time."""
        return self._since(self.units)

    @cached_property
    def picks_by_hand(self) -> pd.DataFrame:
        """Handling of each unit in `units_now` by its picker; empty if pickers are not modelled."""
        told = framed(self.recorder.pickers.units)
        return told.iloc[len(self.units) - len(self.units_now) :].reset_index(drop=True)

    @cached_property
    def lines(self) -> pd.DataFrame:
        """Order lines finished."""
        return framed(self.recorder.lines)

    @cached_property
    def lines_now(self) -> pd.DataFrame:
        """Order lines finished in the measured time."""
        return self._since(self.lines)

    @cached_property
    def orders(self) -> pd.DataFrame:
        """All orders that arrived, in order of arrival."""
        waiting = [order_row(order) for order in self.recorder.open_orders.values()]
        return framed(self.recorder.orders, waiting).sort_values("order", ignore_index=True)

    @cached_property
    def slots(self) -> pd.DataFrame:
        """Periods in which an order, or a part of one, was assigned to a pick station."""
        return framed(self.recorder.slots)

    @cached_property
    def stored(self) -> pd.DataFrame:
        """Bundles stored."""
        return framed(self.recorder.bundles)

    @cached_property
    def stored_now(self) -> pd.DataFrame:
        """Bundles stored in the measured time."""
        return self._since(self.stored)

    @cached_property
    def bundles(self) -> pd.DataFrame:
        """All bundles that arrived; those not stored yet have no time of storage and no robot."""
        waiting = [(*bundle_row(bundle), -1) for bundle in self.recorder.open_bundles.values()]
        return framed(self.recorder.bundles, waiting)

    @cached_property
    def busy(self) -> pd.DataFrame:
        """Periods in which stations were busy, sorted by station and start."""
        frame = framed(self.recorder.busy)
        return frame.sort_values(["station", "begin_s"], ignore_index=True)

    @cached_property
    def lifts(self) -> pd.DataFrame:
        """Pods lifted."""
        return framed(self.recorder.lifts)

    @cached_property
    def lifts_now(self) -> pd.DataFrame:
        """Pods lifted in the measured time."""
        return self._since(self.lifts)

    @cached_property
    def all_trips(self) -> dict[str, NDArray[Any]]:
        """Columns of all trips that ended, in the warm-up or later: robot, kind, and times in s."""
        parts = [one for one in (self.recorder.early_trips, self.recorder.trips) if one]
        whole = {name: np.concatenate([part[name] for part in parts]) for name in parts[0]}
        return {
            "robot": whole["robot"],
            "kind": whole["kind"],
            "start_s": whole["t0_us"] / 1e6,
            "end_s": whole["t1_us"] / 1e6,
            "unhindered_s": whole["unhindered_s"],
            "awaited_s": whole["awaited_s"],
        }

    @cached_property
    def switches(self) -> pd.DataFrame:
        """Events of switching a station on or off."""
        return framed(self.recorder.switches)

    @cached_property
    def tasks(self) -> pd.DataFrame:
        """Start and end of each task of each robot; a task lasts until the next one starts."""
        frame = framed(self.recorder.tasks)
        frame = frame.sort_values(["robot", "begin_s"], kind="stable", ignore_index=True)
        robot, begin = frame["robot"].to_numpy(), frame["begin_s"].to_numpy()
        end = np.full(len(frame), self.end_s)
        follows = robot[1:] == robot[:-1]
        end[:-1][follows] = begin[1:][follows]
        return frame.assign(end_s=end)

    @cached_property
    def visits(self) -> pd.DataFrame:
        """Visits to stations, with the numbers of units and bundles handled in the measured time.

        The columns of these numbers are `units` and `bundles`. Each unit or bundle is attributed to
        the latest visit to its station that began before the handling.
        """
        frame = framed(self.recorder.visits)
        frame = frame.sort_values(["station", "begin_s"], ignore_index=True)
        for name, handled in (("units", self.units_now), ("bundles", self.stored_now)):
            which = _visit_of(frame, handled["station"].to_numpy(), handled["time_s"].to_numpy())
            frame[name] = np.bincount(which, minlength=len(frame))
        return frame

    def _since(self, frame: pd.DataFrame) -> pd.DataFrame:
        """Return the rows of a frame whose time is in the measured time."""
        return frame[frame["time_s"].to_numpy() >= self.start_s]


def framed(log: Log, more: Sequence[tuple[Any, ...]] = ()) -> pd.DataFrame:
    """Return a log as a data frame, with the rows `more` (with the same columns) appended."""
    import pandas as pd

    columns = log.columns()
    if more:
        added = zip(columns.items(), zip(*more, strict=True), strict=True)
        columns = {name: np.append(column, values) for (name, column), values in added}
    return pd.DataFrame(columns, copy=False)


def count(index: pd.Series[int], length: int) -> NDArray[np.int64]:
    """Return how often each number from 0 to `length` - 1 occurs in `index`; shape (length,)."""
    return np.bincount(index.to_numpy(), minlength=length)


def _visit_of(
    visits: pd.DataFrame, station: NDArray[np.int64], time_s: NDArray[np.float64]
) -> NDArray[np.int64]:
    """Return, for each station and time, the row of the visit that had begun last."""
    found = np.zeros(len(station), np.int64)
    for one in np.unique(station):
        rows = np.flatnonzero(visits["station"].to_numpy() == one)
        begins = visits["begin_s"].to_numpy()[rows]
        here = station == one
        found[here] = rows[np.searchsorted(begins, time_s[here], side="right") - 1]
    return found

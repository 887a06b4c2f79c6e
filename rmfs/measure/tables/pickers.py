"""The table of pickers; empty if the scenario has none."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from rmfs.measure.columns import INTEGER, REAL, Column
from rmfs.measure.steps import covered
from rmfs.measure.tables.logs import count, framed
from rmfs.measure.tables.tidy import tidy

if TYPE_CHECKING:
    import pandas as pd
    from numpy.typing import NDArray

    from rmfs.measure.tables.logs import Logs

PICKERS = (
    Column("picker", INTEGER, "", "Number of the picker; pickers of the first shift come first"),
    Column("shift", INTEGER, "", "Number of the shift"),
    Column("station", INTEGER, "", "Pick station"),
    Column(
        "speed",
        REAL,
        "share",
        "Relative speed; a picker with speed 1 needs the handling time of the station",
    ),
    Column("present_s", REAL, "s", "Time for which the picker was at the station"),
    Column("work_s", REAL, "s", "Part of present_s spent on units"),
    Column(
        "busy_share", REAL, "share", "work_s / present_s; empty for pickers who were never present"
    ),
    Column("units_picked", INTEGER, "units", "Units picked"),
    Column(
        "unit_mean_s",
        REAL,
        "s",
        "Mean time spent on a unit, rework included; empty if no unit was picked",
    ),
    Column(
        "fatigue_mean",
        REAL,
        "share",
        "Mean fatigue level at the start of a pick; empty if no unit was picked",
    ),
    Column(
        "fatigue_max",
        REAL,
        "share",
        "Highest fatigue level at the start of a pick; 0 if no unit was picked",
    ),
    Column("errors", INTEGER, "units", "Units picked wrongly"),
    Column("errors_unnoticed", INTEGER, "units", "Wrongly picked units that were not noticed"),
)


def pickers(logs: Logs) -> pd.DataFrame:
    """Return one row per picker: presence, work and errors in the measured time."""
    staff = logs.recorder.pickers.staff
    people = [] if staff is None else staff.pickers
    number = len(people)
    done = logs.picks_by_hand
    units = count(done["picker"], number)
    present_s, work_s = _present_s(logs, number), _work_s(logs, number)
    return tidy(
        "pickers",
        PICKERS,
        {
            "picker": np.arange(number),
            "shift": [one.shift for one in people],
            "station": [one.home for one in people],
            "speed": [one.speed for one in people],
            "present_s": present_s,
            "work_s": work_s,
            "busy_share": _ratio(work_s, present_s),
            "units_picked": units,
            "unit_mean_s": _ratio(_sums(done, "handling_s", number), units),
            "fatigue_mean": _ratio(_sums(done, "fatigue", number), units),
            "fatigue_max": [
                done["fatigue"].to_numpy()[done["picker"].to_numpy() == one].max(initial=0.0)
                for one in range(number)
            ],
            "errors": count(done["picker"][done["error"]], number),
            "errors_unnoticed": count(done["picker"][done["error"] & ~done["noticed"]], number),
        },
    )


def _present_s(logs: Logs, number: int) -> NDArray[np.float64]:
    frame = framed(logs.recorder.pickers.presence)
    return _within(logs, frame["picker"], frame["begin_s"], frame["end_s"], number)


def _work_s(logs: Logs, number: int) -> NDArray[np.float64]:
    how, begin = framed(logs.recorder.pickers.units), logs.units["time_s"]
    if not number:
        return np.zeros(0)
    return _within(logs, how["picker"], begin, begin + how["handling_s"], number)


def _within(
    logs: Logs,
    picker: pd.Series[int],
    begin_s: pd.Series[float],
    end_s: pd.Series[float],
    number: int,
) -> NDArray[np.float64]:
    """Return each picker's total time in the given periods, within the measured time, in s."""
    edges = np.array([logs.start_s, logs.end_s])
    who, begin, end = picker.to_numpy(), begin_s.to_numpy(), end_s.to_numpy()
    return np.array(
        [np.diff(covered(begin[who == p], end[who == p], edges))[0] for p in range(number)]
    ).reshape(number)


def _sums(done: pd.DataFrame, column: str, number: int) -> NDArray[np.float64]:
    weights = done[column].to_numpy(np.float64)
    return np.bincount(done["picker"].to_numpy(), weights, minlength=number).astype(np.float64)


def _ratio(amount: NDArray[np.float64], by: NDArray[np.generic]) -> NDArray[np.float64]:
    result = np.full(len(amount), np.nan)
    np.divide(amount, by, out=result, where=by > 0)  # type: ignore[operator]
    return result

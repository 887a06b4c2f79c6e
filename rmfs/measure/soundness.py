"""Validates traces that were read from files.

A trace file may have been written or edited by anyone. The functions of this module raise an error
with a one-line message if a column has the wrong type, a value refers to something that does not
exist (such as a robot), or a time or another value is impossible. They do not verify that the
motion is safe; this is the task of the checker.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from rmfs.errors import InputError
from rmfs.measure.events import KINDS

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence
    from pathlib import Path

    import pandas as pd
    from numpy.typing import NDArray

    from rmfs.layout.model import Layout

KINDS_OF_MOTION = 7
AFTER_US = 86_400_000_000
"""Margin after the end of a run (us), in which robots complete trips; none takes a day."""
LARGEST_SPEED_M_S = 1000.0
LARGEST_ANGLE_RAD = 100.0
"""Largest absolute value of a heading, in rad: about 16 full turns."""


REALS = ("heading0_rad", "heading1_rad", "top_speed_m_s")
WORDS = ("kind", "detail")
"""Columns that contain words in events; in a trace, `kind` is a number."""


def require_columns(path: Path, table: Any, names: Sequence[str]) -> None:
    """Make sure that columns have the right types and, except `detail`, no missing values.

    Parameters
    ----------
    path
        The file, for messages.
    table
        An Arrow table.
    names
        Names of the columns to validate. The table must contain all of them.

    Raises
    ------
    InputError
        If a column is invalid; the message names the first invalid one.
    """
    from pyarrow import types  # type: ignore[import-untyped]

    for name in names:
        held = table.schema.field(name).type
        if name in REALS:
            what, right = "numbers", types.is_floating(held)
        elif name in WORDS and "detail" in names:
            # a column of words without any entries is written as a null column
            plain = held.value_type if types.is_dictionary(held) else held
            tests = (types.is_string, types.is_large_string, types.is_null)
            what, right = "words", any(test(plain) for test in tests)
        else:
            what, right = "whole numbers", types.is_integer(held)
        if not right:
            raise InputError(f"{path}: column {name} must hold {what} (given: {held})")
        if name != "detail" and table[name].null_count:
            raise InputError(f"{path}: column {name}: a value is missing")


def require_motion(path: Path, motion: pd.DataFrame, layout: Layout, end_us: int) -> None:
    """Make sure that the motion in a trace is possible in the layout.

    Parameters
    ----------
    path
        The file, for messages.
    end_us
        End of the run; no motion may start more than `AFTER_US` (one day) after it.

    Raises
    ------
    InputError
        If a row is impossible, or a robot has no rows; the message names one such row or robot.
    """
    _within(
        path,
        motion,
        {
            "robot": (0, layout.robots - 1),
            "kind": (0, KINDS_OF_MOTION - 1),
            "from_wp": (0, layout.waypoints - 1),
            "to_wp": (0, layout.waypoints - 1),
            "pod": (-1, layout.pods - 1),
            "t0_us": (0, end_us + AFTER_US),
            "heading0_rad": (-LARGEST_ANGLE_RAD, LARGEST_ANGLE_RAD),
            "heading1_rad": (-LARGEST_ANGLE_RAD, LARGEST_ANGLE_RAD),
            "top_speed_m_s": (0.0, LARGEST_SPEED_M_S),
        },
    )
    robot, begins, ends = (motion[name].to_numpy() for name in ("robot", "t0_us", "t1_us"))
    _refuse(path, ends < begins, "the motion ends (t1_us) before it starts (t0_us)")
    same = robot[1:] == robot[:-1]
    _refuse(path, np.append(False, robot[1:] < robot[:-1]), "rows are not sorted by robot")
    apart = same & (begins[1:] != ends[:-1])
    _refuse(path, np.append(False, apart), "t0_us must equal t1_us of the robot's previous row")
    lacking = np.setdiff1d(np.arange(layout.robots), robot)
    if len(lacking):
        raise InputError(f"{path}: there are no rows for robot {lacking[0]}")


def require_events(
    path: Path, events: pd.DataFrame, layout: Layout, skus: int, end_us: int
) -> None:
    """Make sure that the events in a trace are possible in the layout.

    Parameters
    ----------
    path
        The file, for messages.
    skus
        Number of SKUs in the run.
    end_us
        End of the run; no event may be later.

    Raises
    ------
    InputError
        If an event is impossible, or the events are not sorted by time; the message names a row.
    """
    unknown = ~events["kind"].isin(KINDS).to_numpy()
    _refuse(path, unknown, f"kind must be one of {', '.join(KINDS)}")
    most = np.iinfo(np.int32).max
    _within(
        path,
        events,
        {
            "time_us": (0, end_us),
            "robot": (-1, layout.robots - 1),
            "pod": (-1, layout.pods - 1),
            "station": (-1, len(layout.stations) - 1),
            "sku": (-1, skus - 1),
            "order": (-1, most),
            "units": (-most, most),
        },
    )
    # a robot draws energy even when its battery is empty, until it is rescued
    negative = (events["units"] < 0) & (events["kind"] != "battery-level")
    _refuse(path, negative.to_numpy(), "units must be from 0 on, except in a battery-level")
    times = events["time_us"].to_numpy()
    _refuse(
        path, np.append(False, times[1:] < times[:-1]), "time_us is less than in the row before"
    )


def _within(path: Path, frame: pd.DataFrame, valid: Mapping[str, tuple[float, float]]) -> None:
    for name, (low, high) in valid.items():
        values = frame[name].to_numpy()
        wrong = ~((values >= low) & (values <= high))  # also true of nan
        if wrong.any():
            row = int(np.argmax(wrong))
            raise InputError(
                f"{path}: row {row}: {name} must be from {low} to {high} (given: {values[row]})"
            )


def _refuse(path: Path, wrong: NDArray[np.bool_], what: str) -> None:
    if wrong.any():
        raise InputError(f"{path}: row {int(np.argmax(wrong))}: {what}")

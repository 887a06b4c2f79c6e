"""What a trace cannot tell: robots, places, pods and stations that are not, and impossible times.

A trace that is read back may have been written or edited by anybody. What is wrong with the motion
as such, and not with the safety of it, is said here in one line; the checker proves the rest.
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

KINDS_OF_MOTION = 6
AFTER_US = 86_400_000_000
"""Ways that are begun are driven to their end, after the run; none takes a day."""
LARGEST_ANGLE_RAD = 100.0
"""Headings are angles: a few turns at most."""


REALS = ("heading0_rad", "heading1_rad")
WORDS = ("kind", "detail")
"""In a trace `kind` is a number; in events it is a word."""


def require_columns(path: Path, table: Any, names: Sequence[str]) -> None:
    """Make sure that columns hold what they are to hold, and miss nothing but details.

    Parameters
    ----------
    path
        The file, for messages.
    table
        A table of Arrow.
    names
        The columns, all of which the table has.

    Raises
    ------
    InputError
        Naming the first column that does not.
    """
    from pyarrow import types  # type: ignore[import-untyped]

    for name in names:
        held = table.schema.field(name).type
        if name in REALS:
            what, right = "numbers", types.is_floating(held)
        elif name in WORDS and "detail" in names:
            # a column of words without any is written as one of nothing
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
    """Make sure that motion can have happened in a layout.

    Parameters
    ----------
    path
        The file, for messages.
    end_us
        End of the run; what begins much later cannot be.

    Raises
    ------
    InputError
        Naming the first row that cannot be.
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
        },
    )
    robot, begins, ends = (motion[name].to_numpy() for name in ("robot", "t0_us", "t1_us"))
    _refuse(path, ends < begins, "it ends (t1_us) before it begins (t0_us)")
    same = robot[1:] == robot[:-1]
    _refuse(path, np.append(False, robot[1:] < robot[:-1]), "rows are not sorted by robot")
    apart = same & (begins[1:] != ends[:-1])
    _refuse(path, np.append(False, apart), "it does not begin (t0_us) where the one before ends")
    lacking = np.setdiff1d(np.arange(layout.robots), robot)
    if len(lacking):
        raise InputError(f"{path}: nothing is told of robot {lacking[0]}")


def require_events(
    path: Path, events: pd.DataFrame, layout: Layout, skus: int, end_us: int
) -> None:
    """Make sure that events can have happened in a layout; parameters and error as above.

    Parameters
    ----------
    skus
        Number of SKUs of the run.
    """
    unknown = ~events["kind"].isin(KINDS).to_numpy()
    _refuse(path, unknown, f"kind is none of {', '.join(KINDS)}")
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
            "units": (0, most),
        },
    )
    times = events["time_us"].to_numpy()
    _refuse(path, np.append(False, times[1:] < times[:-1]), "it is earlier than the row before")


def _within(path: Path, frame: pd.DataFrame, valid: Mapping[str, tuple[float, float]]) -> None:
    for name, (low, high) in valid.items():
        values = frame[name].to_numpy()
        wrong = ~((values >= low) & (values <= high))  # numbers that are none, too
        if wrong.any():
            row = int(np.argmax(wrong))
            raise InputError(
                f"{path}: row {row}: {name} {values[row]} cannot be; valid: {low} to {high}"
            )


def _refuse(path: Path, wrong: NDArray[np.bool_], what: str) -> None:
    if wrong.any():
        raise InputError(f"{path}: row {int(np.argmax(wrong))}: {what}")

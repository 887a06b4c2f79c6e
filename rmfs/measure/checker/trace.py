"""The trace as the checker reads it: validated columns and the robots' kinematics beside them."""

from __future__ import annotations

from dataclasses import dataclass, replace
from enum import IntEnum
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from rmfs.errors import InputError

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from numpy.typing import NDArray

    from rmfs.layout.model import Layout

MICROSECONDS = 1e6
"""Microseconds per second."""


class Motion(IntEnum):
    """What one row of a trace describes."""

    HOLD = 0
    TURN = 1
    RUN = 2
    LIFT_RIDE = 3
    LIFT = 4
    SET_DOWN = 5


COLUMNS = {
    "robot": np.int64,
    "t0_us": np.int64,
    "t1_us": np.int64,
    "kind": np.int64,
    "from_wp": np.int64,
    "to_wp": np.int64,
    "heading0_rad": np.float64,
    "heading1_rad": np.float64,
    "pod": np.int64,
}
"""The columns of a trace, with the type the checker computes in."""


@dataclass(frozen=True, slots=True)
class Trace:
    """One row per motion, sorted by robot and time; see the trace format in the documentation.

    Attributes
    ----------
    robot, t0_us, t1_us, kind, from_wp, to_wp, heading0_rad, heading1_rad, pod
        The columns, each of shape (K,).
    """

    robot: NDArray[np.int64]
    t0_us: NDArray[np.int64]
    t1_us: NDArray[np.int64]
    kind: NDArray[np.int64]
    from_wp: NDArray[np.int64]
    to_wp: NDArray[np.int64]
    heading0_rad: NDArray[np.float64]
    heading1_rad: NDArray[np.float64]
    pod: NDArray[np.int64]

    def __len__(self) -> int:
        """Return the number of rows."""
        return len(self.robot)

    @property
    def follows(self) -> NDArray[np.bool_]:
        """Whether row k + 1 belongs to the robot of row k, shape (K - 1,)."""
        same: NDArray[np.bool_] = self.robot[1:] == self.robot[:-1]
        return same

    @property
    def is_last(self) -> NDArray[np.bool_]:
        """Whether the row is the last of its robot, shape (K,)."""
        return np.append(~self.follows, True)[: len(self)]

    def is_kind(self, *kinds: Motion) -> NDArray[np.bool_]:
        """Return which rows are of one of these kinds, shape (K,)."""
        return np.isin(self.kind, kinds)


def read(layout: Layout, columns: Mapping[str, Any]) -> Trace:
    """Take the columns of a trace and make sure that they can be interpreted at all.

    Parameters
    ----------
    columns
        Arrays by name (extra ones are ignored); a pandas frame will do. They are sorted here if
        they are not.

    Raises
    ------
    InputError
        If a column is missing, lengths differ, or a row names a robot, waypoint, pod or kind that
        does not exist.
    """
    missing = [name for name in COLUMNS if name not in columns]
    if missing:
        raise InputError(f"trace: column {', '.join(missing)} missing; valid: {', '.join(COLUMNS)}")
    arrays: dict[str, NDArray[Any]] = {
        name: np.asarray(columns[name]).astype(dtype) for name, dtype in COLUMNS.items()
    }
    if len({len(array) for array in arrays.values()}) > 1:
        raise InputError("trace: columns differ in length")
    limits = {
        "robot": (0, layout.robots),
        "kind": (0, len(Motion)),
        "from_wp": (0, layout.waypoints),
        "to_wp": (0, layout.waypoints),
        "pod": (-1, layout.pods),
    }
    for name, (low, high) in limits.items():
        wrong = (arrays[name] < low) | (arrays[name] >= high)
        if wrong.any():
            row = int(np.argmax(wrong))
            raise InputError(
                f"trace: row {row}: {name} {arrays[name][row]} does not exist "
                f"(valid: {low} to {high - 1})"
            )
    for name in ("heading0_rad", "heading1_rad"):
        if not np.isfinite(arrays[name]).all():
            row = int(np.argmin(np.isfinite(arrays[name])))
            raise InputError(f"trace: row {row}: {name} {arrays[name][row]} is no angle")
    order = np.lexsort((arrays["t0_us"], arrays["robot"]))
    return Trace(**{name: array[order] for name, array in arrays.items()})


class Slow(NamedTuple):
    """A robot drives with a share of its top speed.

    Attributes
    ----------
    from_us, to_us
        What begins in [from_us, to_us) is slow.
    """

    robot: int
    from_us: int
    to_us: int
    share: float


@dataclass(frozen=True, slots=True)
class Kinematics:
    """The limits of the robot of each row, each of shape (K,).

    Attributes
    ----------
    radius_m
        Radius of the robot itself.
    """

    radius_m: NDArray[np.float64]
    acceleration_m_s2: NDArray[np.float64]
    deceleration_m_s2: NDArray[np.float64]
    top_speed_m_s: NDArray[np.float64]
    full_turn_s: NDArray[np.float64]
    pod_transfer_s: NDArray[np.float64]

    @classmethod
    def of(cls, layout: Layout, robots: NDArray[np.int64]) -> Kinematics:
        """Look up the robot kind of each row."""
        kind = np.asarray(layout.robot_kind)[robots]
        return cls(
            **{
                name: np.array([getattr(one, name) for one in layout.robot_kinds], np.float64)[kind]
                for name in cls.__slots__
            }
        )

    def slowed(self, trace: Trace, slow: Sequence[Slow]) -> Kinematics:
        """Return the limits with the top speeds of robots that are slow at times."""
        if not slow:
            return self
        top = self.top_speed_m_s.copy()
        for one in slow:
            meant = (trace.robot == one.robot) & (trace.t0_us >= one.from_us)
            top[meant & (trace.t0_us < one.to_us)] *= one.share
        return replace(self, top_speed_m_s=top)

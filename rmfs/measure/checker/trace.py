"""The trace as the checker reads it: validated columns, and the robots' kinematics."""

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
    """The kinds of motion; each row of a trace has one of them."""

    HOLD = 0
    TURN = 1
    RUN = 2
    LIFT_RIDE = 3
    LIFT = 4
    SET_DOWN = 5
    GUIDED = 6


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
"""The columns of a trace, with the types used by the checker."""

TOP_SPEED = "top_speed_m_s"
"""Column with the top speed of each straight run: that of the robot, or less while it is slow."""


@dataclass(frozen=True, slots=True)
class Trace:
    """One row per motion, sorted by robot and time; see the trace format in the documentation.

    Attributes
    ----------
    robot, t0_us, t1_us, kind, from_wp, to_wp, heading0_rad, heading1_rad, pod
        The columns, each of shape (K,).
    top_speed_m_s
        Top speed of each straight run; None if the trace does not contain this column.
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
    top_speed_m_s: NDArray[np.float64] | None = None

    def __len__(self) -> int:
        """Return the number of rows."""
        return len(self.robot)

    @property
    def follows(self) -> NDArray[np.bool_]:
        """Whether row k + 1 belongs to the same robot as row k, shape (K - 1,)."""
        same: NDArray[np.bool_] = self.robot[1:] == self.robot[:-1]
        return same

    @property
    def is_last(self) -> NDArray[np.bool_]:
        """Whether each row is the last row of its robot, shape (K,)."""
        return np.append(~self.follows, True)[: len(self)]

    @property
    def end_us(self) -> int:
        """Time at which the last motion of the trace starts, in microseconds.

        By default, the trace must cover every robot up to this time. A turn and the straight run
        after it count as one motion.
        """
        begins = self.t0_us.copy()
        follows = self.follows & (self.kind[:-1] == Motion.TURN)
        begins[1:][follows] = self.t0_us[:-1][follows]
        return int(begins.max(initial=0))

    @property
    def is_guided(self) -> NDArray[np.bool_]:
        """Whether each row is guided, shape (K,).

        For a guided row, the straight line that the robot follows is known, but the robot's
        position on this line is not.
        """
        guided: NDArray[np.bool_] = self.kind == Motion.GUIDED
        return guided

    def is_kind(self, *kinds: Motion) -> NDArray[np.bool_]:
        """Return whether each row is of one of the given kinds, shape (K,)."""
        return np.isin(self.kind, kinds)


def read(layout: Layout, columns: Mapping[str, Any]) -> Trace:
    """Validate the columns of a trace, and sort its rows by robot and time.

    Parameters
    ----------
    columns
        Arrays by name, or a pandas frame; extra columns are ignored.

    Raises
    ------
    InputError
        If a column is missing, lengths differ, a row refers to a robot, waypoint, pod or kind that
        does not exist, or a heading or top speed is invalid.
    """
    missing = [name for name in COLUMNS if name not in columns]
    if missing:
        raise InputError(f"trace: column {', '.join(missing)} missing; valid: {', '.join(COLUMNS)}")
    arrays: dict[str, NDArray[Any]] = {
        name: np.asarray(columns[name]).astype(dtype) for name, dtype in COLUMNS.items()
    }
    if len({len(columns[name]) for name in (*COLUMNS, TOP_SPEED) if name in columns}) > 1:
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
            raise InputError(f"trace: row {row}: {name} {arrays[name][row]} is not an angle")
    if TOP_SPEED in columns:
        arrays[TOP_SPEED] = np.asarray(columns[TOP_SPEED]).astype(np.float64)
        runs = arrays["kind"] == Motion.RUN
        wrong = runs & ~(arrays[TOP_SPEED] > 0)
        if len(wrong) and wrong.any():
            row = int(np.argmax(wrong))
            raise InputError(
                f"trace: row {row}: {TOP_SPEED} {arrays[TOP_SPEED][row]} is not a valid speed"
            )
    order = np.lexsort((arrays["t0_us"], arrays["robot"]))
    return Trace(**{name: array[order] for name, array in arrays.items()})


class Slow(NamedTuple):
    """A period in which a robot is limited to a share of its top speed.

    Attributes
    ----------
    from_us, to_us
        Start and end of the period in microseconds. Motions that start in [from_us, to_us) are
        slow.
    share
        Share of the top speed to which the robot is limited.
    """

    robot: int
    from_us: int
    to_us: int
    share: float


@dataclass(frozen=True, slots=True)
class Kinematics:
    """Kinematic limits of the robots in K rows of a trace; all arrays have shape (K,).

    Attributes
    ----------
    radius_m
        Radius of the robot without a pod.
    """

    radius_m: NDArray[np.float64]
    acceleration_m_s2: NDArray[np.float64]
    deceleration_m_s2: NDArray[np.float64]
    top_speed_m_s: NDArray[np.float64]
    full_turn_s: NDArray[np.float64]
    pod_transfer_s: NDArray[np.float64]

    @classmethod
    def of(cls, layout: Layout, robots: NDArray[np.int64]) -> Kinematics:
        """Return the limits for rows that belong to the given robots."""
        kind = np.asarray(layout.robot_kind)[robots]
        return cls(
            **{
                name: np.array([getattr(one, name) for one in layout.robot_kinds], np.float64)[kind]
                for name in cls.__slots__
            }
        )

    def told(self, trace: Trace) -> Kinematics:
        """Return the limits, but with the top speeds that the trace states, if these are lower."""
        if trace.top_speed_m_s is None:
            return self
        top = np.where(trace.kind == Motion.RUN, trace.top_speed_m_s, self.top_speed_m_s)
        return replace(self, top_speed_m_s=np.minimum(top, self.top_speed_m_s))

    def slowed(self, trace: Trace, slow: Sequence[Slow]) -> Kinematics:
        """Return the limits, but with the top speeds reduced in the given periods."""
        top = self.top_speed_m_s.copy()
        for one in slow:
            meant = (trace.robot == one.robot) & (trace.t0_us >= one.from_us)
            top[meant & (trace.t0_us < one.to_us)] *= one.share
        return replace(self, top_speed_m_s=top)

"""Positions over time: a trace divided into pieces of constant acceleration.

The pieces follow from physics alone: a robot accelerates from rest at the rate a to the speed v,
keeps this speed, and brakes at the rate d to rest. Over a distance L the highest speed is

    v = min(top speed, sqrt(2 L a d / (a + d)))

and the straight run lasts v/a + (L - v²/2a - v²/2d)/v + v/d.
"""

from __future__ import annotations

from dataclasses import dataclass, fields
from typing import TYPE_CHECKING

import numpy as np

from .trace import MICROSECONDS, Kinematics, Motion, Trace

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from rmfs.layout.model import Layout

    Floats = NDArray[np.float64]

NEGLIGIBLE_S = 2e-6
"""Duration, in s, below which a standstill at the end of a straight run is due to rounding and gets
no piece."""


@dataclass(frozen=True, slots=True)
class Profile:
    """Speed over time of K straight runs from rest to rest; all arrays have shape (K,).

    Attributes
    ----------
    speed_m_s
        Highest speed reached in each straight run.
    speeding_s, cruising_s, braking_s
        Durations of the three phases: acceleration, constant speed and braking.
    """

    speed_m_s: Floats
    speeding_s: Floats
    cruising_s: Floats
    braking_s: Floats

    @property
    def duration_s(self) -> Floats:
        """Duration of each straight run, in s."""
        return self.speeding_s + self.cruising_s + self.braking_s


def profile(length_m: Floats, limits: Kinematics) -> Profile:
    """Return the fastest straight run from rest to rest over each distance."""
    a, d = limits.acceleration_m_s2, limits.deceleration_m_s2
    speed = np.minimum(limits.top_speed_m_s, np.sqrt(2 * length_m * a * d / (a + d)))
    cruise_m = np.maximum(length_m - speed**2 / (2 * a) - speed**2 / (2 * d), 0.0)
    cruise_s = np.divide(cruise_m, speed, out=np.zeros_like(speed), where=speed > 0)
    return Profile(speed, speed / a, cruise_s, speed / d)


def lengths(layout: Layout, trace: Trace) -> Floats:
    """Return the distance in the plane from each row's first to its last waypoint, in m."""
    return np.hypot(
        layout.x_m[trace.to_wp] - layout.x_m[trace.from_wp],
        layout.y_m[trace.to_wp] - layout.y_m[trace.from_wp],
    )


@dataclass(frozen=True, slots=True)
class Pieces:
    """Motions of constant acceleration: position(t) = p + v (t - t0) + h (t - t0)².

    If a robot in a demonstration is held up, a row of the kind `guided` is recorded. It states the
    straight line that the robot follows, but not the robot's position on this line. The piece of
    such a row covers the whole line at constant speed.

    Attributes
    ----------
    row
        Row of the trace to which the piece belongs, shape (K,).
    t0_s, t1_s
        Start and end of the piece, in s.
    x_m, y_m, vx, vy, hx, hy
        Position (m) and velocity (m/s) at `t0_s`, and half the acceleration (m/s²).
    guided
        Whether the row is guided. If so, the robot may be anywhere on its straight line at any time
        between `t0_s` and `t1_s`.
    """

    row: NDArray[np.int64]
    t0_s: Floats
    t1_s: Floats
    x_m: Floats
    y_m: Floats
    vx: Floats
    vy: Floats
    hx: Floats
    hy: Floats
    guided: NDArray[np.bool_]

    def __len__(self) -> int:
        """Return the number of pieces."""
        return len(self.row)

    def take(self, index: NDArray[np.int64] | NDArray[np.bool_]) -> Pieces:
        """Return the selected pieces."""
        return Pieces(**{f.name: getattr(self, f.name)[index] for f in fields(self)})

    def at(self, time_s: Floats) -> tuple[Floats, Floats]:
        """Return the x and y coordinates (m) of each piece at its time in `time_s`."""
        tau = time_s - self.t0_s
        return (
            self.x_m + tau * (self.vx + tau * self.hx),
            self.y_m + tau * (self.vy + tau * self.hy),
        )

    def way(self, begin_s: Floats, end_s: Floats) -> tuple[Floats, Floats, Floats, Floats]:
        """Return the line that each robot may cover between two times: its ends x0, y0, x1, y1 (m).

        A robot that is guided along a piece of its motion (`guided`) may be anywhere on this piece,
        so the line covers the whole piece.
        """
        return (
            *self.at(np.where(self.guided, self.t0_s, begin_s)),
            *self.at(np.where(self.guided, self.t1_s, end_s)),
        )

    @classmethod
    def joined(cls, parts: list[Pieces]) -> Pieces:
        """Combine several sets of pieces."""
        return cls(
            **{f.name: np.concatenate([getattr(p, f.name) for p in parts]) for f in fields(cls)}
        )


def cut(layout: Layout, trace: Trace, limits: Kinematics) -> Pieces:
    """Divide the rows of a trace into pieces, sorted by row; elevator rides have no pieces."""
    standing = ~trace.is_kind(Motion.RUN, Motion.LIFT_RIDE, Motion.GUIDED)
    parts = [_resting(layout, trace, np.flatnonzero(standing))]
    parts += [_guided(layout, trace, np.flatnonzero(trace.is_guided))]
    parts += _running(layout, trace, limits, np.flatnonzero(trace.kind == Motion.RUN))
    pieces = Pieces.joined(parts)
    pieces = pieces.take(pieces.t1_s > pieces.t0_s)
    return pieces.take(np.lexsort((pieces.t0_s, pieces.row)))


def _resting(layout: Layout, trace: Trace, rows: NDArray[np.int64]) -> Pieces:
    place = trace.from_wp[rows]
    zero = np.zeros(len(rows))
    return Pieces(
        rows,
        trace.t0_us[rows] / MICROSECONDS,
        trace.t1_us[rows] / MICROSECONDS,
        layout.x_m[place].astype(np.float64),
        layout.y_m[place].astype(np.float64),
        *(zero, zero, zero, zero),
        np.zeros(len(rows), np.bool_),
    )


def _guided(layout: Layout, trace: Trace, rows: NDArray[np.int64]) -> Pieces:
    origin, target = trace.from_wp[rows], trace.to_wp[rows]
    x, y = layout.x_m[origin].astype(np.float64), layout.y_m[origin].astype(np.float64)
    begin, end = trace.t0_us[rows] / MICROSECONDS, trace.t1_us[rows] / MICROSECONDS
    share = np.divide(1.0, end - begin, out=np.zeros(len(rows)), where=end > begin)
    zero = np.zeros(len(rows))
    return Pieces(
        *(rows, begin, end, x, y),
        *((layout.x_m[target] - x) * share, (layout.y_m[target] - y) * share, zero, zero),
        np.ones(len(rows), np.bool_),
    )


def _running(
    layout: Layout, trace: Trace, limits: Kinematics, rows: NDArray[np.int64]
) -> list[Pieces]:
    """Return pieces of straight runs: acceleration, constant speed and braking.

    If a row lasts longer than its straight run, a fourth piece is the standstill at the end.
    """
    own = Kinematics(*(getattr(limits, name)[rows] for name in Kinematics.__slots__))
    origin, target = trace.from_wp[rows], trace.to_wp[rows]
    x, y = layout.x_m[origin].astype(np.float64), layout.y_m[origin].astype(np.float64)
    length = lengths(layout, trace)[rows]
    scale = np.divide(1.0, length, out=np.zeros_like(length), where=length > 0)
    ux, uy = (layout.x_m[target] - x) * scale, (layout.y_m[target] - y) * scale
    plan = profile(length, own)
    start = trace.t0_us[rows] / MICROSECONDS
    stop = trace.t1_us[rows] / MICROSECONDS

    def piece(begin: Floats, end: Floats, way: Floats, speed: Floats, half: Floats) -> Pieces:
        return Pieces(
            *(rows, np.minimum(begin, stop), np.minimum(end, stop), x + ux * way, y + uy * way),
            *(ux * speed, uy * speed, ux * half, uy * half),
            np.zeros(len(rows), np.bool_),
        )

    v, zero = plan.speed_m_s, np.zeros(len(rows))
    cruise = start + plan.speeding_s
    brake = cruise + plan.cruising_s
    end = start + plan.duration_s
    standing = np.where(stop - end > NEGLIGIBLE_S, end, stop)
    speeding_m = v**2 / (2 * own.acceleration_m_s2)
    braking_m = v**2 / (2 * own.deceleration_m_s2)
    return [
        piece(start, cruise, zero, zero, own.acceleration_m_s2 / 2),
        piece(cruise, brake, speeding_m, v, zero),
        piece(brake, standing, length - braking_m, v, -own.deceleration_m_s2 / 2),
        piece(standing, stop, length, zero, zero),
    ]

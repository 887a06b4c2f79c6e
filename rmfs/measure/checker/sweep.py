"""Finds pairs of pieces of motion that are close in time and space (broad phase).

This is the first phase of the search for collisions of robots; the second (`distance`) examines
the pairs.

Time is divided into slabs of equal length. A piece has a box for each slab in which it takes place;
the box encloses the part of the line that the robot covers in this slab. The boxes of one slab and
tier form a lane. The lanes are placed side by side along one axis and swept together, so that the
work grows with the number of close boxes and not with the square of the number of robots.
"""

from __future__ import annotations

from dataclasses import dataclass, fields
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import NDArray

    from .motion import Pieces

    Floats = NDArray[np.float64]
    Index = NDArray[np.int64]

SLAB_S = 2.0
"""Length of a time slab in s, about that of a motion, so that few motions span several slabs."""

BOXES_AT_ONCE = 50_000
"""Approximate number of boxes made and swept at a time; limits memory for runs of any length."""


@dataclass(frozen=True, slots=True)
class Boxes:
    """Boxes around pieces of motion, each within one slab of time; all arrays have shape (B,).

    Attributes
    ----------
    piece
        Index of the piece.
    lane
        Number that identifies slab and tier; only boxes in the same lane can overlap.
    t0_s, t1_s
        Start and end of the part of the piece that lies in the slab.
    x0_m, x1_m, y0_m, y1_m
        Borders of the box.
    """

    piece: Index
    lane: Index
    t0_s: Floats
    t1_s: Floats
    x0_m: Floats
    x1_m: Floats
    y0_m: Floats
    y1_m: Floats

    def __len__(self) -> int:
        """Return the number of boxes."""
        return len(self.piece)

    def take(self, index: Index) -> Boxes:
        """Return the selected boxes."""
        return Boxes(**{f.name: getattr(self, f.name)[index] for f in fields(self)})


def close_pairs(
    pieces: Pieces, radius_m: Floats, tier: Index, robot: Index
) -> Iterator[tuple[Index, Index]]:
    """Yield pairs of pieces of different robots whose boxes overlap in time and space.

    Parameters
    ----------
    radius_m, tier, robot
        Three arrays of shape (K,) with a value for each piece: the radius in m of the robot or, if
        larger, of the pod that it carries; the tier; and the number of the robot.

    Yields
    ------
    tuple
        A batch of pairs without duplicates, as two arrays: the indices of the first pieces of the
        pairs, and those of the second pieces.
    """
    for begin, end in _windows(pieces, int(robot.max(initial=0)) + 1):
        within = (pieces.t0_s < end * SLAB_S) & (pieces.t1_s > begin * SLAB_S)
        index = np.flatnonzero(within)
        made = boxes(pieces.take(index), radius_m[index], tier[index], begin, end)
        one, other = _sweep(made, robot[index])
        yield index[one], index[other]


def _windows(pieces: Pieces, robots: int) -> Iterator[tuple[int, int]]:
    """Cut the run into stretches of slabs that hold about `BOXES_AT_ONCE` boxes each."""
    if not len(pieces):
        return
    first = int(np.floor(pieces.t0_s.min() / SLAB_S))
    last = int(np.ceil(pieces.t1_s.max() / SLAB_S))
    # every robot has a box in every slab, plus one wherever a piece starts
    per_slab = robots + len(pieces) / (last - first)
    step = max(1, int(BOXES_AT_ONCE / per_slab))
    for begin in range(first, last, step):
        yield begin, min(begin + step, last)


def boxes(pieces: Pieces, radius_m: Floats, tier: Index, begin: int, end: int) -> Boxes:
    """Divide pieces at the borders of slabs; return a box for each part, enlarged by `radius_m`.

    A piece follows a straight line in one direction, so the two ends of a part span its box.

    Parameters
    ----------
    begin, end
        Numbers of two slabs: boxes are made for the slabs from `begin` to `end` - 1.
    """
    first = np.maximum(np.floor(pieces.t0_s / SLAB_S).astype(np.int64), begin)
    last = np.minimum(np.ceil(pieces.t1_s / SLAB_S).astype(np.int64), end)
    count = np.maximum(last - first, 0)
    piece = np.repeat(np.arange(len(pieces)), count)
    slab = np.arange(len(piece)) - np.repeat(np.cumsum(count) - count, count) + first[piece]
    whole = pieces.take(piece)
    t0 = np.maximum(whole.t0_s, slab * SLAB_S)
    t1 = np.minimum(whole.t1_s, (slab + 1) * SLAB_S)
    xa, ya, xb, yb = whole.way(t0, t1)
    grow = radius_m[piece]
    made = Boxes(
        piece,
        slab * (int(tier.max(initial=0)) + 1) + tier[piece],
        t0,
        t1,
        np.minimum(xa, xb) - grow,
        np.maximum(xa, xb) + grow,
        np.minimum(ya, yb) - grow,
        np.maximum(ya, yb) + grow,
    )
    return made.take(np.lexsort((made.x0_m, made.lane)))


def _sweep(part: Boxes, robot: Index) -> tuple[Index, Index]:
    """Find the overlapping boxes of one batch, sorted by lane and left border."""
    if not len(part):
        return part.piece, part.piece
    # lanes are placed side by side, farther apart than the hall is wide
    width = float(part.x1_m.max() - part.x0_m.min()) + 1.0
    shift = (part.lane - part.lane[0]) * width
    until = np.searchsorted(part.x0_m + shift, part.x1_m + shift, side="right")
    reach = until - np.arange(len(part)) - 1
    one = np.repeat(np.arange(len(part)), reach)
    other = np.arange(len(one)) - np.repeat(np.cumsum(reach) - reach, reach) + one + 1
    near = (
        (robot[part.piece[one]] != robot[part.piece[other]])
        & (part.y0_m[one] <= part.y1_m[other])
        & (part.y0_m[other] <= part.y1_m[one])
        & (part.t0_s[one] < part.t1_s[other])
        & (part.t0_s[other] < part.t1_s[one])
    )
    a, b = part.piece[one[near]], part.piece[other[near]]
    pieces = int(max(a.max(initial=0), b.max(initial=0))) + 1
    unique = np.unique(np.minimum(a, b) * pieces + np.maximum(a, b))
    return unique // pieces, unique % pieces

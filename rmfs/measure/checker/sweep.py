"""Broad phase: which pairs of motions are near each other in time and space.

Time is cut into slabs; in each, a motion is a box around the way it drives there. All boxes of all
slabs and tiers are laid side by side on one axis and swept once, so that the work grows with the
boxes that really are close, not with the square of the fleet.
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
"""Length of a time slab: about the length of a motion, so that few motions span many."""

BOXES_AT_ONCE = 100_000
"""How many boxes are swept together: bounds the memory, some 200 MB at worst."""


@dataclass(frozen=True, slots=True)
class Boxes:
    """Extents of motions within one time slab each, all of shape (B,).

    Attributes
    ----------
    piece
        The motion.
    lane
        Slab and tier as one number; only boxes of one lane can meet.
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

    def take(self, index: Index | slice) -> Boxes:
        """Return the chosen boxes."""
        return Boxes(**{f.name: getattr(self, f.name)[index] for f in fields(self)})


def boxes(pieces: Pieces, radius_m: Floats, tier: Index) -> Boxes:
    """Cut each piece at the slab borders and bound what is left, grown by its radius.

    A piece drives along a line and never turns back, so its ends bound it.
    """
    first = np.floor(pieces.t0_s / SLAB_S).astype(np.int64)
    last = np.maximum(np.ceil(pieces.t1_s / SLAB_S).astype(np.int64), first + 1)
    count = last - first
    piece = np.repeat(np.arange(len(pieces)), count)
    slab = np.arange(len(piece)) - np.repeat(np.cumsum(count) - count, count) + first[piece]
    whole = pieces.take(piece)
    begin = np.maximum(whole.t0_s, slab * SLAB_S)
    end = np.minimum(whole.t1_s, (slab + 1) * SLAB_S)
    xa, ya = whole.at(begin)
    xb, yb = whole.at(end)
    grow = radius_m[piece]
    tiers = int(tier.max(initial=0)) + 1
    return Boxes(
        piece,
        slab * tiers + tier[piece],
        begin,
        end,
        np.minimum(xa, xb) - grow,
        np.maximum(xa, xb) + grow,
        np.minimum(ya, yb) - grow,
        np.maximum(ya, yb) + grow,
    )


def close_pairs(all_boxes: Boxes, robot: Index) -> Iterator[tuple[Index, Index]]:
    """Yield pairs of pieces of different robots whose boxes overlap in time and space.

    Parameters
    ----------
    robot
        Robot of each piece.

    Yields
    ------
    tuple
        Indices of the first and second pieces of a batch of pairs, without repetition in a batch.
    """
    order = np.lexsort((all_boxes.x0_m, all_boxes.lane))
    ordered = all_boxes.take(order)
    for begin, end in _batches(ordered.lane):
        yield _sweep(ordered.take(slice(begin, end)), robot)


def _batches(lane: Index) -> Iterator[tuple[int, int]]:
    """Cut sorted lanes into stretches of whole lanes of about `BOXES_AT_ONCE` boxes."""
    begin = 0
    while begin < len(lane):
        reach = min(begin + BOXES_AT_ONCE, len(lane))
        end = int(np.searchsorted(lane, lane[reach - 1], side="right"))
        yield begin, end
        begin = end


def _sweep(part: Boxes, robot: Index) -> tuple[Index, Index]:
    """Find the overlapping boxes of one batch, sorted by lane and left border."""
    # lanes are laid side by side, further apart than the hall is wide
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

"""Proves whether two moving points come closer than a limit, without sampling (narrow phase).

This is the second phase of the search for collisions, for pairs already known to be close.

Each point moves with constant acceleration, so the squared distance over a common time interval is
a polynomial of degree four. In Bernstein form on that interval, the polynomial is never below its
smallest coefficient: if no coefficient is below the squared limit, the points never come closer
than the limit. The first and last coefficients are the values of the polynomial at the two ends of
the interval, so a violation is proven if one of them is below the squared limit. If neither safety
nor a violation is proven, the interval is halved (de Casteljau's algorithm), and each half is
examined in the same way. As intervals get shorter, the smallest coefficient converges quadratically
to the minimum of the polynomial, so a few rounds suffice.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from .motion import Pieces

    Floats = NDArray[np.float64]
    Index = NDArray[np.int64]
    Mask = NDArray[np.bool_]

ROUNDS = 40
"""Number of halvings after which an interval counts as touching the limit without violating it.
The interval is then 1e-12 of the motion; over it, the squared distance changes by less than
rounding errors."""

EXACT = 1e-12
"""Squared distances that differ by less than this count as equal, in m²."""

_TO_BERNSTEIN = np.array(
    [
        [1, 0, 0, 0, 0],
        [1, 1 / 4, 0, 0, 0],
        [1, 1 / 2, 1 / 6, 0, 0],
        [1, 3 / 4, 1 / 2, 1 / 4, 0],
        [1, 1, 1, 1, 1],
    ]
)
"""Matrix that converts coefficients a_j of powers to Bernstein coefficients b_k:
b_k = sum over j <= k of C(k, j) / C(4, j) a_j, with binomial coefficients C."""


def squared_distance(one: Pieces, other: Pieces) -> tuple[Floats, Floats, Floats]:
    """Return the squared distance between the two pieces of each of K pairs, as a polynomial.

    Returns
    -------
    tuple
        Start and end in s of the time that the two pieces have in common, each of shape (K,), and
        the coefficients a_j, shape (K, 5). The squared distance in m² is the sum of a_j u^j, where
        u grows from 0 at the start to 1 at the end.
    """
    begin = np.maximum(one.t0_s, other.t0_s)
    end = np.minimum(one.t1_s, other.t1_s)
    span = end - begin
    x1, y1 = one.at(begin)
    x2, y2 = other.at(begin)
    since1, since2 = begin - one.t0_s, begin - other.t0_s
    px, py = x1 - x2, y1 - y2
    vx = (one.vx + 2 * one.hx * since1 - other.vx - 2 * other.hx * since2) * span
    vy = (one.vy + 2 * one.hy * since1 - other.vy - 2 * other.hy * since2) * span
    hx, hy = (one.hx - other.hx) * span**2, (one.hy - other.hy) * span**2
    power = np.stack(
        [
            px**2 + py**2,
            2 * (px * vx + py * vy),
            vx**2 + vy**2 + 2 * (px * hx + py * hy),
            2 * (vx * hx + vy * hy),
            hx**2 + hy**2,
        ],
        axis=1,
    )
    return begin, end, power


def below(power: Floats, limit: Floats) -> NDArray[np.bool_]:
    """Return whether each of K polynomials is below its limit anywhere on [0, 1], shape (K,).

    Parameters
    ----------
    power
        Coefficients of each polynomial, as returned by `squared_distance`, shape (K, 5).
    limit
        Limit of each polynomial, in the unit of its values (m² for squared distances), shape (K,).
    """
    violated = np.zeros(len(power), np.bool_)
    which: Index = np.arange(len(power))
    coefficients = power @ _TO_BERNSTEIN.T
    for _ in range(ROUNDS):
        bound = limit[which]
        at_ends = np.minimum(coefficients[:, 0], coefficients[:, 4]) < bound
        violated[which[at_ends]] = True
        open_ = ~violated[which] & (coefficients.min(axis=1) < bound)
        if not open_.any():
            break
        left, right = _halved(coefficients[open_])
        coefficients = np.concatenate([left, right])
        which = np.concatenate([which[open_], which[open_]])
    return violated


def _halved(b: Floats) -> tuple[Floats, Floats]:
    """Split Bernstein coefficients at the middle of the interval (de Casteljau)."""
    left, right = np.empty_like(b), np.empty_like(b)
    level = b
    for k in range(5):
        left[:, k], right[:, 4 - k] = level[:, 0], level[:, -1]
        level = (level[:, :-1] + level[:, 1:]) / 2
    return left, right


def minimum(power: Floats) -> tuple[Floats, Floats]:
    """Return where on [0, 1] each of K polynomials is smallest, and its value there.

    The interval is halved as in `below`; parts that cannot contain a value below the smallest one
    found so far are dropped.

    Returns
    -------
    tuple
        Arguments and values, each of shape (K,); values are exact to 1e-12.
    """
    where, value = np.zeros(len(power)), np.full(len(power), np.inf)
    which: Index = np.arange(len(power))
    begin, width = np.zeros(len(power)), 1.0
    coefficients = power @ _TO_BERNSTEIN.T
    for _ in range(ROUNDS):
        for at_end, argument in ((0, begin), (4, begin + width)):
            reached = coefficients[:, at_end]
            # if several halves belong to one polynomial, the smallest is assigned last
            order = np.argsort(-reached, kind="stable")
            better = order[reached[order] < value[which[order]]]
            where[which[better]], value[which[better]] = argument[better], reached[better]
        open_ = coefficients.min(axis=1) < value[which] - EXACT
        if not open_.any():
            break
        left, right = _halved(coefficients[open_])
        width /= 2
        coefficients = np.concatenate([left, right])
        which = np.concatenate([which[open_], which[open_]])
        begin = np.concatenate([begin[open_], begin[open_] + width])
    return where, value


def meets(one: Pieces, other: Pieces, limit: Floats) -> tuple[Mask, Floats, Floats]:
    """Find pairs of pieces that come closer than a limit or, for guided robots, may do so.

    For a guided robot (see `Pieces`), the straight line that it follows is known, but its position
    on this line is not.

    Parameters
    ----------
    one, other
        The first and the second pieces of K pairs.
    limit
        Limit of each pair's squared distance, in m², shape (K,).

    Returns
    -------
    tuple
        Whether each pair comes, or may come, closer than its limit; the time (s) of the closest
        approach; and the squared distance (m²) at this time. For pairs with a guided robot, the
        time assumes that this robot drives at constant speed, and the distance is the least one
        between the lines that the two pieces cover. All arrays have shape (K,); time and distance
        are meaningful only for pairs that come, or may come, closer than their limit.
    """
    begin, end, power = squared_distance(one, other)
    hit = below(power, limit)
    unknown = one.guided | other.guided
    ways = squared_between_ways(one.take(unknown), other.take(unknown))
    hit[unknown] = ways < limit[unknown]
    where, squared = np.zeros(len(power)), np.full(len(power), np.inf)
    where[hit], squared[hit] = minimum(power[hit])
    squared[unknown] = ways
    return hit, begin + where * (end - begin), squared


def squared_between_ways(one: Pieces, other: Pieces) -> Floats:
    """Return the squared distance (m²) between the lines covered by the pieces of each pair.

    A piece covers the straight line along which its robot drives during the time that the two
    pieces have in common or, if the robot is guided, the line of the whole piece. The result has
    shape (K,).
    """
    begin = np.maximum(one.t0_s, other.t0_s)
    end = np.minimum(one.t1_s, other.t1_s)
    ax, ay, bx, by = one.way(begin, end)
    cx, cy, dx, dy = other.way(begin, end)
    ends = [
        _squared_to_line(ax, ay, cx, cy, dx, dy),
        _squared_to_line(bx, by, cx, cy, dx, dy),
        _squared_to_line(cx, cy, ax, ay, bx, by),
        _squared_to_line(dx, dy, ax, ay, bx, by),
    ]
    sides = _side(ax, ay, bx, by, cx, cy) * _side(ax, ay, bx, by, dx, dy) < 0
    cross = sides & (_side(cx, cy, dx, dy, ax, ay) * _side(cx, cy, dx, dy, bx, by) < 0)
    least: Floats = np.where(cross, 0.0, np.minimum.reduce(ends))
    return least


def _side(ax: Floats, ay: Floats, bx: Floats, by: Floats, px: Floats, py: Floats) -> Floats:
    """Return a number whose sign states on which side of the line from a to b a point p is."""
    return (bx - ax) * (py - ay) - (by - ay) * (px - ax)


def _squared_to_line(
    px: Floats, py: Floats, ax: Floats, ay: Floats, bx: Floats, by: Floats
) -> Floats:
    """Return the squared distance of each point p from the line segment from a to b."""
    ux, uy = bx - ax, by - ay
    squared = ux**2 + uy**2
    along = np.divide(
        (px - ax) * ux + (py - ay) * uy, squared, out=np.zeros_like(squared), where=squared > 0
    )
    share = np.clip(along, 0.0, 1.0)
    return (px - ax - share * ux) ** 2 + (py - ay - share * uy) ** 2

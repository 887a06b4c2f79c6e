"""Combines successive overlaps of the same two bodies into one event, reported at its worst moment.

A body is a robot or a stored pod.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Floats = NDArray[np.float64]
    Index = NDArray[np.int64]

TOGETHER_S = 1e-5
"""Maximum gap in s between two violations of the same bodies that count as one event."""


def worst(who: tuple[Index, Index], begin_s: Floats, end_s: Floats, amount: Floats) -> list[int]:
    """Return the index of the worst violation of each event; a violation is an overlap.

    Successive violations of the same two bodies form an event.

    Parameters
    ----------
    who
        Numbers of the first and of the second body in each of K violations: two robots, or a robot
        and a stored pod. Two arrays of shape (K,).
    begin_s, end_s
        Time interval of each violation, shape (K,).
    amount
        Severity of each violation, shape (K,).
    """
    chosen: list[int] = []
    last_who, last_end = (-1, -1), -np.inf
    for k in np.lexsort((begin_s, who[1], who[0])).tolist():
        bodies = (int(who[0][k]), int(who[1][k]))
        continues = bodies == last_who and begin_s[k] <= last_end + TOGETHER_S
        if not continues:
            chosen.append(k)
        elif amount[k] > amount[chosen[-1]]:
            chosen[-1] = k
        last_end = max(last_end, float(end_s[k])) if continues else float(end_s[k])
        last_who = bodies
    return chosen

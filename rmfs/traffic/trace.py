"""Traces of motion, row by row."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from rmfs.traffic.vocabulary import Piece

if TYPE_CHECKING:
    from numpy.typing import NDArray


def joined_holds(trace: dict[str, NDArray[Any]]) -> dict[str, NDArray[Any]]:
    """Merge the consecutive rows of each period in which a robot stands still.

    The trace then does not depend on how often trace or statistics were requested during the run.

    Parameters
    ----------
    trace
        Columns as in `Traffic.trace`, sorted by robot and time.
    """
    same = np.ones(max(len(trace["robot"]) - 1, 0), np.bool_)
    for name in ("robot", "kind", "from_wp", "heading1_rad", "pod"):
        same &= trace[name][1:] == trace[name][:-1]
    same &= (trace["kind"][1:] == Piece.HOLD) & (trace["t0_us"][1:] == trace["t1_us"][:-1])
    first, last = np.append(True, ~same), np.append(~same, True)
    if not len(trace["robot"]):
        return trace
    return {name: column[last if name == "t1_us" else first] for name, column in trace.items()}

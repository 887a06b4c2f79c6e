"""Check of sequencing: visits of pods at one station, and when its orders are opened."""

from __future__ import annotations

import itertools
from typing import TYPE_CHECKING

from rmfs.solvers.decisions.checking.wrong import require, within

if TYPE_CHECKING:
    from rmfs.solvers.decisions.schema import Plain


def value(data: Plain, values: Plain) -> float:
    """Simulate the visits, and return their number; consecutive visits of one pod count as one."""
    pods, start = values["pods"].tolist(), values["start"].tolist()
    holds = [set(row.nonzero()[0].tolist()) for row in data["holds"]]
    missing = [set(row.nonzero()[0].tolist()) for row in data["needs"]]
    capacity = data["capacity"]
    within("pods", pods, 0, len(holds))
    within("start", start, -1, len(pods))
    for order, opened in enumerate(data["opened"].tolist()):
        require(
            (start[order] < 0) == bool(opened),
            f"start[{order}]: must be -1 if and only if the order is open at the start",
        )
    open_ = [order for order, visit in enumerate(start) if visit < 0]
    require(len(open_) <= capacity, "more orders are open than there are slots")
    for visit, pod in enumerate(pods):
        new = [order for order, begin in enumerate(start) if begin == visit]
        for order in (*open_, *new):
            missing[order] -= holds[pod]
        # those open before are served first; of the new ones, those done at once pass one by one
        kept = [order for order in open_ if missing[order]]
        passing = [order for order in new if not missing[order]]
        stay = [order for order in new if missing[order]]
        slots = max(len(kept) + bool(passing), len(kept) + len(stay))
        require(slots <= capacity, f"more orders are open than there are slots at visit {visit}")
        open_ = kept + stay
    for order, left in enumerate(missing):
        require(not left, f"order {order} never gets SKU {min(left, default=-1)}")
    changes = sum(one != next_ for one, next_ in itertools.pairwise(pods))
    return float(changes + 1) if pods else 0.0

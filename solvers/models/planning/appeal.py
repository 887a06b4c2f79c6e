"""Which pods are worth a try at a station, by a rough estimate of what each could add."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from rmfs.solvers.models.planning.data import Planning, Reals
    from rmfs.solvers.models.planning.filling import Draft

PARTLY = 0.35
"""Share of its worth at which a line counts whose order lacks other lines in the plan."""


class Appeal:
    """Scores pods for one more visit.

    A unit in stock counts with the mean worth of the lines left that want its SKU, as long as they
    want more. Lines of orders that are open elsewhere count nothing, and lines whose order lacks
    others at the station count in part.
    """

    def __init__(self, data: Planning) -> None:
        self._data = data
        self._skus, self._column = np.unique(data.line_sku, return_inverse=True)
        self._stock = data.stock[:, self._skus].astype(np.float64)
        self._worth = data.line_worth + data.order_worth[data.line_order]
        self._at = data.order_station[data.line_order]

    def scores(self, draft: Draft, station: int) -> Reals:
        """Estimate what each pod would add to a draft, cost taken off, shape (P,), s.

        -inf for pods that cannot come, or come already.
        """
        data, column = self._data, self._column
        left: NDArray[np.bool_] = np.array(draft.line_visit, np.int64) < 0
        there = [*data.under_way[station], *draft.pods[station]]
        at_hand: NDArray[np.bool_] = self._stock[there].sum(axis=0) > 0
        missing: NDArray[np.bool_] = left & ~at_hand[column]
        lacking = np.bincount(data.line_order[missing], minlength=data.orders)
        share = np.where(lacking[data.line_order] > missing, PARTLY, 1.0)
        share[~left | ((self._at >= 0) & (self._at != station))] = 0.0
        skus = len(self._skus)
        wanted = np.bincount(column, data.line_units * share, skus)
        worth = np.bincount(column, self._worth * share, skus)
        per_unit = worth / np.maximum(wanted, 1e-9)
        scores: Reals = (np.minimum(self._stock, wanted) * per_unit).sum(axis=1)
        scores = scores - data.cost[:, station]
        scores[[pod for pods in draft.pods for pod in pods]] = -np.inf
        return scores

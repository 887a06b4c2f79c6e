r"""Expected visits of a pod: its share of the demand, divided by the pile-on.

Within the horizon, :math:`D_k = backlog_k + rate_k \cdot horizon` units of SKU k are wanted. They
are taken from the pods in proportion to the stock :math:`s_{kp}` of each pod p, but a pod gives no
more units than it has in stock:

.. math::

    units_p = \sum_k s_{kp} \min\Bigl(1, \frac{D_k}{\sum_q s_{kq}}\Bigr), \qquad
    visits_p = units_p / pileon
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rmfs.solvers.models.checks import integers, number, reals, require


def expected_visits(
    stock: ArrayLike,
    backlog: ArrayLike,
    rate_per_h: ArrayLike,
    *,
    horizon_h: float,
    pile_on: float,
    pods: ArrayLike | None = None,
) -> NDArray[np.float64]:
    """Estimate how often each pod will visit a station within the horizon.

    Parameters
    ----------
    stock
        Units of each SKU available on each pod, shape (K, P).
    backlog
        Units of each SKU wanted by waiting orders, shape (K,).
    rate_per_h
        Units of each SKU that new orders will want per hour, shape (K,).
    horizon_h
        Horizon in h: about the time that a pod stays at its place.
    pile_on
        Units taken per visit, positive.
    pods
        The pods to evaluate, shape (Q,). Default: all.

    Returns
    -------
    Expected number of visits of each pod that is evaluated: shape (Q,), or (P,) without `pods`.

    Raises
    ------
    ModelError
        If a shape or a value is wrong.
    """
    units = integers("stock", stock, (None, None), low=0)
    skus, count = units.shape
    wanted = reals("backlog", backlog, (skus,), low=0) + reals(
        "rate_per_h", rate_per_h, (skus,), low=0
    ) * number("horizon_h", horizon_h, low=0)
    require(pile_on > 0, "pile_on", f"must be positive, is {pile_on}")
    total = units.sum(axis=1)
    share = np.divide(wanted, total, out=np.zeros(skus), where=total > 0)
    asked = (
        units if pods is None else units[:, integers("pods", pods, (None,), low=0, high=count - 1)]
    )
    expected: NDArray[np.float64] = (np.minimum(1.0, share)[:, np.newaxis] * asked).sum(axis=0)
    return expected / pile_on

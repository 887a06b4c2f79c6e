r"""The worth of a bundle in a pod: the robot time that the bundle saves by raising the pile-on.

On each visit, a pod can serve the demand for its SKUs that has accumulated since its last visit.
Let :math:`D_k` be this demand for SKU k, in units; it is assumed to be Poisson with mean
:math:`\mu_k`. A pod with q units of SKU k serves :math:`g_k(q) = E[\min(q, D_k)]` units of the SKU
on average. With u more units it serves :math:`g_k(q + u) - g_k(q)` more (*coverage*). The coverage
is large if the SKU is in demand and scarce in the pod, and small if the SKU is plentiful there.
With each line of SKU k, :math:`a_{kh}` lines of SKU h are ordered on average (*affinity*); if the
pod also holds SKU h, these lines need no separate visit. Each additional unit served saves its
share of the robot time of a visit, which is the time of a visit divided by the pile-on:

.. math::

    worth_{bp} = \frac{visit}{pileon} \bigl(g_k(q_{kp} + u_b) - g_k(q_{kp})\bigr)
    \Bigl(1 + \sum_{h \in p, h \ne k} a_{kh}\Bigr)

with k the SKU of bundle b, :math:`u_b` the units of the bundle, :math:`q_{kp}` the units of SKU k
in pod p, and :math:`h \in p` the SKUs in pod p. (Spread of SKUs over pods: Lamballais, Roy,
de Koster 2020; affinity: the "Correlative" rule of RAWSim-O. Expressing both in robot time is our
addition.)
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.special import pdtr, pdtrc

from rmfs.solvers.models.checks import integers, number, reals, require


def bundle_worth_s(
    stock: ArrayLike,
    sku: ArrayLike,
    units: ArrayLike,
    wanted_per_visit: ArrayLike,
    affinity: ArrayLike | None = None,
    *,
    visit_s: float,
    pile_on: float,
) -> NDArray[np.float64]:
    """Compute the worth of every bundle in every pod.

    Parameters
    ----------
    stock
        Units of each SKU in each pod, including bundles already assigned to the pod, shape (K, P).
    sku, units
        SKU and units of each bundle, shape (B,).
    wanted_per_visit
        Mean number of units of each SKU that orders demand between two visits of a pod, shape (K,).
    affinity
        Mean number of lines of SKU h (column h) that are ordered with a line of SKU k (row k),
        shape (K, K); the diagonal is ignored. Default: no such lines.
    visit_s
        Robot time of a visit, in s.
    pile_on
        Mean number of units picked per visit, positive.

    Returns
    -------
    Robot time saved, shape (B, P), in s.

    Raises
    ------
    ModelError
        If a shape or a value is wrong.
    """
    held = integers("stock", stock, (None, None), low=0)
    skus = len(held)
    kind = integers("sku", sku, (None,), low=0, high=skus - 1)
    more = integers("units", units, (len(kind),), low=0)
    mean = reals("wanted_per_visit", wanted_per_visit, (skus,), low=0)[kind, np.newaxis]
    number("visit_s", visit_s, low=0)
    require(pile_on > 0, "pile_on", f"must be positive, is {pile_on}")
    before, size = held[kind], more[:, np.newaxis]
    # far fewer different amounts than pods: look them up
    served = expected_served(np.arange(int((before + size).max(initial=0)) + 1), mean)
    added = np.take_along_axis(served, before + size, axis=1)
    added -= np.take_along_axis(served, before, axis=1)
    worth = (visit_s / pile_on) * np.maximum(added, 0.0)
    if affinity is None:
        return worth
    related = reals("affinity", affinity, (skus, skus), low=0)[kind]
    related[np.arange(len(kind)), kind] = 0.0
    return worth * (1.0 + related @ (held > 0).astype(np.float64))


def expected_served(units: NDArray[np.int64], mean: NDArray[np.float64]) -> NDArray[np.float64]:
    r"""Return :math:`E[\min(q, D)]` of a Poisson demand D.

    This expected value equals :math:`\mu P(D \le q - 2) + q P(D \ge q)`.

    Parameters
    ----------
    units
        Units q, any shape.
    mean
        Mean :math:`\mu` of the demand; broadcasts with `units`.

    Returns
    -------
    Expected units served, in the broadcast shape.
    """
    few = np.where(units >= 2, pdtr(np.maximum(units - 2, 0), mean), 0.0)
    many = np.where(units >= 1, pdtrc(np.maximum(units - 1, 0), mean), 1.0)
    served: NDArray[np.float64] = mean * few + units * many
    return served

r"""What a bundle is worth in a pod: the robot time its units will save by raising the pile-on.

When a pod is visited, it can serve what has come up of its SKUs. Let the demand for SKU k that a
visit meets be Poisson with mean :math:`\mu_k`. A pod with :math:`q` units of it serves
:math:`g_k(q) = E[\min(q, D_k)]` of them, so u more units add *coverage*
:math:`g_k(q + u) - g_k(q)`: much where the SKU is wanted and missing, little where it abounds.
Whoever orders k orders :math:`a_{kh}` lines of SKU h with it (*affinity*): if the pod holds h too,
these need no visit of their own. A unit served on the side saves its share of a visit:

.. math::

    worth_{bp} = \frac{visit}{pileon} \bigl(g_k(q_{kp} + u_b) - g_k(q_{kp})\bigr)
    \Bigl(1 + \sum_{h \in p, h \ne k} a_{kh}\Bigr)

with k the SKU of bundle b. (Spread of SKUs over pods: Lamballais, Roy, de Koster 2020; affinity:
the "Correlative" rule of RAWSim-O. That both are expressed in robot time is ours.)
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
    """Rate every pod for every bundle.

    Parameters
    ----------
    stock
        Units of each SKU in each pod, or promised to it, shape (K, P).
    sku, units
        SKU and units of each bundle, shape (B,).
    wanted_per_visit
        Units of each SKU that orders want while a pod is away between two visits, shape (K,).
    affinity
        Lines of SKU h ordered with a line of SKU k, shape (K, K), row k. Default: none.
    visit_s
        Robot time of a visit, in s.
    pile_on
        Units per visit, positive.

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

    It is :math:`\mu P(D \le q - 2) + q P(D \ge q)`.

    Parameters
    ----------
    units
        Units q, any shape.
    mean
        Mean of the demand, of a shape that fits.

    Returns
    -------
    Units served, of the common shape.
    """
    few = np.where(units >= 2, pdtr(np.maximum(units - 2, 0), mean), 0.0)
    many = np.where(units >= 1, pdtrc(np.maximum(units - 1, 0), mean), 1.0)
    served: NDArray[np.float64] = mean * few + units * many
    return served

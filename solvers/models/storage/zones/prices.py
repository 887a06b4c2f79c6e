r"""The prices of places: a bound by duality, and a rule that stores pods by the prices.

Symbols not explained here are those of `zones.data`. Let :math:`p_j \ge 0` be the price of a place
in zone j and :math:`d_j = 2 \gamma_j f_j` the delay that one more visit by a pod from the zone
causes, to itself and to others, at the traffic :math:`f_j`. As :math:`\gamma f^2 \ge \gamma f_j^2 +
2 \gamma f_j (f - f_j)`, every :math:`p` and every :math:`f` give the bound

.. math::

    \sum_i m_i u_i - \sum_j k_j p_j - \sum_j \gamma_j f_j^2, \qquad
    u_i = \min_j r_i (t_{ij} + d_j) + p_j

For an optimal plan and its prices, the bound equals the robot time. The *worth* of a pod of class i
is :math:`u_i`, its hourly cost in its best zone. The rule rates a stay of a pod at a place by

.. math::

    travel + d_j + stay \cdot (p_j - u_i)

where travel is the robot time for storing the pod at the place and for fetching it from there, and
stay is the length of the stay in hours. If travel is :math:`t_{ij}` and stay is :math:`1 / r_i`,
the rating is 0 for the zones in which an optimal plan stores the class, and at least 0 for all
others. A shorter drive, or a stay that is untypical of the class, changes the ranking.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rmfs.solvers.models.storage.zones.data import ZonePlan, Zones, traffic_per_h

_TINY = 2.0**-46
"""Upper bound on the relative rounding error of the dual value after a few thousand operations."""


@dataclass(frozen=True)
class Prices:
    """Dual prices of zones and classes in the steady state.

    Attributes
    ----------
    place_per_h
        Price of a place in each zone, shape (J,), in s/h.
    delay_s
        Delay that one more visit by a pod from each zone causes to itself and to other visits,
        shape (J,), in s.
    worth_per_h
        Cost of a pod of each class in its best zone, shape (I,), in s/h.
    """

    place_per_h: NDArray[np.float64]
    delay_s: NDArray[np.float64]
    worth_per_h: NDArray[np.float64]

    @classmethod
    def of(cls, data: Zones, plan: ZonePlan) -> Prices:
        """Compute the prices of a plan.

        Parameters
        ----------
        data
            The problem.
        plan
            A plan; an optimal one yields optimal prices.
        """
        delay_s = 2.0 * data.congestion_s_h * traffic_per_h(data, plan.standing)
        place = np.maximum(plan.price_per_h, 0.0)
        each = data.rate_per_h[:, np.newaxis] * (data.visit_s + delay_s) + place
        return cls(place, delay_s, each.min(axis=1, initial=math.inf))


def price_bound(data: Zones, plan: ZonePlan) -> float:
    """Return a lower bound on the robot time of every plan, from the prices of one plan.

    Parameters
    ----------
    data
        The problem, with at least one zone.
    plan
        Any plan; for an optimal one, the bound equals its robot time.

    Returns
    -------
    The dual value in s/h, reduced by the largest possible rounding error.
    """
    prices = Prices.of(data, plan)
    given = data.pods * np.where(data.pods > 0, prices.worth_per_h, 0.0)
    paid = data.places * prices.place_per_h
    bent = data.congestion_s_h * traffic_per_h(data, plan.standing) ** 2
    # traffic enters twice: in the delays and in what is subtracted
    size = math.fsum(np.abs(given)) + math.fsum(paid) + 2.0 * math.fsum(bent)
    return math.fsum(given) - math.fsum(paid) - math.fsum(bent) - _TINY * size


def expected_stay_h(rate_per_h: NDArray[np.float64], longest_h: float) -> NDArray[np.float64]:
    """Estimate how long each pod stays at its place until it is needed again.

    Parameters
    ----------
    rate_per_h
        Visit rate of each pod, any shape, in 1/h.
    longest_h
        Upper limit of the estimate, in h, positive.

    Returns
    -------
    Expected stay of each pod, of the same shape, in h.
    """
    stay_h: NDArray[np.float64] = 1.0 / np.maximum(rate_per_h, 1.0 / longest_h)
    return stay_h


def place_values(
    prices: Prices,
    travel_s: NDArray[np.float64],
    *,
    zone: NDArray[np.int64],
    pod_class: NDArray[np.int64],
    stay_h: NDArray[np.float64],
) -> NDArray[np.float64]:
    """Rate each place for each pod by the rule of the module docstring.

    The rating is travel plus delay plus expected stay times the difference between the price of the
    place and the worth of the pod.

    Parameters
    ----------
    prices
        Prices of the steady state.
    travel_s
        Robot time for storing each pod at each place now and for fetching it from there, shape
        (P, L), in s; +inf where a pod may not be stored.
    zone
        Zone of each place, shape (L,).
    pod_class
        Class of each pod, shape (P,).
    stay_h
        Expected stay of each pod, shape (P,), in h; see `expected_stay_h`.

    Returns
    -------
    Rating of each place for each pod, shape (P, L), in s of robot time; lower is better.
    """
    rent = prices.place_per_h[zone] - prices.worth_per_h[pod_class][:, np.newaxis]
    values: NDArray[np.float64] = travel_s + prices.delay_s[zone] + stay_h[:, np.newaxis] * rent
    return values

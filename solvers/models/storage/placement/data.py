r"""The problem: a batch of pods to be stored, and the free storage locations (places).

.. math::

    \min \sum_{p,l} (travel_{pl} + visits_p \cdot access_l)\, x_{pl}, \quad
    \sum_l x_{pl} = 1, \quad \sum_p x_{pl} \le 1

Here :math:`x_{pl}` is 1 if pod p goes to place l. Robot time now is weighed against robot time
later: for a pod that is needed again soon, a longer drive to a place near the stations pays off.
This is the batch form of the "cheapest place" rule of Krenzler, Xie, Li 2018. If no visits are
expected, only the travel time counts, as in nearest-place storage.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rmfs.solvers.models.checks import costs, reals


@dataclass(frozen=True)
class Placement:
    """Pods to be stored and free places.

    Parameters
    ----------
    travel_s
        Robot time from where each pod is now to each place, set-down included, shape (P, L), in s;
        +inf where a pod may not be stored.
    access_s
        Robot time for taking a pod from each place to a station and back on a future visit, shape
        (L,), in s.
    visits
        Number of visits to stations that each pod is expected to make from its new place, shape
        (P,); see `expected_visits`.

    Raises
    ------
    ModelError
        If a shape or a value is wrong.
    """

    travel_s: NDArray[np.float64]
    access_s: NDArray[np.float64]
    visits: NDArray[np.float64]

    def __post_init__(self) -> None:
        travel_s = costs("travel_s", self.travel_s, (None, None), low=0)
        pods, places = travel_s.shape
        object.__setattr__(self, "travel_s", travel_s)
        object.__setattr__(self, "access_s", reals("access_s", self.access_s, (places,), low=0))
        object.__setattr__(self, "visits", reals("visits", self.visits, (pods,), low=0))

    @property
    def cost_s(self) -> NDArray[np.float64]:
        """Robot time for storing each pod at each place, expected visits included, shape (P, L).

        The unit is s; +inf where a pod may not be stored.
        """
        return self.travel_s + np.outer(self.visits, self.access_s)


def objective(data: Placement, place: NDArray[np.int64]) -> float:
    """Return the robot time of a placement, in s.

    Parameters
    ----------
    data
        The problem.
    place
        Place of each pod, shape (P,).
    """
    pods = np.arange(len(place))
    later = data.visits * data.access_s[place]
    return float((data.travel_s[pods, place] + later).sum())


def violations(data: Placement, place: NDArray[np.int64]) -> list[str]:
    """List the conditions that a placement violates; empty if the placement is feasible.

    Parameters
    ----------
    data
        The problem.
    place
        Place of each pod, shape (P,).
    """
    pods, places = data.travel_s.shape
    if place.shape != (pods,) or not ((place >= 0) & (place < places)).all():
        return ["place must have a location for each pod"]
    found = []
    if len(np.unique(place)) < pods:
        found.append("two pods are put at one location")
    if np.isinf(data.travel_s[np.arange(pods), place]).any():
        found.append("a pod is put at a location that is not allowed")
    return found

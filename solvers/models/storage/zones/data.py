r"""The problem: the mean number of pods of each class in each zone in the steady state.

.. math::

    \min \sum_{ij} r_i t_{ij} x_{ij} + \sum_j \gamma_j f_j^2, \quad
    f_j = \sum_i r_i x_{ij}, \quad
    \sum_j x_{ij} = m_i, \quad \sum_i x_{ij} \le k_j, \quad x \ge 0

Of the :math:`m_i` pods of class i, :math:`x_{ij}` are in zone j on average; the zone has
:math:`k_j` storage locations (places). A pod of class i visits a station :math:`r_i` times an hour.
A visit by a pod from zone j takes :math:`t_{ij}` seconds of robot time plus a delay of
:math:`\gamma_j f_j` seconds, which grows with the traffic :math:`f_j` of the zone: the number of
visits per hour that its pods make. The objective is robot time in seconds per hour. Without
congestion this is the transportation problem of class-based storage (Hausman, Schwarz, Graves
1976); the quadratic cost makes busy zones expensive before they are full.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rmfs.solvers.models.checks import reals

_TOLERANCE = 1e-9
"""Relative error allowed in counts of pods."""


@dataclass(frozen=True)
class Zones:
    """Classes of pods and zones of places.

    The *traffic* of a zone is the number of visits to stations that its pods make per hour.

    Parameters
    ----------
    visit_s
        Robot time for taking a pod of each class from each zone to the station and back, shape
        (I, J), in s.
    rate_per_h
        Number of visits that a pod of each class makes per hour, shape (I,), in 1/h.
    pods
        Number of pods of each class, shape (I,).
    places
        Number of places of each zone, shape (J,).
    congestion_s_h
        Congestion coefficient of each zone, shape (J,), in s h: a visit by a pod from the zone is
        delayed by this coefficient times the traffic of the zone.

    Raises
    ------
    ModelError
        If a shape or a value is wrong.
    """

    visit_s: NDArray[np.float64]
    rate_per_h: NDArray[np.float64]
    pods: NDArray[np.float64]
    places: NDArray[np.float64]
    congestion_s_h: NDArray[np.float64]

    def __post_init__(self) -> None:
        visit_s = reals("visit_s", self.visit_s, (None, None), low=0)
        classes, zones = visit_s.shape
        object.__setattr__(self, "visit_s", visit_s)
        for field, count in (
            ("rate_per_h", classes),
            ("pods", classes),
            ("places", zones),
            ("congestion_s_h", zones),
        ):
            checked = reals(field, getattr(self, field), (count,), low=0)
            object.__setattr__(self, field, checked)

    @property
    def fits(self) -> bool:
        """Whether there is a place for every pod."""
        return bool(self.pods.sum() <= self.places.sum() * (1.0 + _TOLERANCE))


def traffic_per_h(data: Zones, standing: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the number of visits per hour that the pods of each zone make, shape (J,).

    Parameters
    ----------
    data
        The problem.
    standing
        Number of pods of each class in each zone, shape (I, J).
    """
    visits: NDArray[np.float64] = (data.rate_per_h[:, np.newaxis] * standing).sum(axis=0)
    return visits


@dataclass(frozen=True)
class ZonePlan:
    """Mean number of pods in each zone, and the resulting prices of places.

    Attributes
    ----------
    standing
        Number of pods of each class in each zone, shape (I, J).
    price_per_h
        Robot time that one more place in each zone would save, shape (J,), in s/h.
    """

    standing: NDArray[np.float64]
    price_per_h: NDArray[np.float64]


def objective(data: Zones, plan: ZonePlan) -> float:
    """Return the robot time of a plan, in s/h.

    Parameters
    ----------
    data
        The problem.
    plan
        The plan.
    """
    driving = (data.rate_per_h[:, np.newaxis] * data.visit_s * plan.standing).sum()
    traffic = traffic_per_h(data, plan.standing)
    return float(driving + (data.congestion_s_h * traffic**2).sum())


def violations(data: Zones, plan: ZonePlan) -> list[str]:
    """List the conditions that a plan violates; empty if the plan is feasible.

    Parameters
    ----------
    data
        The problem.
    plan
        The plan.
    """
    found = []
    slack = _TOLERANCE * max(1.0, float(data.pods.sum()))
    if (plan.standing < 0).any():
        found.append("the number of pods in a zone is negative")
    if (np.abs(plan.standing.sum(axis=1) - data.pods) > slack).any():
        found.append("the pods of a class do not add up to their number")
    if (plan.standing.sum(axis=0) > data.places + slack).any():
        found.append("a zone has more pods than locations")
    return found

"""Pruning: keeps only the best pods of each bundle and the nearest useful stations of each pod."""

from __future__ import annotations

import dataclasses

import numpy as np
from numpy.typing import NDArray

from rmfs.solvers.models.replenishment.data import Replenishment


def best_pods(data: Replenishment, *, pods: int, stations: int) -> Replenishment:
    """Keep the best pods of every bundle and the nearest useful stations of every pod.

    A station is useful to a pod if it has room for a bundle that the pod may take. For each bundle,
    a pod is rated by the worth of storing the bundle in it, minus a share of the cost of the pod's
    shortest trip to a useful station. This share is the cost divided by the number of bundles of
    average size that fit into the pod. If at most `pods` pods can store a bundle, all of them are
    kept.

    Parameters
    ----------
    data
        The problem.
    pods
        Maximum number of pods to keep per bundle.
    stations
        Maximum number of stations to keep per pod; stations that are not useful are dropped.

    Returns
    -------
    The problem with fewer allowed pairs of bundle and pod, and of pod and station; ties go to the
    lowest index. The solutions of this smaller problem are feasible for the full problem, but its
    bounds do not hold for the full problem.
    """
    fits = data.space[:, np.newaxis] <= data.pod_space
    allowed = fits & np.isfinite(data.worth_s)
    smallest = np.where(allowed, data.space[:, np.newaxis], np.inf).min(axis=0, initial=np.inf)
    useful_s = np.where(smallest[:, np.newaxis] <= data.station_space, data.trip_s, np.inf)
    mean_space = max(float(data.space.mean()), 1e-9) if len(data.space) else 1.0
    shared = np.maximum(1.0, np.floor(data.pod_space / mean_space))
    rating = data.worth_s - useful_s.min(axis=1, initial=np.inf) / shared
    rating = np.where(fits, rating, -np.inf)
    worth_s = np.where(_first(-rating, pods) & fits, data.worth_s, -np.inf)
    near_s = np.where(_first(useful_s, stations), useful_s, np.inf)
    return dataclasses.replace(data, worth_s=worth_s, trip_s=near_s)


def _first(values: NDArray[np.float64], count: int) -> NDArray[np.bool_]:
    """Mark the `count` least values of each row; ties go to the lowest index."""
    order = np.argsort(values, axis=1, kind="stable")[:, :count]
    marked = np.zeros(values.shape, bool)
    np.put_along_axis(marked, order, values=True, axis=1)
    return marked

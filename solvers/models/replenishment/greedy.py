"""Bring one pod after the other, always the pod whose trip has the greatest gain."""

from __future__ import annotations

import heapq
import math
from time import perf_counter

import numpy as np
from numpy.typing import NDArray

from rmfs.solvers.models.replenishment.data import (
    LEFT,
    Replenishment,
    Stocking,
    objective,
    violations,
)
from rmfs.solvers.models.replenishment.polish import polished
from rmfs.solvers.models.solution import NO_LIMITS, Limits, Solution, solution_of_rule


def solve(
    data: Replenishment,
    limits: Limits = NO_LIMITS,
    *,
    seed: int = 0,
    start: Stocking | None = None,
) -> Solution[Stocking]:
    """Repeatedly bring the pod of greatest gain, with the bundles that gain most per space unit.

    The gain of a bundle in a pod is its worth there plus the cost of leaving it; if the bundle must
    be stored, the gain is a large number. The gain of a pod is that of its bundles minus the cost
    of its trip.

    Gains are expected to decrease as bundles and space are used up. A gain computed earlier is
    therefore treated as an upper bound, and only the pods at the top of a heap are rated again. The
    initial rating of a pod is the gain that it would have if bundles could be divided.

    Returns
    -------
    The pod of each bundle and the station of each pod; ties go to the lowest index. The status is
    LIMIT if a bundle that must be stored is left, and INFEASIBLE if no pod may store such a bundle.
    The bound lets every bundle choose its best pod or be left, regardless of the other bundles and
    of the cost of trips.
    """
    begin = perf_counter()
    best = np.minimum(-data.worth_s.max(axis=1, initial=-math.inf), data.leave_s)
    bound = math.fsum(best) if np.isfinite(best).all() else math.inf
    filling = Filling(data)
    stocking = polished(data, filling.run())
    return solution_of_rule(
        None if violations(data, stocking) else stocking,
        lambda values: objective(data, values),
        bound=bound,
        work=float(filling.scored),
        began=begin,
    )


class Filling:
    """The state of the heuristic: assigned bundles and pods, and the remaining space of stations.

    Parameters
    ----------
    data
        The problem.

    Attributes
    ----------
    scored
        Number of pairs of bundle and pod that have been rated so far.
    """

    def __init__(self, data: Replenishment) -> None:
        self._data = data
        self._pod = np.full(len(data.space), LEFT, np.int64)
        self._station = np.full(len(data.pod_space), LEFT, np.int64)
        self._room = data.station_space.tolist()
        self._space = data.space.tolist()
        self._gain = self._gains()
        density = self._gain / np.maximum(data.space, 1e-9)[:, np.newaxis]
        self._order = np.argsort(-density, axis=0, kind="stable")
        useful = (self._gain > 0).sum(axis=0).tolist()
        self._wanted = [self._order[:n, pod].tolist() for pod, n in enumerate(useful)]
        self.scored = data.worth_s.size

    def run(self) -> Stocking:
        """Bring pods until no pod has a positive gain, and return the stocking."""
        pods, stations = np.nonzero(np.isfinite(self._data.trip_s))
        most = (self._most()[pods] - self._data.trip_s[pods, stations]).tolist()
        options = zip(most, pods.tolist(), stations.tolist(), strict=True)
        heap = [(-gain, pod, station) for gain, pod, station in options if gain > 0]
        heapq.heapify(heap)
        while heap:
            _, pod, station = heapq.heappop(heap)
            if self._station[pod] != LEFT:
                continue
            gain, bundles = self.gain(pod, station, self._wanted[pod])
            if gain <= 0:
                continue
            if heap and -gain > heap[0][0]:
                heapq.heappush(heap, (-gain, pod, station))
                continue
            self.bring(pod, station, bundles)
        return Stocking(self._pod, self._station)

    def bring(self, pod: int, station: int, bundles: list[int]) -> None:
        """Bring a pod to a station and store bundles in it.

        Parameters
        ----------
        pod, station
            The pod, which has not been brought yet, and the station.
        bundles
            Bundles that are not stored yet; together they fit into the pod and the station.
        """
        self._station[pod] = station
        self._pod[bundles] = pod
        self._room[station] -= sum(self._space[bundle] for bundle in bundles)

    def gain(self, pod: int, station: int, wanted: list[int]) -> tuple[float, list[int]]:
        """Return the gain of bringing a pod to a station, and the bundles that it would get there.

        Parameters
        ----------
        pod, station
            The pod and the station.
        wanted
            Bundles in the order in which the pod should take them. Bundles that are already stored,
            or do not fit, are skipped.
        """
        room = min(float(self._data.pod_space[pod]), self._room[station])
        total, chosen = -float(self._data.trip_s[pod, station]), []
        for bundle in wanted:
            if self._pod[bundle] == LEFT and self._space[bundle] <= room:
                room -= self._space[bundle]
                total += float(self._gain[bundle, pod])
                chosen.append(bundle)
        self.scored += len(wanted)
        return total, chosen

    def _gains(self) -> NDArray[np.float64]:
        """Return the gain of storing each bundle in each pod, at least 0, shape (B, P)."""
        data = self._data
        must = np.isinf(data.leave_s)
        finite = np.abs(data.worth_s[np.isfinite(data.worth_s)]).sum()
        trips = data.trip_s[np.isfinite(data.trip_s)].sum()
        # more than all else together
        urgent = 1.0 + finite + trips + np.abs(data.leave_s[~must]).sum()
        gain = data.worth_s + np.where(must, urgent, data.leave_s)[:, np.newaxis]
        fits = data.space[:, np.newaxis] <= data.pod_space
        return np.where(fits, np.maximum(gain, 0.0), 0.0)

    def _most(self) -> NDArray[np.float64]:
        """Return the gain of each pod if bundles could be divided and trips cost nothing."""
        data = self._data
        gain = np.take_along_axis(self._gain, self._order, axis=0)
        space = data.space[self._order]
        before = np.cumsum(space, axis=0) - space
        share = np.clip((data.pod_space - before) / np.maximum(space, 1e-9), 0.0, 1.0)
        most: NDArray[np.float64] = (gain * np.where(space > 0, share, 1.0)).sum(axis=0)
        return most

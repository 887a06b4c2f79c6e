"""Improve a stocking by single moves: shift a bundle to a pod already brought, or drop a trip."""

from __future__ import annotations

import math

import numpy as np

from rmfs.solvers.models.replenishment.data import LEFT, Replenishment, Stocking

_GAIN_S = 1e-9
"""Minimum gain of a move, larger than rounding errors."""


def polished(data: Replenishment, stocking: Stocking) -> Stocking:
    """Move bundles and drop trips until no single move gains anything.

    Parameters
    ----------
    data
        The problem.
    stocking
        A stocking that respects the capacities of pods and stations. It may leave bundles that must
        be stored.

    Returns
    -------
    A stocking whose cost is not higher. It leaves no more of the bundles that must be stored than
    `stocking` does.
    """
    moves = _Moves(data, stocking)
    while moves.move_bundles() or moves.drop_pods():
        pass
    return Stocking(moves.pod, moves.station)


class _Moves:
    """A stocking and the free space that it leaves in pods and at stations."""

    def __init__(self, data: Replenishment, stocking: Stocking) -> None:
        self._data = data
        self.pod, self.station = stocking.pod.copy(), stocking.station.copy()
        stored = self.pod != LEFT
        space, pods = data.space[stored], self.pod[stored]
        self._pod_room = data.pod_space - np.bincount(
            pods, weights=space, minlength=len(data.pod_space)
        )
        self._station_room = data.station_space - np.bincount(
            self.station[pods], weights=space, minlength=len(data.station_space)
        )
        # as if a bundle left had this worth
        self._left_worth = np.where(np.isinf(data.leave_s), -math.inf, -data.leave_s)

    def _worth(self, bundle: int) -> float:
        pod = int(self.pod[bundle])
        return float(self._left_worth[bundle] if pod == LEFT else self._data.worth_s[bundle, pod])

    def move_bundles(self) -> bool:
        """Move bundles to the brought pods where they are worth most; return whether any moved."""
        data, moved = self._data, False
        brought = np.flatnonzero(self.station != LEFT)
        at = self.station[brought]
        for bundle, space in enumerate(data.space.tolist()):
            now = int(self.pod[bundle])
            here = LEFT if now == LEFT else int(self.station[now])
            # a move within a station takes no further room of it
            room = (self._station_room[at] >= space) | (at == here)
            fits = room & (self._pod_room[brought] >= space)
            worth = np.where(fits, data.worth_s[bundle, brought], -math.inf)
            best = int(worth.argmax()) if len(worth) else LEFT
            if best != LEFT and worth[best] > self._worth(bundle) + _GAIN_S:
                self._put(bundle, int(brought[best]))
                moved = True
        return moved

    def drop_pods(self) -> bool:
        """Drop trips that cost more than their bundles gain; return whether any was dropped."""
        data, dropped = self._data, False
        for pod in np.flatnonzero(self.station != LEFT).tolist():
            bundles = np.flatnonzero(self.pod == pod).tolist()
            gain = math.fsum(self._worth(one) - float(self._left_worth[one]) for one in bundles)
            if gain < data.trip_s[pod, self.station[pod]] - _GAIN_S:
                for bundle in bundles:
                    self._put(bundle, LEFT)
                self.station[pod] = LEFT
                dropped = True
        return dropped

    def _put(self, bundle: int, pod: int) -> None:
        space = float(self._data.space[bundle])
        for which, sign in ((int(self.pod[bundle]), 1.0), (pod, -1.0)):
            if which != LEFT:
                self._pod_room[which] += sign * space
                self._station_room[self.station[which]] += sign * space
        self.pod[bundle] = pod

"""Repositioning utility: moves the pod that is farthest from its target rank."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from rmfs.control.psa.ranking import Ranking, RankParameters
from rmfs.control.repositioning import Move, Pauses, Pausing, Seconds, nearest_place

if TYPE_CHECKING:
    from rmfs.control.view import View
    from rmfs.world.robots import Robot

_TRIES = 8
"""Maximum number of pods for which a better place is sought in one search."""


class UtilityParameters(RankParameters, Pauses):
    """Parameters of repositioning utility."""

    search_pause_s: Seconds = 120.0
    """Time, in seconds, after an unsuccessful search for a move before the next search."""


class Utility(Pausing[UtilityParameters]):
    """Moves the pod whose location has a rank that differs most from the pod's target rank.

    The ranks of storage locations, the target ranks of pods, and the search for empty locations
    outward from a pod's target rank are as in PSA `utility`. Of the locations found, the one
    nearest to the pod by Manhattan distance is chosen; ties go to the waypoint with the lowest
    number. The pod is moved only if the move reduces the difference between the two ranks.
    Otherwise, the pod with the next largest difference is tried; at most eight pods are tried in
    one search. If several pods have the same difference, the pod with the lowest number comes
    first.
    """

    parameters_model = UtilityParameters

    def __init__(self, parameters: UtilityParameters, view: View, rng: np.random.Generator) -> None:
        super().__init__(parameters, view, rng)
        self._ranking = Ranking(view, parameters)

    def find(self, robot: Robot) -> Move | None:
        """Find a move, trying first the pods that are farthest from their target ranks."""
        storage = self.view.storage
        rank_at = np.zeros(self.view.layout.waypoints, np.intp)
        rank_at[storage.places] = self._ranking.prominence.rank
        targets = self._ranking.targets()
        away = np.abs(rank_at[storage.pod_waypoint] - targets)
        away[~storage.is_at_hand] = 0
        for pod in np.argsort(-away, kind="stable")[:_TRIES].tolist():
            if not away[pod]:
                return None
            target = int(targets[pod])
            place = nearest_place(self.view, pod, self._ranking.seen(target), "manhattan")
            if place >= 0 and abs(int(rank_at[place]) - target) < away[pod]:
                return Move(pod, place)
        return None

"""Joint controllers: POA that takes the decisions of PPS and PSA, ROA that takes that of RPS."""

from __future__ import annotations

import numpy as np

from rmfs.control.decisions import PromiseBundle, ReleasePod
from rmfs.control.poa.pod_match import PodMatch
from rmfs.control.pps.lexicographic import Lexicographic
from rmfs.control.problems import Problem
from rmfs.control.psa.nearest import Nearest
from rmfs.control.roa.random import RandomStation
from rmfs.control.rps import ReplenishmentPodSelection


class Joint(PodMatch):
    """Chooses pods and places as well, by the rules made for that."""

    decides = frozenset({Problem.PPS, Problem.PSA})

    def __init__(self, parameters, view, rng):
        super().__init__(parameters, view, rng)
        self._pps = Lexicographic(Lexicographic.parameters_model(), view, rng)
        self._psa = Nearest(Nearest.parameters_model(), view, rng)
        self.pick_pod = self._pps.pick_pod
        self.replenishment_pod = self._pps.replenishment_pod
        self.next_station = self._pps.next_station
        self.place = self._psa.place


class JointSupply(RandomStation):
    """Puts each bundle into the emptiest pod at once, and holds nothing back."""

    decides = frozenset({Problem.RPS})
    subscriptions = ReplenishmentPodSelection.triggers

    def decide(self):
        inventory = self.view.inventory
        for bundle in list(self.view.bundles.without_pod.values()):
            room = inventory.capacity - inventory.load
            pod = int(np.argmax(room))
            if room[pod] >= bundle.space:
                yield PromiseBundle(bundle, pod)
                yield ReleasePod(pod)
        yield from super().decide()

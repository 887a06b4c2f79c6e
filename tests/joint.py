"""A joint controller: POA that takes the decisions of PPS and PSA as well."""

from __future__ import annotations

from rmfs.control.poa.pod_match import PodMatch
from rmfs.control.pps.lexicographic import Lexicographic
from rmfs.control.problems import Problem
from rmfs.control.psa.nearest import Nearest


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

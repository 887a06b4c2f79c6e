"""PPS random: draws one of the pods with work at the station."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rmfs.control.pps import LateBinding, PodSelection
from rmfs.control.pps.candidates import Candidates, pick_candidates, replenishment_candidates

if TYPE_CHECKING:
    from collections.abc import Sequence

    from rmfs.world.robots import Robot
    from rmfs.world.stations import PickStation, ReplenishmentStation


class RandomPodParameters(LateBinding):
    """Parameters of PPS random."""

    prefer_same_tier: bool = True
    """Whether pods on the same tier as the robot and the station are preferred."""


class RandomPod(PodSelection[RandomPodParameters]):
    """Chooses a random pod with work at the station, or a random next station of a carried pod."""

    parameters_model = RandomPodParameters

    def pick_pod(self, robot: Robot, station: PickStation) -> int:
        """Draw one of the available pods that can serve an open request; -1 if there is none."""
        return self._any(pick_candidates(self.view, robot, station, self.parameters.consider))

    def replenishment_pod(self, robot: Robot, station: ReplenishmentStation) -> int:
        """Draw one of the available pods for which bundles wait; -1 if there is none."""
        return self._any(replenishment_candidates(self.view, robot, station))

    def next_station(self, robot: Robot, stations: Sequence[int]) -> int:
        """Draw one of the stations."""
        return stations[self.draw(len(stations))]

    def _any(self, candidates: Candidates) -> int:
        pods = candidates.pods
        if not len(pods):
            return -1
        if self.parameters.prefer_same_tier and self.view.travel.tiers > 1:
            away = candidates.other_tiers()
            pods = pods[away == away.min()] if not isinstance(away, int) else pods
        return int(pods[self.draw(len(pods))])

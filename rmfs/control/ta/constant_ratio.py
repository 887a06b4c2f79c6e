"""TA constant-ratio: a fixed share of the robots works for pick stations."""

from __future__ import annotations

from typing import Annotated

import pydantic

from rmfs.control.ta.balance import deal
from rmfs.control.ta.station_teams import StationTeams, TeamParameters
from rmfs.control.ta.stations import by_kind


class ConstantRatioParameters(TeamParameters):
    """Parameters of TA constant-ratio."""

    pick_share: Annotated[float, pydantic.Field(ge=0, le=1)] = 0.75
    """Share of the robots that work for pick stations; their number is rounded down."""


class ConstantRatio(StationTeams[ConstantRatioParameters]):
    """Assigns a fixed share of robots to pick stations, the others to replenishment stations.

    Only stations that are active or have work left get robots. Within a kind, these stations get
    one robot each in turn; those farthest from the middle of the tier come first. Every `period_s`
    seconds, if the set of these stations has changed, robots are reassigned, the nearest pair of
    robot and station first. Every robot works only for its station, and continues with its pod as
    long as the pod has work at this station.
    """

    parameters_model = ConstantRatioParameters

    def first_stations(self) -> frozenset[int]:
        """Return the stations that are active or have work left; if none, all stations."""
        return self.stations_now() or super().first_stations()

    def stations_now(self) -> frozenset[int]:
        """Return the stations that are active or have work left.

        If there are none, return the stations to which robots were last assigned.
        """
        found = frozenset(s.index for s in self.view.stations if s.active or s.has_work)
        return found or self._active

    def goals(self, active: frozenset[int]) -> dict[int, int]:
        """Return the number of robots that each of the given stations should have."""
        order = [station for station in self._far_first if station in active]
        robots = len(self.view.robots)
        picks, others = by_kind(self.view, order)
        for_picks = int(robots * self.parameters.pick_share + 1e-9)
        goals = dict.fromkeys(order, 0)
        deal(for_picks, picks, robots, goals)
        deal(robots - for_picks, others, robots, goals)
        return goals

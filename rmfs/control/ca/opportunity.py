"""CA opportunity: robots charge when they have no work."""

from __future__ import annotations

from math import inf
from typing import TYPE_CHECKING, Annotated, Any

import pydantic

from rmfs.control.ca.levels import ByLevel, Level, LevelParameters, Share
from rmfs.control.decisions import Charge, Unplug
from rmfs.control.problems import Trigger

if TYPE_CHECKING:
    from collections.abc import Iterator

    from rmfs.control.asks import Ask, By
    from rmfs.world.charging import RecoveryStation
    from rmfs.world.robots import Robot


class OpportunityParameters(LevelParameters):
    """Parameters of CA opportunity."""

    below_share: Share = 0.25
    """A robot charges if its battery level is below this share of the capacity, even if there is
    work."""
    until_share: Level = 0.8
    """Battery level (share of the capacity) at which a charging robot leaves its place at the
    latest."""
    idle_below_share: Share = 0.75
    """A robot at rest charges if a charging place is free and the robot's battery level is below
    this share of the capacity."""
    leave_above_share: Share = 0.4
    """While work waits and no robot is at rest, charging robots are called back, one at a time, if
    their battery level is above this share of the capacity and suffices for any task."""
    period_s: Annotated[float, pydantic.Field(gt=0, allow_inf_nan=False)] = 30.0
    """Time, in seconds, between checks whether robots at rest should charge."""


class Opportunity(ByLevel[OpportunityParameters]):
    """Lets robots charge while they have no work, and calls them back when there is work.

    A robot at rest goes to a free energy station if its level is below `idle_below_share`. A robot
    below `below_share` charges even if there is work.
    """

    parameters_model = OpportunityParameters
    subscriptions = frozenset(
        {Trigger.ORDER_ASSIGNED, Trigger.ORDER_QUEUED, Trigger.BUNDLE_ASSIGNED}
    )

    def decide(self) -> Iterator[Charge | Unplug | Ask[Any] | By[Any]]:
        """Yield the decisions of the base class, then at most one that calls a robot back."""
        yield from super().decide()
        batteries, view = self.view.batteries, self.view
        work_waits = any(station.has_open_work for station in view.stations)
        if batteries is None or view.resting or not work_waits:
            return
        for station in view.chargers:
            here = station.robot
            enough = max(self.parameters.leave_above_share, batteries.enough_share)
            if here in station.tasks and batteries.share(here) > enough:
                yield Unplug(view.robots[here])
                return

    def next_event_s(self) -> float:
        """Return the simulated time, in s, of the next check of robots at rest.

        The result is inf if robots have no batteries.
        """
        period_s = self.parameters.period_s
        now_s = self.view.now_s
        return inf if self.view.batteries is None else (now_s // period_s + 1) * period_s

    def wanted_share(self, robot: Robot, share: float) -> float:
        """Return `until_share` if the robot's level is below its threshold, else 0.

        The threshold is `idle_below_share` for a robot at rest while an energy station is free, and
        `below_share` otherwise.
        """
        given, view = self.parameters, self.view
        free = any(not station.tasks for station in view.recovery_stations)
        low = given.idle_below_share if free and robot.index in view.resting else given.below_share
        return given.until_share if share < low else 0.0

    def places_for(self, robot: Robot, share: float) -> list[RecoveryStation]:
        """Return all energy stations or, if the robot need not charge now, the free ones."""
        stations = self.view.recovery_stations
        if share < self.parameters.below_share:
            return stations
        return [station for station in stations if not station.tasks]

    def target_share(self) -> float:
        """Return the level up to which robots charge, `until_share`."""
        return self.parameters.until_share

"""Shared parts of CA rules: charge levels, and how robots choose and give up charging places."""

from __future__ import annotations

from abc import abstractmethod
from typing import TYPE_CHECKING, Annotated, Any, TypeVar

import pydantic

from rmfs.control.base import Parameters
from rmfs.control.ca import ChargeAssignment
from rmfs.control.ca.places import PlaceRule, choose
from rmfs.control.decisions import Charge, Unplug

if TYPE_CHECKING:
    from collections.abc import Iterator

    from rmfs.control.asks import Ask, By
    from rmfs.world.charging import RecoveryStation
    from rmfs.world.robots import Robot

Share = Annotated[float, pydantic.Field(ge=0, le=1)]
Level = Annotated[float, pydantic.Field(gt=0, le=1)]


class PlaceParameters(Parameters):
    """Parameters of all rules that send robots to charging places."""

    place: PlaceRule = "least-queued"
    """Choice of the charging place: `least-queued` (fewest robots at the place or on their way
    there), `nearest`, or `soonest` (least total charging time of the robots at the place or on
    their way there)."""
    hand_over_share: Level | None = None
    """A charging robot gives up its place if its level suffices for any task and exceeds the level
    of a robot in the queue by more than this share of the capacity. Default: never."""


class LevelParameters(PlaceParameters):
    """Parameters of rules with a level at which charging starts and another at which it ends."""

    below_share: Share = 0.3
    """A robot charges when its battery level falls below this share of the capacity."""
    until_share: Level = 0.8
    """Battery level (share of the capacity) up to which a robot charges."""

    @pydantic.model_validator(mode="after")
    def _in_order(self) -> LevelParameters:
        if self.below_share >= self.until_share:
            raise ValueError(
                f"below_share = {self.below_share:g} must be less than until_share = "
                f"{self.until_share:g}"
            )
        return self


P = TypeVar("P", bound=PlaceParameters)


class ByLevel(ChargeAssignment[P]):
    """Sends robots to charge; those with the lowest battery levels choose their places first."""

    @abstractmethod
    def wanted_share(self, robot: Robot, share: float) -> float:
        """Return the level up to which a robot with level `share` should charge now, or 0.

        Levels are shares of the capacity; 0 means that the robot should not charge.
        """

    def places_for(self, robot: Robot, share: float) -> list[RecoveryStation]:
        """Return the energy stations at which a robot with level `share` may charge now."""
        return self.view.recovery_stations

    def decide(self) -> Iterator[Charge | Unplug | Ask[Any] | By[Any]]:
        """Yield decisions that send robots to charge, then those that make them give up places."""
        batteries = self.view.batteries
        if batteries is None:
            return
        shares = batteries.shares().tolist()
        yield from self._send(shares)
        if self.parameters.hand_over_share is not None:
            yield from self._hand_over(shares, self.parameters.hand_over_share)

    def enough_share(self) -> float:
        """Return the level (share of capacity) at which the energy suffices for any task."""
        batteries = self.view.batteries
        return 0.0 if batteries is None else batteries.enough_share

    def _send(self, shares: list[float]) -> Iterator[Charge]:
        view = self.view
        robots = (*view.asking.values(), *view.resting.values())
        # a robot that has just left a place is not sent back at once
        empty = [robot for robot in robots if robot.pod < 0 and robot.station < 0]
        for robot in sorted(empty, key=lambda robot: (shares[robot.index], robot.index)):
            until = self.wanted_share(robot, shares[robot.index])
            if until <= shares[robot.index]:
                continue
            among = self.places_for(robot, shares[robot.index])
            station = choose(view, robot, self.parameters.place, among=among)
            if station < 0:
                return
            yield Charge(robot, station, until)

    def _hand_over(self, shares: list[float], gap: float) -> Iterator[Unplug]:
        """Make a robot leave its charger if a robot with a much lower level queues for it."""
        at = self.view.travel.robot_waypoint
        for station in self.view.chargers:
            here = station.robot
            if here not in station.tasks:
                continue
            queue = self.view.layout.stations[station.index].queue
            others = [robot for robot in station.tasks if robot != here]
            waiting = [shares[robot] for robot in others if at(robot) in queue]
            if not waiting:
                continue
            enough = max(min(waiting) + gap, self.enough_share())
            if shares[here] > enough:
                yield Unplug(self.view.robots[here])

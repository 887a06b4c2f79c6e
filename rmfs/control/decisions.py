"""What controllers may say. Each decision is applied before the controller is resumed."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from rmfs.world.orders import Bundle, Order
    from rmfs.world.robots import Robot


class AssignOrder(NamedTuple):
    """POA: put an order of the backlog on a pick station."""

    order: Order
    station: int


class SendBundle(NamedTuple):
    """ROA: handle a bundle at a replenishment station."""

    bundle: Bundle
    station: int


class PromiseBundle(NamedTuple):
    """RPS: keep room on a pod for a bundle, without releasing the decision yet."""

    bundle: Bundle
    pod: int


class ReleasePod(NamedTuple):
    """RPS: release what was promised to a pod, so that a station can be chosen."""

    pod: int


class BringForPicks(NamedTuple):
    """TA: bring a pod (or go on with the one carried) to a pick station."""

    robot: Robot
    pod: int
    station: int


class BringForBundles(NamedTuple):
    """TA: bring a pod (or go on with the one carried) to a replenishment station."""

    robot: Robot
    pod: int
    station: int


class Park(NamedTuple):
    """TA: store the pod the robot carries at a place."""

    robot: Robot
    place: int


class Rest(NamedTuple):
    """TA: wait at a place."""

    robot: Robot
    place: int


class SwitchStation(NamedTuple):
    """SA: let a station take new work, or stop it."""

    station: int
    active: bool


TaskDecision = BringForPicks | BringForBundles | Park | Rest
Decision = AssignOrder | SendBundle | PromiseBundle | ReleasePod | TaskDecision | SwitchStation

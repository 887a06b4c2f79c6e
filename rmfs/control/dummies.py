"""Dummies: placeholders for the controllers of problems that a joint controller decides.

A joint controller is the controller of one problem and also decides others, which it lists in
`decides`. For these other problems, and only for them, a controllers file selects a dummy. A dummy
makes no decisions: either it is never called, or it answers that there is nothing to do.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, ClassVar

from rmfs.control.base import NoParameters
from rmfs.control.ca import ChargeAssignment
from rmfs.control.poa import PickOrderAssignment
from rmfs.control.pps import LateBinding, PodSelection
from rmfs.control.psa import PodStorageAssignment
from rmfs.control.repositioning import Move, Repositioning
from rmfs.control.roa import ReplenishmentOrderAssignment
from rmfs.control.rps import ReplenishmentPodSelection
from rmfs.control.sa import StationActivation
from rmfs.control.ta import Consult, TaskAllocation

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from rmfs.control.decisions import (
        AssignOrder,
        Charge,
        PromiseBundle,
        ReleasePod,
        SendBundle,
        SwitchStation,
        TaskDecision,
    )
    from rmfs.control.problems import Trigger
    from rmfs.world.robots import Robot
    from rmfs.world.stations import PickStation, ReplenishmentStation

NEVER: frozenset[Trigger] = frozenset()


class DummyPOA(PickOrderAssignment[NoParameters]):
    """Leaves the assignment of orders to another controller."""

    is_dummy: ClassVar[bool] = True
    triggers = NEVER

    def decide(self) -> Iterator[AssignOrder]:
        """Yield nothing."""
        yield from ()


class DummyROA(ReplenishmentOrderAssignment[NoParameters]):
    """Leaves the choice of a station for each bundle to another controller."""

    is_dummy: ClassVar[bool] = True
    triggers = NEVER

    def decide(self) -> Iterator[SendBundle]:
        """Yield nothing."""
        yield from ()


class DummyRPS(ReplenishmentPodSelection[NoParameters]):
    """Leaves the choice of a pod for each bundle to another controller."""

    is_dummy: ClassVar[bool] = True
    triggers = NEVER

    def decide(self) -> Iterator[PromiseBundle | ReleasePod]:
        """Yield nothing."""
        yield from ()


class DummyPPS(PodSelection[LateBinding]):
    """Leaves the choice of pods to another controller.

    The parameters determine which units are bound to the pods that the other controller chooses.
    """

    is_dummy: ClassVar[bool] = True
    parameters_model = LateBinding

    def pick_pod(self, robot: Robot, station: PickStation) -> int:
        """Return -1: no pod."""
        return -1

    def replenishment_pod(self, robot: Robot, station: ReplenishmentStation) -> int:
        """Return -1: no pod."""
        return -1

    def next_station(self, robot: Robot, stations: Sequence[int]) -> int:
        """Return the first of the given stations."""
        return stations[0]


class DummyPSA(PodStorageAssignment[NoParameters]):
    """Leaves the choice of storage locations to another controller."""

    is_dummy: ClassVar[bool] = True

    def place(self, robot: Robot) -> int:
        """Return -1: no storage location."""
        return -1


class DummyRepositioning(Repositioning[NoParameters]):
    """Leaves the moves of idle pods to another controller."""

    is_dummy: ClassVar[bool] = True

    def move(self, robot: Robot) -> Move | None:
        """Return None: no move."""
        return None


class DummyTA(TaskAllocation[NoParameters]):
    """Leaves the tasks of robots to another controller."""

    is_dummy: ClassVar[bool] = True
    triggers = NEVER
    subscriptions = NEVER

    def decide(self, consult: Consult) -> Iterator[TaskDecision]:
        """Yield nothing."""
        yield from ()

    def rest_place(self, robot: Robot) -> int:
        """Return -1: the robot stays where it is."""
        return -1


class DummySA(StationActivation[NoParameters]):
    """Leaves the switching of stations to another controller; all stations are off at the start."""

    is_dummy: ClassVar[bool] = True
    triggers = NEVER

    def decide(self) -> Iterator[SwitchStation]:
        """Yield nothing."""
        yield from ()


class DummyCA(ChargeAssignment[NoParameters]):
    """Leaves charging to another controller.

    The simulation itself still sends a robot to an energy station when its battery level is low.
    """

    is_dummy: ClassVar[bool] = True
    triggers = NEVER

    def decide(self) -> Iterator[Charge]:
        """Yield nothing."""
        yield from ()

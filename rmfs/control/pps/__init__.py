"""Pod selection (PPS): which pod comes to a station, or to which station a carried pod goes."""

from __future__ import annotations

from abc import abstractmethod
from typing import TYPE_CHECKING, Any, Literal, TypeVar

import pydantic

from rmfs.control.base import Controller, Parameters
from rmfs.control.problems import Problem
from rmfs.world.stations import PickStation, ReplenishmentStation

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from rmfs.control.asks import Ask, By
    from rmfs.world.orders import Order
    from rmfs.world.robots import Robot

Requests = Literal["assigned", "assigned-and-completable", "assigned-and-queued"]
"""Orders whose requests count. `assigned`: orders assigned to the station.
`assigned-and-completable`: also orders in its pool that the pod completes. `assigned-and-queued`:
also all orders in its pool. A request is the need of an order for one unit."""

_REACH: dict[Requests, int] = {
    "assigned": 0,
    "assigned-and-completable": 1,
    "assigned-and-queued": 2,
}


class LateBinding(Parameters):
    """Parameters of all PPS rules.

    Some values refer to the pools of stations. Only the POA rule `queue` puts orders into pools.
    """

    late_picks: bool = True
    """Whether units of a new order are bound to a pod that a robot is already carrying to the
    order's station."""
    late_bundles: bool = True
    """Whether a new bundle is added to the current trip of its pod if a robot is already carrying
    the pod to the bundle's station."""
    consider: Requests = "assigned-and-completable"
    """Orders for which pods are brought to a station. `assigned`: orders assigned to the station.
    `assigned-and-completable`: assigned orders, and orders of the station's pool that a single pod
    can complete. `assigned-and-queued`: assigned orders, and all orders of the station's pool."""
    reserve: Requests = "assigned-and-completable"
    """Orders whose units are bound to a pod when the pod is brought to a station. The values are
    those of `consider`; the orders must include those of `consider`."""

    @pydantic.model_validator(mode="after")
    def _reserve_what_is_considered(self) -> LateBinding:
        if _REACH[self.reserve] < _REACH[self.consider]:
            raise ValueError(
                "reserve must include the requests of consider (given: reserve = "
                f"{self.reserve}, consider = {self.consider})"
            )
        return self


P = TypeVar("P", bound=LateBinding)


class PodSelection(Controller[P]):
    """Chooses pods for robots that TA sends to work for a station.

    TA asks which pod a robot should fetch and bring to a station, or to which station a carried pod
    should go next. The simulation then binds requests (units that orders need) to the pod: as many
    as the pod can serve at the station.
    """

    problem = Problem.PPS

    def decide(self) -> Iterator[Ask[Any]]:
        """Yield questions to an optimiser; the base class yields none.

        This method is called only after the events in `subscriptions` and at the times given by
        `next_event_s`.
        """
        return iter(())

    @abstractmethod
    def pick_pod(self, robot: Robot, station: PickStation) -> int | By[int]:
        """Choose an available pod with units that orders at the station need, or -1 for no pod."""

    @abstractmethod
    def replenishment_pod(self, robot: Robot, station: ReplenishmentStation) -> int | By[int]:
        """Choose an available pod for which bundles wait at the station, or -1 for no pod."""

    @abstractmethod
    def next_station(self, robot: Robot, stations: Sequence[int]) -> int | By[int]:
        """Choose one of the given stations, all of which the robot's pod can serve."""

    def serves(self, pod: int, station: int) -> bool:
        """Return whether a pod has work at a station.

        A pod has work only at pick and replenishment stations. At a pick station, the parameter
        `consider` determines which orders count.
        """
        view = self.view
        target = view.all_stations[station]
        if isinstance(target, ReplenishmentStation):
            return bool(view.bundles_waiting[target.number, pod])
        if not isinstance(target, PickStation):
            return False
        if view.inventory.serves(pod, list(target.requests.lines)):
            return True
        return any(self._completes(pod, order) for order in self._queued(pod, target))

    def _queued(self, pod: int, station: PickStation) -> Sequence[Order]:
        """Return the orders in a station's pool that count.

        There are none if the station has no free slot or the pod is already at the station.
        """
        if self.parameters.consider == "assigned" or not station.free_slots:
            return ()
        carrier = self.view.storage.claimed_by[pod]
        if carrier >= 0 and self.view.robots[carrier].station == station.index:
            return ()
        return [order for order in station.queued.values() if order.open_units]

    def _completes(self, pod: int, order: Order) -> bool:
        """Return whether a pod has all units that an order still needs.

        If `consider` is `assigned-and-queued`, one such unit is enough.
        """
        available = self.view.inventory.available.item
        lines = (line for line in order.lines if line.open_units)
        if self.parameters.consider == "assigned-and-queued":
            return any(available(line.sku, pod) for line in lines)
        return all(available(line.sku, pod) >= line.open_units for line in lines)

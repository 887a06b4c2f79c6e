"""Service at the stations: units and bundles are transferred one at a time.

At a pick station, a unit occupies the robot for `unit_pick_s` and the station for
`unit_transfer_s`; the next unit from the same pod starts when both times are over. After the last
unit from a pod, the robot leaves as soon as `unit_pick_s` is over, even if the station is still
busy. A change of pods therefore takes no extra time if it is shorter than the rest of the transfer.
At a replenishment station, a bundle occupies both the robot and the station for
`bundle_transfer_s`.
"""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, Any, Protocol

from rmfs.simulation.tasks import end_task
from rmfs.world.tasks import PickTask, ReplenishTask, VisitTask

if TYPE_CHECKING:
    from rmfs.layout.model import Layout, OtherStation
    from rmfs.layout.model import PickStation as PickStationLayout
    from rmfs.layout.model import ReplenishmentStation as ReplenishmentStationLayout
    from rmfs.simulation.agenda import Agenda
    from rmfs.simulation.events import Events
    from rmfs.world import World
    from rmfs.world.orders import Order
    from rmfs.world.pickers import Handled
    from rmfs.world.stations import PickStation, ReplenishmentStation, Station
    from rmfs.world.tasks import Pick


class Service(Protocol):
    """The service of one station."""

    def go_on(self) -> None:
        """Serve the robot at the head of the queue, as far as this is possible now."""
        ...


class Outlet(Protocol):
    """Destination of orders from pick stations (`rmfs.simulation.packing`)."""

    def takes(self, order: Order) -> bool:
        """Whether an order may leave now; if not, `PickService.hand_on_held` is called later."""
        ...

    def released(self, order: Order, *, last: bool, by_hand: bool = False) -> None:
        """Receive an order, or a part of one, that has just left its station."""
        ...


class Hands(Protocol):
    """The pickers at pick stations (`rmfs.simulation.pickers`)."""

    def are_at(self, station: int) -> bool:
        """Whether a picker is at a station; if not, `go_on` is called when one arrives."""
        ...

    def first_of(self, station: int, task: PickTask) -> Pick | None:
        """Return the task's next pick, or None if the picker has no preference.

        In the latter case, the next pick is the task's first one for an order that has a slot.
        """
        ...

    def handle(self, station: int, pod: int, sku: int, station_s: float, robot_s: float) -> Handled:
        """Start to pick a unit; return how it is handled.

        `station_s` and `robot_s` are the times in s for which the unit occupies station and robot
        according to the layout.
        """
        ...


class PickService:
    """The service of one pick station.

    A unit leaves its pod, and its request is fulfilled, when its pick starts. An order leaves its
    slot when the station has finished the last unit of the order. When all remaining requests for a
    pod belong to orders in the station's pool, the pod waits if a slot is about to become free, and
    is sent away otherwise.

    Attributes
    ----------
    outlet
        Destination of orders; None if orders are complete after their last pick.
    hands
        The pickers; None if every unit takes the times given in the layout.
    """

    def __init__(
        self,
        station: PickStation,
        layout: PickStationLayout,
        *,
        agenda: Agenda,
        world: World,
        events: Events,
    ) -> None:
        self._agenda, self._world, self._events = agenda, world, events
        self._station = station
        self._transfer_us = round(layout.unit_transfer_s * 1e6)
        self._pick_us = round(layout.unit_pick_s * 1e6)
        self._busy_until_us = 0
        self._robot_until_us = 0
        self._finished: list[Order] = []
        self.outlet: Outlet | None = None
        self.hands: Hands | None = None

    def go_on(self) -> None:
        """Serve the robot at the head of the queue, as far as this is possible now."""
        station, now_us = self._station, self._agenda.now_us
        if station.robot < 0 or now_us < self._robot_until_us:
            return
        task = self._world.robots[station.robot].task
        if not isinstance(task, PickTask):
            return
        if not task.picks:
            end_task(self._world, self._events, station.robot)
        elif now_us >= self._busy_until_us:
            if task.can_pick:
                if self.hands is None or self.hands.are_at(station.index):
                    self._pick(task)
            else:
                # POA may still assign one of the orders at this instant
                self._agenda.when_settled(partial(self._pick_or_leave, task))
        elif not self._finished and not task.can_pick:
            self._agenda.when_settled(partial(self._pick_or_leave, task))

    def _pick_or_leave(self, task: PickTask) -> None:
        """Continue a task, or end it and reopen its requests if only orders in the pool need it."""
        robots, here = self._world.robots, self._station.robot
        if here < 0 or robots[here].task is not task:
            return
        if not task.can_pick and self._world.give_back(task):
            self._events.picks_changed(self._world.now_s, task.robot)
        self.go_on()

    def _pick(self, task: PickTask) -> None:
        """Start the next pick of a task."""
        agenda, world, events = self._agenda, self._world, self._events
        index = self._station.index
        if self._finished:
            self._hand_on()  # the unit before has been transferred at this very instant
        chosen = None if self.hands is None else self.hands.first_of(index, task)
        pick = world.pick_unit(task, chosen)
        line, order = pick.line, pick.line.order
        now_s = world.now_s
        transfer_us, pick_us, handled = self._transfer_us, self._pick_us, None
        if self.hands is not None:
            handled = self.hands.handle(index, task.pod, line.sku, transfer_us / 1e6, pick_us / 1e6)
            transfer_us, pick_us = round(handled.seconds * 1e6), round(handled.robot_s * 1e6)
        self._busy_until_us = agenda.now_us + transfer_us
        self._robot_until_us = agenda.now_us + pick_us
        agenda.at(self._busy_until_us, self._unit_transferred)
        if pick_us > transfer_us or (pick_us < transfer_us and not task.can_pick):
            # while the next unit only waits for the station, there is nothing for the robot to do
            agenda.at(self._robot_until_us, self.go_on)
        events.station_busy(index, now_s, self._busy_until_us / 1e6)
        events.unit_picked(now_s, order, line.sku, task.pod, task.robot, index, pick.late_bound)
        if handled is not None:
            events.unit_handled(handled)
        if line.picked_units == line.units:
            events.line_picked(now_s, order, line.sku, line.units)
            if not order.unpicked_units:
                self._finished.append(order)

    def _unit_transferred(self) -> None:
        """Pass on complete orders; the station is free for the next unit."""
        if self._agenda.now_us < self._busy_until_us:
            return  # the next unit was started at this very instant, before this callback
        if not self._finished:
            self.go_on()
            return
        self._hand_on()
        # an order that takes the free slot may still be added to the present task
        self._agenda.when_settled(self.go_on)

    def _hand_on(self) -> None:
        """Pass on the orders whose last unit has been transferred."""
        for order in self._finished:
            if order.unpicked_units:
                continue  # lines have joined this part of an order meanwhile
            if self.outlet is None or self.outlet.takes(order):
                self._complete(order)
        self._finished.clear()

    def hand_on_held(self, order: Order, *, by_hand: bool = False) -> None:
        """Pass on an order, or a part of one, that had to wait for the outlet."""
        self._complete(order, by_hand)
        self._agenda.when_settled(self.go_on)

    def _complete(self, order: Order, by_hand: bool = False) -> None:
        """Remove an order, or a part of one, from its slot."""
        complete = self._world.complete_order(order)
        if complete is not None:
            self._events.order_completed(complete)
        if self.outlet is not None:
            self.outlet.released(order, last=complete is not None, by_hand=by_hand)
        self._events.slot_freed(order)
        if self._station.queued and self._station.free_slots == 1:
            self._events.pool_changed(self._station.index)


class ReplenishmentService:
    """The service of one replenishment station.

    As soon as its transfer starts, a bundle counts as stored in its pod, and no longer as load of
    the station.
    """

    def __init__(
        self,
        station: ReplenishmentStation,
        layout: ReplenishmentStationLayout,
        *,
        agenda: Agenda,
        world: World,
        events: Events,
    ) -> None:
        self._agenda, self._world, self._events = agenda, world, events
        self._station = station
        self._transfer_us = round(layout.bundle_transfer_s * 1e6)
        self._busy_until_us = 0

    def go_on(self) -> None:
        """Serve the robot at the head of the queue, as far as this is possible now."""
        station = self._station
        if station.robot < 0 or self._agenda.now_us < self._busy_until_us:
            return
        task = self._world.robots[station.robot].task
        if not isinstance(task, ReplenishTask):
            return
        if task.bundles:
            self._store(task)
        else:
            end_task(self._world, self._events, station.robot)

    def _store(self, task: ReplenishTask) -> None:
        """Start to transfer the next bundle of a task to its pod."""
        agenda, events = self._agenda, self._events
        bundle = self._world.store_bundle(task)
        self._busy_until_us = agenda.now_us + self._transfer_us
        agenda.at(self._busy_until_us, self.go_on)
        now_s = self._world.now_s
        events.station_busy(self._station.index, now_s, self._busy_until_us / 1e6)
        events.bundle_stored(bundle, task.robot)


class VisitService:
    """The service of a station of a user-defined kind: a pod stays for a while, and then leaves.

    Each kind derives its own class, which defines how long pods stay and what happens at the end.

    Attributes
    ----------
    station
        State of the station.
    parameters
        Parameters of the kind.
    world
        The world, read-only; the effects of a visit must be stored in `station`.
    """

    def __init__(
        self,
        station: Station[Any],
        layout: OtherStation,
        *,
        agenda: Agenda,
        world: World,
        events: Events,
    ) -> None:
        self._agenda, self._events = agenda, events
        self._served: VisitTask | None = None
        self.station = station
        self.parameters = layout.kind.parameters
        self.world = world

    def seconds(self, task: VisitTask) -> float:
        """Return how long the pod of a task stays, in s; called when it has reached the station."""
        raise NotImplementedError

    def done(self, task: VisitTask) -> None:
        """Handle the end of the stay; the robot then needs a task."""

    def go_on(self) -> None:
        """Start serving the pod at the head of the queue, if there is one."""
        station, agenda = self.station, self._agenda
        task = self.world.robots[station.robot].task if station.robot >= 0 else None
        if self._served is not None or not isinstance(task, VisitTask):
            return
        self._served = task
        until_us = agenda.now_us + round(self.seconds(task) * 1e6)
        agenda.at(until_us, self._end)
        self._events.station_busy(station.index, self.world.now_s, until_us / 1e6)

    def _end(self) -> None:
        task, self._served = self._served, None
        assert task is not None
        self.done(task)
        end_task(self.world, self._events, task.robot)


def services_of(layout: Layout, *, agenda: Agenda, world: World, events: Events) -> list[Service]:
    """Create the service of every station, in the order of `layout.stations`."""
    parts: dict[str, Any] = {
        plan.kind.name: plan.kind.part("service", object) for plan in layout.stations
    }
    return [
        parts[plan.kind.name](station, plan, agenda=agenda, world=world, events=events)
        for station, plan in zip(world.stations, layout.stations, strict=True)
    ]

"""The packing stage, from the pick stations to the packed parcel.

Before a pick station releases a tote with an order, or with a part of an order, it asks the stage.
If the put wall, or the conveyor to it, is full, the tote stays in its order slot. As soon as there
is room, the stage lets the station release the tote. A tote that has waited for too long is carried
to the wall by hand, even if the wall is full. Steps that take no time have no entry in the agenda,
so that a stage without any delays does not change the results of the run.
"""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from rmfs.observer import Observer
from rmfs.random import Stream, generator
from rmfs.simulation.packing.packers import Packers
from rmfs.simulation.service import PickService
from rmfs.world.put_wall import HeldTote, PutWall

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from rmfs.layout.model import Layout
    from rmfs.scenario.parameters import Packing
    from rmfs.scenario.parameters.packing import ToteTravel
    from rmfs.simulation.agenda import Agenda
    from rmfs.simulation.service import Service
    from rmfs.world import World
    from rmfs.world.orders import Order
    from rmfs.world.put_wall import Tote


class PackingStage(Observer):
    """Takes orders from pick stations, and brings them to packing.

    Parameters
    ----------
    given
        The table `packing` of the scenario.
    services
        Services of all stations; those of pick stations use this stage from now on.
    """

    def __init__(
        self,
        given: Packing,
        layout: Layout,
        services: Sequence[Service],
        seed: int,
        *,
        agenda: Agenda,
        world: World,
        events: Observer,
    ) -> None:
        self._given = given
        self._agenda, self._world, self._events = agenda, world, events
        self._wall = world.put_wall = PutWall(given.slots, slot_per_part=given.slot_for == "part")
        self._travel_us = [round(s * 1e6) for s in travel_s(given.travel, layout).tolist()]
        self._on_conveyor = 0
        self._packers = Packers(
            given,
            agenda=agenda,
            world=world,
            events=events,
            rng=generator(seed, Stream.PACKING),
        )
        self._services: list[PickService] = []
        for service in services:
            if isinstance(service, PickService):
                service.outlet = self
                self._services.append(service)

    def takes(self, order: Order) -> bool:
        """Return whether an order may leave its pick station now; if not, hold it until it may."""
        if self._has_room(order):
            return True
        after_us = round(self._given.by_hand_after_s * 1e6)
        timer = self._agenda.after(after_us, partial(self._carry, order))
        self._wall.held.append(HeldTote(order, self._world.now_s, timer))
        return False

    def released(self, order: Order, *, last: bool, by_hand: bool = False) -> None:
        """Handle an order, or a part of one, that has left its pick station.

        Parameters
        ----------
        last
            Whether the whole order has now been picked.
        """
        wall, now_s = self._wall, self._world.now_s
        whole = _whole(order)
        tote = wall.release(whole, order.station, now_s, last=last)
        tote.by_hand = by_hand
        if self._given.bypass and not tote.parcel.is_split:
            self._events.order_packed(wall.pass_by(tote, now_s))
            return
        self._on_conveyor += not by_hand
        if self._travel_us[tote.station]:
            self._agenda.after(self._travel_us[tote.station], partial(self._arrive, tote))
        else:
            self._arrive(tote)
        if by_hand:
            self._let_go()  # another part of the order may need no slot of its own any more

    def order_assigned(self, order: Order) -> None:
        """Stop holding an order, or a part of one, to which further lines have been assigned."""
        for held in self._wall.held:
            if held.order is order:
                self._forget(held)
                return

    def _has_room(self, order: Order) -> bool:
        last = self._is_last(order)
        if last and self._given.bypass and _whole(order).index not in self._wall.parcels:
            return True
        conveyor = self._given.travel.totes
        if conveyor is not None and self._on_conveyor >= conveyor:
            return False
        return self._wall.has_room(_whole(order).index, last=last)

    def _is_last(self, order: Order) -> bool:
        whole = _whole(order)
        return whole.slots_taken == 1 and whole not in self._world.orders

    def _arrive(self, tote: Tote) -> None:
        """Handle the arrival of a tote at the wall."""
        self._on_conveyor -= not tote.by_hand
        whole = self._wall.arrive(tote, self._world.now_s)
        if whole:
            self._packers.add(tote.parcel)
        self._let_go()

    def _let_go(self) -> None:
        """Release all totes for which there is room, longest wait first."""
        while True:
            # each that goes may come back here before this looks again
            ready = next((held for held in self._wall.held if self._has_room(held.order)), None)
            if ready is None:
                return
            self._forget(ready)
            self._services[ready.order.station].hand_on_held(ready.order)

    def _carry(self, order: Order) -> None:
        """Carry a tote by hand that has waited at its station for too long."""
        held = next(one for one in self._wall.held if one.order is order)
        held.timer = -1
        self._forget(held)
        self._services[order.station].hand_on_held(order, by_hand=True)

    def _forget(self, held: HeldTote) -> None:
        """Remove a tote from those that wait."""
        self._wall.held.remove(held)
        if held.timer >= 0:
            self._agenda.cancel(held.timer)
        self._events.tote_held(held.order.station, held.since_s, self._world.now_s)


def packing_stage(
    given: Packing | None,
    layout: Layout,
    services: Sequence[Service],
    seed: int,
    *,
    agenda: Agenda,
    world: World,
    events: Observer,
) -> list[Observer]:
    """Return a list with the packing stage; the list is empty if the scenario has none."""
    if given is None:
        return []
    return [PackingStage(given, layout, services, seed, agenda=agenda, world=world, events=events)]


def travel_s(given: ToteTravel, layout: Layout) -> NDArray[np.float64]:
    """Return the travel times in s of a tote to the put wall, one per pick station."""
    at = [station.waypoint for station in layout.pick_stations]
    x_m, y_m = layout.x_m[at], layout.y_m[at]
    if given.speed_m_s is None:
        return np.full(len(at), given.constant_s)
    to_x_m = float(x_m.mean()) if given.x_m is None else given.x_m
    to_y_m = float(y_m.mean()) if given.y_m is None else given.y_m
    distance_m = np.abs(x_m - to_x_m) + np.abs(y_m - to_y_m)
    return given.constant_s + distance_m / given.speed_m_s


def _whole(order: Order) -> Order:
    return order if order.whole is None else order.whole

"""Application of decisions: the only place where decisions change the world."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from rmfs.control import decisions as say

if TYPE_CHECKING:
    from collections.abc import Callable

    from rmfs.control.asks import Call
    from rmfs.simulation.dispatch import Dispatch
    from rmfs.simulation.events import Events
    from rmfs.world import World
    from rmfs.world.orders import Bundle, Order


class Applying:
    """Applies each decision as soon as it is made.

    Parameters
    ----------
    prepare, exchange, unplug
        Functions that carry out the decisions `Prepare`, `Exchange` and `Unplug` of
        `rmfs.control.decisions`.
    """

    def __init__(
        self,
        world: World,
        events: Events,
        dispatch: Dispatch,
        *,
        prepare: Callable[[say.Prepare, Call | None], None],
        exchange: Callable[[say.Exchange], None],
        unplug: Callable[[say.Unplug], None],
    ) -> None:
        self._world = world
        self._events = events
        self._prepare = prepare
        self._how: dict[type, Callable[[Any], None]] = {
            say.SwitchStation: self._switch_station,
            say.PromiseBundle: self._promise_bundle,
            say.ReleasePod: self.release_pod,
            say.SendBundle: self._send_bundle,
            say.AssignOrder: self._assign_order,
            say.AssignLines: self._assign_lines,
            say.QueueOrder: self._queue_order,
            say.BringForPicks: dispatch.start,
            say.BringForBundles: dispatch.start,
            say.Visit: dispatch.start,
            say.Park: dispatch.start,
            say.Reposition: dispatch.start,
            say.Rest: dispatch.start,
            say.Exchange: exchange,
            say.Charge: dispatch.start,
            say.Unplug: unplug,
        }

    def __call__(self, decision: Any, call: Call | None) -> None:
        """Apply a decision; `call` is the optimiser call on which it is based, or None.

        Raises
        ------
        ValueError
            If the decision is impossible; the state of the world is then unchanged.
        TypeError
            If `decision` is not a decision as defined in `rmfs.control.decisions`.
        """
        how = self._how.get(type(decision))
        if how is not None:
            how(decision)
        elif type(decision) is say.Prepare:
            self._prepare(decision, call)
        else:
            raise TypeError(f"{decision!r} is not a decision (see rmfs.control.decisions)")

    def _switch_station(self, decision: say.SwitchStation) -> None:
        station = self._world.stations[decision.station]
        if station.active != decision.active:
            station.active = decision.active
            self._events.station_activated(self._world.now_s, station.index, decision.active)

    def _promise_bundle(self, decision: say.PromiseBundle) -> None:
        self._world.promise(decision.bundle, decision.pod)
        self._events.bundle_promised(decision.bundle)

    def release_pod(self, decision: say.ReleasePod) -> None:
        """Release the bundles promised to a pod.

        Each bundle for which ROA has already chosen a station is thereby assigned to this station.
        """
        assigned = self._world.release_bundles(decision.pod)
        self._events.bundles_released(decision.pod)
        for bundle in assigned:
            self._events.bundle_assigned(bundle)

    def _send_bundle(self, decision: say.SendBundle) -> None:
        bundle: Bundle = decision.bundle
        assigned = self._world.choose_station(bundle, decision.station)
        self._events.bundle_sent(bundle)
        if assigned:
            self._events.bundle_assigned(bundle)

    def _assign_order(self, decision: say.AssignOrder) -> None:
        self._events.order_assigned(self._world.assign_order(*decision))

    def _assign_lines(self, decision: say.AssignLines) -> None:
        self._events.order_assigned(self._world.assign_lines(*decision))

    def _queue_order(self, decision: say.QueueOrder) -> None:
        order: Order = decision.order
        if decision.station < 0:
            left = self._world.pick_stations[order.queued_at]
            self._world.unqueue_order(order)
            for task in left.tasks.values():
                self._events.picks_changed(self._world.now_s, task.robot)
            return
        self._world.queue_order(order, decision.station)
        self._events.order_queued(order)

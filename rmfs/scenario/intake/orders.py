"""The intake of orders: the processes that generate the orders of a run."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

from rmfs.random import Stream
from rmfs.scenario.clock import nearest_us
from rmfs.scenario.departures import Departures
from rmfs.scenario.due import NO_CLASS, ClassesDue, DepartureDue, class_of
from rmfs.scenario.intake.assembly import Assembly
from rmfs.scenario.intake.backlog import BacklogOrders
from rmfs.scenario.intake.batches import Batch, Batches, add
from rmfs.scenario.intake.contents import BATCHES, DUE_TIMES, INITIAL, REGULAR, contents
from rmfs.scenario.intake.intake import Intake, OrderArrival, Process
from rmfs.scenario.intake.timed import Timed, at_zero, share_of
from rmfs.scenario.parameters import BacklogDemand, StreamDemand
from rmfs.scenario.sources import order_stream
from rmfs.scenario.streams.stream import NO_DUE_US, OrderStream
from rmfs.scenario.substreams import Substreams

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from rmfs.scenario.due import Due
    from rmfs.scenario.intake.contents import Contents
    from rmfs.scenario.intake.state import Site, State
    from rmfs.scenario.intake.thinning import Candidate
    from rmfs.scenario.parameters import PoissonDemand, Scenario
    from rmfs.scenario.skus import SkuSet
    from rmfs.scenario.streams import StreamRecorder


def order_intake(
    scenario: Scenario,
    skus: SkuSet,
    site: Site,
    seed: int,
    recorder: StreamRecorder | None = None,
) -> Intake[OrderArrival]:
    """Return the intake of orders for a run.

    Parameters
    ----------
    skus
        The SKUs of the scenario (`sku_set(scenario.skus)`).
    site
        The properties of the warehouse on which arrivals depend.
    seed
        The run's seed.
    recorder
        Records all orders.

    Raises
    ------
    InputError
        If a file is invalid, an order may have more lines than there are SKUs, or a rate is too
        high.
    """
    orders = _Orders(scenario, skus, site, seed, scenario.demand.down)
    if recorder is None:
        return orders.intake(None)
    due = scenario.orders.due
    recorder.orders.classes = due.names if isinstance(due, ClassesDue) else ()
    return orders.intake(partial(_record, recorder))


class _Orders(Assembly[OrderArrival]):
    """Creates the intake of orders."""

    def _regular(self) -> Iterator[Process[OrderArrival]]:
        demand = self._scenario.demand
        if isinstance(demand, BacklogDemand):
            yield BacklogOrders(
                demand, self._contents(REGULAR), self._site.capacity, self._openings
            )
        elif isinstance(demand, StreamDemand):
            yield self._from_file()
        else:
            if demand.initial_orders:
                make = _drawn(self._contents(INITIAL))
                yield Timed(at_zero(demand.initial_orders), make)
            yield self._poisson(demand)

    def _finish(self) -> Callable[[OrderArrival], OrderArrival] | None:
        due = self._scenario.orders.due
        if not isinstance(due, DepartureDue):
            return None
        stream = self._stream if isinstance(self._stream, OrderStream) else None
        return partial(_for_departure, Departures(due, self._gone_s), stream)

    def _poisson(self, demand: PoissonDemand) -> Timed[OrderArrival]:
        scale = float(self._site.pick_stations) if demand.per_station else 1.0
        come = self._arrivals(demand.profile, demand.orders_per_h, scale, Stream.ORDER_ARRIVALS)
        return Timed(come, _drawn(self._contents(REGULAR)), share_of(demand.tied_to))

    def _from_file(self) -> Timed[OrderArrival]:
        stream = order_stream(self._scenario, self._skus)
        self._stream = stream
        due = self._scenario.orders.due
        substreams = Substreams(self._seed, Stream.ORDER_CONTENTS, DUE_TIMES)
        make = partial(_from_stream, stream, due, substreams)
        return Timed(self._at_times(stream.time_us.tolist()), make)

    def _batches(self) -> Iterator[Process[OrderArrival]]:
        config = self._scenario.demand.batches
        if config is None:
            return
        stations = self._site.pick_stations if config.per_station else 1
        make = partial(_in_batch, self._contents(BATCHES))
        batches = [
            *(_up_to(time_s, number * stations) for time_s, number in config.fill_to),
            *(add(time_s, number * stations) for time_s, number in config.add),
        ]
        yield Batches(batches, config.cycle_s, self._gone_s, make)

    def _contents(self, path: tuple[int, ...]) -> Contents:
        return contents(self._scenario, self._skus, self._seed, path)


def _drawn(draw: Contents) -> Callable[[Candidate, State], OrderArrival]:
    """Return the function that makes orders whose contents are fixed in advance."""
    return partial(_of_candidate, draw)


def _of_candidate(draw: Contents, candidate: Candidate, state: State) -> OrderArrival:
    content = draw(candidate.ordinal, state)
    assert content is not None
    return OrderArrival.of(content, candidate.time_us)


def _from_stream(
    stream: OrderStream,
    due: Due,
    substreams: Substreams,
    candidate: Candidate,
    _state: State,
) -> OrderArrival:
    ordinal, time_us, _ = candidate
    due_us, uniform = int(stream.due_us[ordinal]), substreams.at(ordinal)()
    priority = NO_CLASS if stream.priority is None else int(stream.priority[ordinal])
    told = priority != NO_CLASS
    if not told:
        priority = class_of(due, uniform)
    if due_us == NO_DUE_US:
        offset_s = due.sampler()(uniform)
        if told:
            assert isinstance(due, ClassesDue)
            offset_s = due.classes[priority].offset_s
        due_us = time_us + nearest_us(offset_s)
    lines = stream.lines(ordinal)
    return OrderArrival(time_us, *lines, due_us, redraws=0, in_file=ordinal, priority=priority)


def _for_departure(
    departures: Departures, stream: OrderStream | None, order: OrderArrival
) -> OrderArrival:
    """Set the due time of an order to a departure, unless its file specifies one."""
    if stream is not None and order.in_file >= 0 and stream.due_us[order.in_file] != NO_DUE_US:
        return order
    return order._replace(due_us=departures.next_us(order.due_us))


def _in_batch(draw: Contents, ordinal: int, now_us: int, state: State) -> OrderArrival | None:
    content = draw(ordinal, state)
    return None if content is None else OrderArrival.of(content, now_us)


def _record(recorder: StreamRecorder, order: OrderArrival) -> None:
    recorder.orders.add(order.time_us, order.due_us, order.skus, order.units, order.priority)


def _up_to(time_s: float, number: int) -> Batch:
    """Return a batch that raises the number of waiting orders to a given number."""
    return Batch(time_s, partial(_fewer_waiting, number))


def _fewer_waiting(number: int, state: State, _come: int) -> bool:
    return state.waiting_orders < number

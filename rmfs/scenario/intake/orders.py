"""The intake of orders."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rmfs.random import Stream
from rmfs.scenario.clock import Openings, first_us, nearest_us
from rmfs.scenario.intake.backlog import BacklogOrders
from rmfs.scenario.intake.batches import Batch, Batches, add
from rmfs.scenario.intake.contents import BATCHES, DUE_TIMES, INITIAL, REGULAR, contents
from rmfs.scenario.intake.intake import Intake, OrderArrival, Process
from rmfs.scenario.intake.rates import rate_of
from rmfs.scenario.intake.thinning import Candidate, poisson
from rmfs.scenario.intake.timed import Timed, at_zero, share_of
from rmfs.scenario.parameters import BacklogDemand, StreamDemand
from rmfs.scenario.sources import order_stream
from rmfs.scenario.streams.stream import NO_DUE_US
from rmfs.scenario.substreams import Substreams

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from rmfs.scenario.intake.contents import Contents
    from rmfs.scenario.intake.state import Site, State
    from rmfs.scenario.parameters import OrderBatches, PoissonDemand, Scenario
    from rmfs.scenario.skus import SkuSet
    from rmfs.scenario.streams import StreamRecorder


def order_intake(
    scenario: Scenario,
    skus: SkuSet,
    site: Site,
    seed: int,
    recorder: StreamRecorder | None = None,
) -> Intake[OrderArrival]:
    """Return the intake of the orders of a run.

    Parameters
    ----------
    skus
        Those of the scenario (`sku_set(scenario.skus)`).
    site
        What it needs to know of the warehouse.
    seed
        The run's seed.
    recorder
        Keeps all orders.

    Raises
    ------
    InputError
        If a file is broken, or an order may need more lines than there are SKUs.
    """
    return _Orders(scenario, skus, site, seed).intake(recorder)


class _Orders:
    """Puts the intake of orders together."""

    def __init__(self, scenario: Scenario, skus: SkuSet, site: Site, seed: int) -> None:
        self._scenario = scenario
        self._skus = skus
        self._site = site
        self._seed = seed
        self._gone_s = scenario.time_of_day_s
        self._openings = Openings(scenario.demand.down, self._gone_s)

    def intake(self, recorder: StreamRecorder | None) -> Intake[OrderArrival]:
        processes = list(self._regular())
        if self._scenario.demand.batches is not None:
            processes.append(self._batches(self._scenario.demand.batches))
        if recorder is None:
            return Intake(processes)
        keep = recorder.orders.add
        return Intake(
            processes, lambda order: keep(order.time_us, order.due_us, order.skus, order.units)
        )

    def _regular(self) -> Iterator[Process[OrderArrival]]:
        demand = self._scenario.demand
        if isinstance(demand, BacklogDemand):
            yield BacklogOrders(
                demand, self._contents(REGULAR), self._site.capacity, self._openings
            )
        elif isinstance(demand, StreamDemand):
            yield self._from_file(demand)
        else:
            if demand.initial_orders:
                make = _drawn(self._contents(INITIAL))
                yield Timed(at_zero(demand.initial_orders), make)
            yield self._poisson(demand)

    def _poisson(self, demand: PoissonDemand) -> Timed[OrderArrival]:
        scale = float(self._site.pick_stations) if demand.per_station else 1.0
        rate = rate_of(demand.profile, demand.orders_per_h, scale, self._gone_s, self._seed)
        until_us = first_us(self._scenario.warmup_s + self._scenario.duration_s)
        substreams = Substreams(self._seed, Stream.ORDER_ARRIVALS)
        return Timed(
            poisson(rate, substreams, self._openings, until_us),
            _drawn(self._contents(REGULAR)),
            share_of(demand.tied_to),
        )

    def _from_file(self, demand: StreamDemand) -> Timed[OrderArrival]:
        stream = order_stream(demand, self._skus)
        due = self._scenario.orders.due.sampler()
        substreams = Substreams(self._seed, Stream.ORDER_CONTENTS, DUE_TIMES)
        times_us = [self._openings.open_from_us(time_us) for time_us in stream.time_us.tolist()]

        def make(candidate: Candidate, _state: State) -> OrderArrival:
            ordinal, time_us, _ = candidate
            due_us = int(stream.due_us[ordinal])
            if due_us == NO_DUE_US:
                due_us = time_us + nearest_us(due(substreams.at(ordinal)()))
            return OrderArrival(time_us, *stream.lines(ordinal), due_us, redraws=0)

        return Timed((Candidate(*which) for which in enumerate(times_us)), make)

    def _batches(self, config: OrderBatches) -> Batches[OrderArrival]:
        stations = self._site.pick_stations if config.per_station else 1
        draw = self._contents(BATCHES)

        def make(ordinal: int, now_us: int, state: State) -> OrderArrival | None:
            draft = draw(ordinal, state)
            return None if draft is None else OrderArrival.of(draft, now_us)

        batches = [
            *(_up_to(time_s, number * stations) for time_s, number in config.fill_to),
            *(add(time_s, number * stations) for time_s, number in config.add),
        ]
        return Batches(batches, config.cycle_s, self._gone_s, make)

    def _contents(self, path: tuple[int, ...]) -> Contents:
        return contents(self._scenario, self._skus, self._seed, path)


def _drawn(draw: Contents) -> Callable[[Candidate, State], OrderArrival]:
    """Return the function that makes orders whose contents are fixed in advance."""

    def make(candidate: Candidate, state: State) -> OrderArrival:
        draft = draw(candidate.ordinal, state)
        assert draft is not None
        return OrderArrival.of(draft, candidate.time_us)

    return make


def _up_to(time_s: float, number: int) -> Batch:
    """Return a batch after which so many orders wait."""
    return Batch(time_s, lambda state, _come: state.waiting_orders < number)

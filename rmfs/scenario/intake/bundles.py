"""The intake of bundles: the processes that generate the bundles of a run."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

from rmfs.random import Stream
from rmfs.scenario.bundles import BundleSource
from rmfs.scenario.intake.assembly import Assembly
from rmfs.scenario.intake.backlog import BacklogBundles
from rmfs.scenario.intake.batches import Batch, Batches, add
from rmfs.scenario.intake.contents import BATCHES, INITIAL, REGULAR
from rmfs.scenario.intake.intake import BundleArrival, Intake, Process
from rmfs.scenario.intake.needed import NeededBundles
from rmfs.scenario.intake.timed import Timed, at_zero, share_of
from rmfs.scenario.parameters import (
    BacklogReplenishment,
    NeededReplenishment,
    PoissonReplenishment,
    StreamReplenishment,
)
from rmfs.scenario.sources import bundle_stream

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from rmfs.scenario.intake.state import Site, State
    from rmfs.scenario.intake.thinning import Candidate
    from rmfs.scenario.parameters import Scenario
    from rmfs.scenario.skus import SkuSet
    from rmfs.scenario.streams import BundleStream, StreamRecorder


def bundle_intake(
    scenario: Scenario,
    skus: SkuSet,
    site: Site,
    seed: int,
    recorder: StreamRecorder | None = None,
) -> Intake[BundleArrival]:
    """Return the intake of bundles for a run.

    Parameters
    ----------
    skus
        The SKUs of the scenario (`sku_set(scenario.skus)`).
    site
        The properties of the warehouse on which arrivals depend.
    seed
        The run's seed.
    recorder
        Records all bundles.

    Raises
    ------
    InputError
        If a file is invalid or contains a bundle that fits into no pod, or a rate is too high.
    """
    bundles = _Bundles(scenario, skus, site, seed, scenario.replenishment.down)
    if recorder is None:
        return bundles.intake(None)
    return bundles.intake(partial(_record, recorder))


class _Bundles(Assembly[BundleArrival]):
    """Creates the intake of bundles."""

    def _regular(self) -> Iterator[Process[BundleArrival]]:
        config, capacity = self._scenario.replenishment, self._site.capacity
        if isinstance(config, BacklogReplenishment):
            yield BacklogBundles(config, self._source(REGULAR), capacity, self._openings)
        elif isinstance(config, NeededReplenishment):
            yield NeededBundles(config, self._skus, capacity, self._openings)
        elif isinstance(config, StreamReplenishment):
            yield self._from_file()
        else:
            if config.initial_bundles:
                make = _drawn(self._source(INITIAL))
                yield Timed(at_zero(config.initial_bundles), make)
            yield self._poisson(config)

    def _poisson(self, config: PoissonReplenishment) -> Timed[BundleArrival]:
        scale = float(self._site.replenishment_stations) if config.per_station else 1.0
        come = self._arrivals(config.profile, config.bundles_per_h, scale, Stream.BUNDLE_ARRIVALS)
        return Timed(come, _drawn(self._source(REGULAR)), share_of(config.tied_to))

    def _from_file(self) -> Timed[BundleArrival]:
        stream = bundle_stream(self._scenario, self._skus, self._site.largest_pod)
        self._stream = stream
        space_per_unit: list[float] = self._skus.space_per_unit.tolist()
        make = partial(_from_stream, stream, space_per_unit)
        return Timed(self._at_times(stream.time_us.tolist()), make)

    def _batches(self) -> Iterator[Process[BundleArrival]]:
        config = self._scenario.replenishment.batches
        if config is None:
            return
        source = self._source(BATCHES)
        batches = [
            *(_up_to(time_s, share * self._site.capacity) for time_s, share in config.fill_to),
            *(add(time_s, number) for time_s, number in config.add),
        ]
        yield Batches(
            batches,
            config.cycle_s,
            self._gone_s,
            partial(_in_batch, source),
        )

    def _source(self, path: tuple[int, ...]) -> BundleSource:
        config = self._scenario.replenishment
        returns = 0.0
        if isinstance(config, BacklogReplenishment | PoissonReplenishment):
            returns = config.return_share
        return BundleSource(self._skus, self._seed, returns, path)


def _up_to(time_s: float, load: float) -> Batch:
    """Return a batch that raises the load to at least a number of space units."""
    return Batch(time_s, partial(_less_load, load))


def _less_load(load: float, state: State, _come: int) -> bool:
    return state.load < load


def _drawn(source: BundleSource) -> Callable[[Candidate, State], BundleArrival]:
    return partial(_of_candidate, source)


def _of_candidate(source: BundleSource, candidate: Candidate, _state: State) -> BundleArrival:
    return BundleArrival(candidate.time_us, *source.draw(candidate.ordinal))


def _in_batch(source: BundleSource, ordinal: int, now_us: int, _state: State) -> BundleArrival:
    return BundleArrival(now_us, *source.draw(ordinal))


def _from_stream(
    stream: BundleStream, space_per_unit: list[float], candidate: Candidate, _state: State
) -> BundleArrival:
    ordinal = candidate.ordinal
    sku, units = int(stream.sku[ordinal]), int(stream.units[ordinal])
    return BundleArrival(candidate.time_us, sku, units, units * space_per_unit[sku], ordinal)


def _record(recorder: StreamRecorder, bundle: BundleArrival) -> None:
    recorder.bundles.add(bundle.time_us, bundle.sku, bundle.units)

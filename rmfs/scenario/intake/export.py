"""Export of streams of orders or bundles that do not depend on what happens in a run."""

from __future__ import annotations

from math import inf
from typing import TYPE_CHECKING, Any, Literal, NamedTuple, NoReturn, cast

from rmfs.errors import InputError
from rmfs.scenario.clock import first_us
from rmfs.scenario.intake.bundles import bundle_intake
from rmfs.scenario.intake.orders import order_intake
from rmfs.scenario.intake.state import Site
from rmfs.scenario.sources import sku_set
from rmfs.scenario.streams import StreamRecorder, write_stream

if TYPE_CHECKING:
    from pathlib import Path

    from rmfs.scenario.intake.intake import Intake
    from rmfs.scenario.intake.state import State
    from rmfs.scenario.parameters import Scenario
    from rmfs.scenario.skus import SkuSet
    from rmfs.scenario.streams import OrderStream


class ExportedStream(NamedTuple):
    """A stream of orders or bundles that was written to a file.

    Attributes
    ----------
    path
        The file.
    digest
        SHA-256 of the stream (`rmfs.scenario.streams.digest`); it does not depend on the file's
        format.
    number
        Number of orders, or bundles.
    """

    path: Path
    digest: str
    number: int


class _DependsOnRunError(Exception):
    """The stream depends on the state of a run."""


class _NoState:
    """Placeholder for the state of a run."""

    def __getattr__(self, name: str) -> NoReturn:
        raise _DependsOnRunError


def export_stream(
    scenario: Scenario,
    what: Literal["orders", "bundles"],
    path: Path,
    site: Site,
    seed: int = 0,
) -> ExportedStream:
    """Write the orders or bundles of a scenario that arrive from time zero to the end of the run.

    Parameters
    ----------
    path
        File that ends in .csv or .parquet.
    site
        The properties of the warehouse on which arrivals depend.
    seed
        The run's seed.

    Raises
    ------
    InputError
        If a file of the scenario is invalid, `path` has another suffix or cannot be written, or
        arrivals depend on what happens in a run.

    Notes
    -----
    Arrivals depend on what happens in a run if the scenario has a constant backlog, replenishment
    of SKUs that run short (mode "needed"), rates tied to active stations, or batches up to a given
    backlog or load. Such a stream can only be recorded during a run.
    """
    skus = sku_set(scenario.skus)
    recorder = StreamRecorder()
    end_us = first_us(scenario.warmup_s + scenario.duration_s)
    try:
        if what == "orders":
            _run(order_intake(scenario, skus, site, seed, recorder), end_us)
            stream: Any = recorder.orders.build()
        else:
            _run(bundle_intake(scenario, skus, site, seed, recorder), end_us)
            stream = recorder.bundles.build()
    except _DependsOnRunError:
        table = "demand" if what == "orders" else "replenishment"
        raise InputError(
            f"{scenario.name}: {table}: {what} that depend on what happens in a run cannot be "
            "exported; record them with rmfs run --record"
        ) from None
    return ExportedStream(path, write_stream(stream, skus, path), len(stream))


def order_stream_of(scenario: Scenario, skus: SkuSet, seed: int) -> OrderStream:
    """Return all orders of a scenario; they must not depend on what happens in a run.

    If rates or batches are given per pick station, the orders are those of one pick station.
    """
    recorder = StreamRecorder()
    end_us = first_us(scenario.warmup_s + scenario.duration_s)
    anywhere = Site(1, 1, capacity=inf, largest_pod=inf)
    _run(order_intake(scenario, skus, anywhere, seed, recorder), end_us)
    return recorder.orders.build()


def _run(intake: Intake[Any], end_us: int) -> None:
    now_us = 0
    while now_us <= end_us:
        for _ in intake.due(now_us, cast("State", _NoState())):
            pass
        now_us = intake.next_us

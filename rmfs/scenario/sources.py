"""Reads the files that the tables of a scenario refer to."""

from __future__ import annotations

from datetime import datetime, timedelta
from typing import TYPE_CHECKING

from rmfs import foreign
from rmfs.errors import InputError
from rmfs.scenario import exact
from rmfs.scenario.clock import US_PER_S
from rmfs.scenario.due import ClassesDue
from rmfs.scenario.parameters import LetterSkus, SkuFile, StreamDemand, StreamReplenishment
from rmfs.scenario.skus import SkuSet, draw_sku_set, read_sku_set
from rmfs.scenario.skus.csv_file import read_sku_table
from rmfs.scenario.skus.drawing import draw_bundle_units, draw_space
from rmfs.scenario.skus.letters import letter_sku_set
from rmfs.scenario.streams import digest, first_moment, read_bundles, read_orders
from rmfs.scenario.streams.times import midnight

if TYPE_CHECKING:
    from rmfs.scenario.parameters import Scenario, Skus
    from rmfs.scenario.skus.content import SkuFileContent
    from rmfs.scenario.streams import BundleStream, OrderStream


def sku_set(config: Skus) -> SkuSet:
    """Return the SKUs of a scenario, which are drawn or read from a file.

    Raises
    ------
    InputError
        If a file is invalid.
    """
    if isinstance(config, LetterSkus):
        return letter_sku_set(config)
    if not isinstance(config, SkuFile):
        return draw_sku_set(config, config.seed)
    match config.file.suffix.lower():
        case ".json":
            return read_sku_set(config.file)
        case ".csv" | ".parquet":
            return _completed(read_sku_table(config.file), config)
        case ".xitem":
            return _completed(foreign.read(config.file).skus, config)
    return _completed(foreign.read(config.file), config)


def order_stream(scenario: Scenario, skus: SkuSet) -> OrderStream:
    """Return the orders of the file that a scenario uses as its demand.

    Raises
    ------
    InputError
        If the file is invalid, its digest differs from that in the scenario, or its first order has
        a date after the end of the run.
    """
    config = scenario.demand
    assert isinstance(config, StreamDemand)
    if config.file.suffix.lower() == ".xitem":
        stream: OrderStream = foreign.read(config.file).orders(skus)
    else:
        zero = time_zero(scenario)
        due = scenario.orders.due
        classes = due.names if isinstance(due, ClassesDue) else ()
        stream = read_orders(config.file, skus, zero, classes)
        if zero is not None and len(stream):
            _check_comes(int(stream.time_us[0]), scenario, zero)
    _check_digest(config, digest(stream, skus) if config.digest else None)
    return stream


def bundle_stream(scenario: Scenario, skus: SkuSet, largest_pod: float) -> BundleStream:
    """Return the bundles of the file that a scenario uses as its replenishment.

    Parameters
    ----------
    largest_pod
        Capacity of the largest pod, in space units.

    Raises
    ------
    InputError
        If the file is invalid, a bundle fits into no pod, or the digest differs from the one in the
        scenario.
    """
    config = scenario.replenishment
    assert isinstance(config, StreamReplenishment)
    if config.file.suffix.lower() == ".xitem":
        stream: BundleStream = foreign.read(config.file).bundles(skus, largest_pod)
    else:
        stream = read_bundles(config.file, skus, largest_pod, time_zero(scenario))
    _check_digest(config, digest(stream, skus) if config.digest else None)
    return stream


def time_zero(scenario: Scenario) -> datetime | None:
    """Return the date and time of time zero of a scenario.

    Time zero is `start` if the scenario specifies it. Otherwise, it is `time_of_day_s` after the
    last midnight before the earliest row in the files of orders and bundles, and is the same for
    both files. The result is None if there is neither `start` nor a file with dates.

    Raises
    ------
    InputError
        If the times have a time zone in only one of the two files.
    """
    if scenario.start is not None:
        return datetime.fromisoformat(scenario.start)
    configs = (scenario.demand, scenario.replenishment)
    files = [one.file for one in configs if isinstance(one, StreamDemand | StreamReplenishment)]
    moments = [first_moment(path) for path in files if path.suffix.lower() != ".xitem"]
    first = [moment for moment in moments if moment is not None]
    if len({moment.tzinfo is None for moment in first}) > 1:
        raise InputError(
            f"{files[0]}, {files[1]}: the times of both files or of neither must have a time zone"
        )
    if not first:
        return None
    return midnight(min(first)) + timedelta(seconds=scenario.time_of_day_s)


def _check_comes(first_us: int, scenario: Scenario, zero: datetime) -> None:
    """Raise an error if a run ends before the first order of its file."""
    assert isinstance(scenario.demand, StreamDemand)
    end_s = scenario.warmup_s + scenario.duration_s
    if first_us > end_s * US_PER_S:
        first = zero + timedelta(microseconds=first_us)
        raise InputError(
            f"{scenario.demand.file}: the first order arrives at {first.isoformat()}, but the run "
            f"lasts from {zero.isoformat()} to {(zero + timedelta(seconds=end_s)).isoformat()}; "
            "set scenario.start (also by --set)"
        )


def _check_digest(config: StreamDemand | StreamReplenishment, found: str | None) -> None:
    if found != config.digest:
        raise InputError(
            f"{config.file}: the digest of the file is {found}, not {config.digest} as expected"
        )


def _completed(read: SkuFileContent, config: SkuFile) -> SkuSet:
    """Draw what is missing in the file."""
    count = len(read.ids)
    space, bundle_units = read.space_per_unit, read.bundle_units
    return SkuSet(
        ids=read.ids,
        popularity=exact.significant(read.popularity),
        space_per_unit=draw_space(config.space_per_unit, config.seed, count)
        if space is None
        else exact.space(space),
        bundle_units=draw_bundle_units(config.bundle_units, config.seed, count)
        if bundle_units is None
        else bundle_units,
        affinity=read.affinity,
        names=read.names,
    )

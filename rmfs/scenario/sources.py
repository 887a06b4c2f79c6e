"""From the tables of a scenario to what their files hold."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rmfs import foreign
from rmfs.errors import InputError
from rmfs.scenario import exact
from rmfs.scenario.parameters import LetterSkus, SkuFile
from rmfs.scenario.skus import SkuSet, draw_sku_set, read_sku_set
from rmfs.scenario.skus.csv_file import read_sku_table
from rmfs.scenario.skus.drawing import draw_bundle_units, draw_space
from rmfs.scenario.skus.letters import letter_sku_set
from rmfs.scenario.streams import digest, read_bundles, read_orders

if TYPE_CHECKING:
    from rmfs.scenario.parameters import Skus, StreamDemand, StreamReplenishment
    from rmfs.scenario.skus.content import SkuFileContent
    from rmfs.scenario.streams import BundleStream, OrderStream


def sku_set(config: Skus) -> SkuSet:
    """Return the SKUs that a scenario asks for, drawn or read.

    Raises
    ------
    InputError
        If a file is broken.
    """
    if isinstance(config, LetterSkus):
        return letter_sku_set(config)
    if not isinstance(config, SkuFile):
        return draw_sku_set(config, config.seed)
    match config.file.suffix.lower():
        case ".json":
            return read_sku_set(config.file)
        case ".csv":
            return _completed(read_sku_table(config.file), config)
        case ".xitem":
            return _completed(foreign.read(config.file).skus, config)
    return _completed(foreign.read(config.file), config)


def order_stream(config: StreamDemand, skus: SkuSet) -> OrderStream:
    """Return the orders of a file.

    Raises
    ------
    InputError
        If the file is broken, or its digest is another one.
    """
    if config.file.suffix.lower() == ".xitem":
        stream: OrderStream = foreign.read(config.file).orders(skus)
    else:
        stream = read_orders(config.file, skus)
    _check_digest(config, digest(stream, skus) if config.digest else None)
    return stream


def bundle_stream(config: StreamReplenishment, skus: SkuSet, largest_pod: float) -> BundleStream:
    """Return the bundles of a file.

    Parameters
    ----------
    largest_pod
        Space units of the largest pod.

    Raises
    ------
    InputError
        If the file is broken, a bundle fits into no pod, or the digest is another one.
    """
    if config.file.suffix.lower() == ".xitem":
        stream: BundleStream = foreign.read(config.file).bundles(skus, largest_pod)
    else:
        stream = read_bundles(config.file, skus, largest_pod)
    _check_digest(config, digest(stream, skus) if config.digest else None)
    return stream


def _check_digest(config: StreamDemand | StreamReplenishment, found: str | None) -> None:
    if found != config.digest:
        raise InputError(f"{config.file}: digest is {found}, not {config.digest} as expected")


def _completed(read: SkuFileContent, config: SkuFile) -> SkuSet:
    """Draw what the file does not say."""
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

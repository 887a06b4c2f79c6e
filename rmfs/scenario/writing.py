"""Writes a scenario as self-contained files."""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING

from rmfs.errors import InputError
from rmfs.files import read_bounded, write_text
from rmfs.scenario.parameters import LetterSkus, SkuFile, StreamDemand, StreamReplenishment
from rmfs.scenario.parameters.pickers import MeasuredTime
from rmfs.scenario.skus import write_sku_set
from rmfs.scenario.sources import bundle_stream, order_stream, sku_set
from rmfs.scenario.streams import write_stream
from rmfs.scenario.toml import to_toml

if TYPE_CHECKING:
    from rmfs.scenario.parameters import Scenario


def write_scenario(scenario: Scenario, path: Path) -> list[Path]:
    """Write a scenario together with the files to which it refers, in the formats of rmfs.

    Parameters
    ----------
    path
        The file NAME.toml. Further files are written to its folder if the scenario needs them:
        NAME-skus.json, NAME-words.txt, NAME-orders.csv, NAME-bundles.csv, NAME-times.csv.

    Returns
    -------
    The paths of all files written, beginning with `path`.

    Raises
    ------
    InputError
        If `path` does not end in .toml, or a file cannot be read or written.
    """
    if path.suffix.lower() != ".toml":
        raise InputError(f"{path}: must end in .toml")
    skus = sku_set(scenario.skus)
    changes: dict[str, object] = {}
    written = [path]

    def beside(end: str) -> Path:
        written.append(path.with_name(f"{path.stem}-{end}"))
        return written[-1]

    if isinstance(scenario.skus, SkuFile):
        target = beside("skus.json")
        write_sku_set(skus, target, scenario.description)
        changes["skus"] = scenario.skus.model_copy(update={"file": Path(target.name)})
    elif isinstance(scenario.skus, LetterSkus):
        target = beside("words.txt")
        write_text(target, _text(scenario.skus.words))
        changes["skus"] = scenario.skus.model_copy(update={"words": Path(target.name)})
    if isinstance(scenario.demand, StreamDemand):
        target = beside("orders.csv")
        digest = write_stream(order_stream(scenario, skus), skus, target)
        named = {"file": Path(target.name), "digest": digest}
        changes["demand"] = scenario.demand.model_copy(update=named)
    if isinstance(scenario.replenishment, StreamReplenishment):
        target = beside("bundles.csv")
        bundles = bundle_stream(scenario, skus, math.inf)
        named = {"file": Path(target.name), "digest": write_stream(bundles, skus, target)}
        changes["replenishment"] = scenario.replenishment.model_copy(update=named)
    times = scenario.pickers.unit_time if scenario.pickers is not None else None
    if scenario.pickers is not None and isinstance(times, MeasuredTime):
        target = beside("times.csv")
        write_text(target, _text(times.file))
        copied = times.model_copy(update={"file": Path(target.name)})
        changes["pickers"] = scenario.pickers.model_copy(update={"unit_time": copied})
    write_text(path, to_toml(scenario.model_copy(update=changes)))
    return written


def _text(path: Path) -> str:
    """Read a file to be copied.

    Raises
    ------
    InputError
        If the file cannot be read, or is not UTF-8 text.
    """
    try:
        return read_bounded(path).decode("utf-8-sig")
    except UnicodeDecodeError:
        raise InputError(f"{path}: is not UTF-8 text") from None

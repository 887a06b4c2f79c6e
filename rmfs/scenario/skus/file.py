"""SKU sets as files: JSON with a list per column."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Annotated, Any, Literal

import numpy as np
import pydantic
from pydantic import Field

from rmfs.config import Table, validate
from rmfs.errors import InputError
from rmfs.files import read_bounded, write_text
from rmfs.scenario import exact
from rmfs.scenario.quantities import Block, Count, NotNegative, Positive, Share
from rmfs.scenario.skus.affinity import Affinity
from rmfs.scenario.skus.sku_set import SkuSet

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from numpy.typing import NDArray

FORMAT = "rmfs-skus/1"

"""Format of the file; a million SKUs take 60 MiB, and so do a million pairs."""

# a wrong value ends the reading, so that a message cannot be as long as the file
Id = Annotated[int, Field(ge=-(2**53), le=2**53)]
Ids = Annotated[list[Id], pydantic.FailFast()]
Names = Annotated[list[Annotated[str, Field(max_length=200)]], pydantic.FailFast()]
NotNegatives = Annotated[list[NotNegative], pydantic.FailFast()]
Positives = Annotated[list[Positive], pydantic.FailFast()]
Counts = Annotated[list[Count], pydantic.FailFast()]


class _AffinityFile(Block):
    share: Share
    default_weight: NotNegative
    first: Ids
    second: Ids
    weight: NotNegatives


class _SkuSetFile(Block):
    format: Literal["rmfs-skus/1"]
    description: str = ""
    ids: Ids = Field(min_length=1)
    names: Names = Field(default_factory=list)
    popularity: NotNegatives
    space_per_unit: Positives
    bundle_units: Counts
    affinity: _AffinityFile | None = None
    digest: str | None = None


def write_sku_set(skus: SkuSet, path: Path, description: str = "") -> None:
    """Write a SKU set to a file from which `read_sku_set` returns the same set.

    Raises
    ------
    InputError
        If the name does not end in .json or the file cannot be written.
    """
    if path.suffix.lower() != ".json":
        raise InputError(f"{path}: must end in .json")
    content: Table = {
        "format": FORMAT,
        "description": description,
        "digest": skus.digest(),
        "ids": skus.ids.tolist(),
        "popularity": skus.popularity.tolist(),
        "space_per_unit": skus.space_per_unit.tolist(),
        "bundle_units": skus.bundle_units.tolist(),
    }
    if skus.names:
        content["names"] = list(skus.names)
    if skus.affinity is not None:
        content["affinity"] = {
            "share": skus.affinity.share,
            "default_weight": skus.affinity.default_weight,
            "first": skus.ids[skus.affinity.first].tolist(),
            "second": skus.ids[skus.affinity.second].tolist(),
            "weight": skus.affinity.weight.tolist(),
        }
    # a line per column
    lines = (f"  {json.dumps(key)}: {json.dumps(value)}" for key, value in content.items())
    write_text(path, "{\n" + ",\n".join(lines) + "\n}\n")


def read_sku_set(path: Path) -> SkuSet:
    """Read a SKU set.

    Raises
    ------
    InputError
        If the file cannot be read, is not a valid SKU set, or has a digest that does not match its
        contents.
    """
    source = str(path)
    given = validate(_SkuSetFile, _parsed(path), source)
    ids = np.array(given.ids, dtype=np.int64)
    columns: dict[str, Sequence[Any]] = {
        "names": given.names or given.ids,
        "popularity": given.popularity,
        "space_per_unit": given.space_per_unit,
        "bundle_units": given.bundle_units,
    }
    _check_lengths(columns, len(ids), source)
    if len(np.unique(ids)) < len(ids):
        raise InputError(f"{source}: ids: a SKU occurs twice")
    if not any(given.popularity):
        raise InputError(f"{source}: popularity: at least one value must be positive")
    skus = SkuSet(
        ids=ids,
        popularity=exact.significant(np.array(given.popularity)),
        space_per_unit=exact.space(np.array(given.space_per_unit)),
        bundle_units=np.array(given.bundle_units, dtype=np.int64),
        affinity=None if given.affinity is None else _affinity(given.affinity, ids, source),
        names=tuple(given.names),
    )
    if given.digest not in (None, skus.digest()):
        raise InputError(
            f"{source}: digest: does not match the content, whose digest is {skus.digest()} "
            f"(given: {given.digest!r:.80})"
        )
    return skus


def _affinity(given: _AffinityFile, ids: NDArray[np.int64], source: str) -> Affinity:
    ends = {"first": given.first, "second": given.second}
    _check_lengths(
        {"affinity.second": given.second, "affinity.weight": given.weight},
        len(given.first),
        source,
    )
    order = np.argsort(ids, kind="stable")
    found = {}
    for key, values in ends.items():
        wanted = np.array(values, dtype=np.int64)
        at = order[np.minimum(np.searchsorted(ids, wanted, sorter=order), len(ids) - 1)]
        unknown = wanted[ids[at] != wanted]
        if len(unknown):
            raise InputError(f"{source}: affinity.{key}: SKU {unknown[0]} is not among ids")
        found[key] = at
    return Affinity(
        first=found["first"],
        second=found["second"],
        weight=np.array(given.weight, dtype=np.float64),
        default_weight=given.default_weight,
        share=given.share,
    )


def _check_lengths(columns: dict[str, Sequence[Any]], length: int, source: str) -> None:
    for key, values in columns.items():
        if len(values) != length:
            raise InputError(f"{source}: {key}: {len(values)} values, expected {length}")


def _parsed(path: Path) -> Table:
    content = read_bounded(path)
    try:
        table = json.loads(content)
    except (ValueError, RecursionError) as error:
        raise InputError(f"{path}: not valid JSON: {error}") from None
    if not isinstance(table, dict):
        raise InputError(f'{path}: expected an object with "format": "{FORMAT}"')
    return table

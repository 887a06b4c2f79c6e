"""Output of a synthetic twin of an order file: a table of the main figures, and files."""

from __future__ import annotations

import csv
import io
from math import isfinite
from pathlib import Path
from typing import TYPE_CHECKING

from rich.table import Table

from rmfs.errors import InputError
from rmfs.files import write_text
from rmfs.scenario.parameters import SkuFile
from rmfs.scenario.skus import write_sku_set
from rmfs.scenario.toml import to_toml

if TYPE_CHECKING:
    from rmfs.scenario.twin.fitting import Twin

COLUMNS = ("kind", "name", "value", "low", "high", "twin", "p")


def write_twin(twin: Twin, path: Path) -> None:
    """Write the scenario of a twin and, if the twin has a list of SKUs (`Twin.skus`), this list.

    If `path` is NAME.toml, the SKUs are written to NAME-skus.json in the same folder.

    Raises
    ------
    InputError
        If a file cannot be written.
    """
    scenario = twin.scenario
    if twin.skus is not None:
        beside = path.with_name(f"{path.stem}-skus.json")
        write_sku_set(twin.skus, beside, scenario.description)
        own = SkuFile(file=beside).model_copy(update={"file": Path(beside.name)})
        scenario = scenario.model_copy(update={"skus": own})
    write_text(path, to_toml(scenario))


def write_table(twin: Twin, path: Path) -> None:
    """Write all estimates and agreements of a twin as CSV.

    Raises
    ------
    InputError
        If `path` does not end in .csv, or the file cannot be written.
    """
    if path.suffix.lower() != ".csv":
        raise InputError(f"{path}: must end in .csv")
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(COLUMNS)
    for one in twin.estimates:
        numbers = map(_plain, (one.value, one.low, one.high))
        writer.writerow(("parameter", one.name, *numbers, "", ""))
    for other in twin.agreements:
        data, made, p = map(_plain, (other.data, other.twin, other.p))
        writer.writerow(("fit", other.name, data, "", "", made, p))
    write_text(path, text.getvalue())


def told(twin: Twin) -> Table:
    """Return the main estimates and all agreements of a twin as a table for a terminal."""
    table = Table("", "orders", "95 % interval", "twin", "p", box=None)
    for one in twin.estimates:
        if one.name in ("SKUs", "popularity shape", "affinity share"):
            table.add_row(one.name, f"{one.value:.4g}", f"{one.low:.4g} to {one.high:.4g}", "", "")
    for other in twin.agreements:
        p = f"{other.p:.3f}" if isfinite(other.p) else ""
        table.add_row(other.name, _short(other.data), "", _short(other.twin), p)
    return table


def _plain(number: float) -> str:
    return f"{number:.9g}" if isfinite(number) else ""


def _short(number: float) -> str:
    return f"{number:.4g}" if isfinite(number) else ""

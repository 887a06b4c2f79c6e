"""Reading scenario files."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

from rmfs.config import apply_overrides, read_toml, validate
from rmfs.instances import locate
from rmfs.scenario.parameters import Scenario

if TYPE_CHECKING:
    from collections.abc import Sequence

    from rmfs.config import Table


def load(name_or_path: str | Path, overrides: Sequence[tuple[Sequence[str], Any]] = ()) -> Scenario:
    """Read a scenario.

    Parameters
    ----------
    name_or_path
        A TOML file, or the name of a shipped scenario.
    overrides
        Pairs of a path of keys and a value, for example `(["duration_s"], 7200)`; they replace
        what the file says before it is checked.

    Raises
    ------
    InputError
        One line that names the file and everything wrong in it.
    """
    path = locate("scenarios", str(name_or_path))
    table = read_toml(path)
    table.setdefault("name", path.stem)
    _anchor_sku_file(table, path.resolve().parent)
    table = apply_overrides(table, [(list(keys), value) for keys, value in overrides])
    return validate(Scenario, table, str(path))


def _anchor_sku_file(table: Table, folder: Path) -> None:
    """Make the path of a SKU file absolute: in a scenario it is relative to the scenario's folder.

    In an override it is relative to the working directory, as every path on the command line.
    """
    skus = table.get("skus")
    if isinstance(skus, dict) and isinstance(skus.get("file"), str):
        skus["file"] = str(folder / skus["file"])

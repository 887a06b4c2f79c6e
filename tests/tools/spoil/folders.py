"""Spoiling run folders and folders of experiments: tables, traces, JSON, whole files."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

from tests.tools.spoil import mutations

if TYPE_CHECKING:
    from pathlib import Path
    from random import Random

FAR = (-2, -1, 2**31 - 1, 10**6, 0)


def spoil_run(rng: Random, folder: Path) -> None:
    """Spoil one file of a run folder: the trace and the events more often than the rest."""
    often = ["trace.parquet", "events.parquet", "layout.json", "run.json"]
    others = sorted(path.name for path in folder.glob("*.parquet"))
    name = rng.choice(often if rng.random() < 0.7 else others)
    spoil_file(rng, folder / name)


def spoil_study(rng: Random, folder: Path) -> None:
    """Spoil one file of a folder of an experiment."""
    spoil_file(rng, rng.choice(sorted(path for path in folder.rglob("*") if path.is_file())))


def spoil_file(rng: Random, path: Path) -> None:
    """Spoil one file: by its values if they can be read, or as bytes, or take it away."""
    chance = rng.random()
    if chance < 0.05:
        path.unlink()
    elif chance < 0.2:
        path.write_bytes(mutations.raw(rng, path.read_bytes()))
    elif path.suffix == ".parquet":
        spoil_table(rng, path)
    elif path.suffix == ".json":
        told = mutations.tree(rng, json.loads(path.read_text("utf-8")))
        path.write_text(json.dumps(told), encoding="utf-8", errors="surrogatepass")
    elif path.suffix == ".csv":
        path.write_bytes(mutations.rows(rng, path.read_text("utf-8")))
    else:
        path.write_bytes(mutations.text(rng, path.read_text("utf-8", "replace")))


def spoil_table(rng: Random, path: Path) -> None:
    """Spoil cells, rows, columns or types of a Parquet file; its metadata stay."""
    import pyarrow as pa  # type: ignore[import-untyped]
    from pyarrow import parquet

    table = parquet.read_table(path)
    names = table.column_names
    columns: dict[str, list[Any]] = table.to_pydict()
    name, rows = rng.choice(names), table.num_rows
    types = {one: table.schema.field(one).type for one in names}
    match rng.choice(("cell",) * 6 + ("text", "missing", "drop", "delete", "twice", "order")):
        case "cell" if rows:
            at = rng.randrange(rows)
            columns[name][at] = _cell(rng, columns[name][at])
        case "text":
            columns[name], types[name] = [str(value) for value in columns[name]], pa.string()
        case "missing" if rows:
            columns[name][rng.randrange(rows)] = None
        case "drop":
            del columns[name]
        case "delete" if rows:
            at = rng.randrange(rows)
            columns = {one: values[:at] + values[at + 1 :] for one, values in columns.items()}
        case "twice" if rows:
            at = rng.randrange(rows)
            columns = {one: values[: at + 1] + values[at:] for one, values in columns.items()}
        case "order":
            columns = {one: values[::-1] for one, values in columns.items()}
    arrays = {}
    for one, values in columns.items():
        try:
            arrays[one] = pa.array(values, types[one])
        except (pa.ArrowException, OverflowError):  # a number too large for the column
            arrays[one] = pa.array([None if v is None else str(v) for v in values])
    new = pa.table(arrays).replace_schema_metadata(table.schema.metadata)
    parquet.write_table(new, path)


def _cell(rng: Random, old: Any) -> Any:
    if isinstance(old, bool):
        return not old
    if isinstance(old, int):
        return rng.choice((*FAR, old + 1, old - 1, old * 2))
    if isinstance(old, float):
        return rng.choice((float("nan"), float("inf"), -old, old + 1.0, 1e300))
    if isinstance(old, str):
        return rng.choice(("", "x", old + "x", "<b>"))
    return old

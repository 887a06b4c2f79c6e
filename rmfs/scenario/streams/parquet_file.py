"""Reading and writing of Parquet files."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import pyarrow as pa  # type: ignore[import-untyped]
from pyarrow import parquet

from rmfs.errors import InputError
from rmfs.scenario.streams.columns import MOST_ROWS, Columns

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from numpy.typing import NDArray

    from rmfs.scenario.problems import Problems
    from rmfs.scenario.streams.rows import Rows

ROWS_AT_ONCE = 1 << 14

LARGEST_HEADER = 1 << 24
"""Maximum size in bytes of the metadata of a file."""


def read_parquet(path: Path, rows: Rows, problems: Problems) -> None:
    """Pass the rows of a Parquet file to a receiver, as text; rows are counted from 1.

    Errors in the contents are added to `problems`.

    Raises
    ------
    OSError
        If the file cannot be read.
    """
    try:
        with _opened(path) as file:
            columns = Columns(file.schema_arrow.names, rows)
            if file.metadata.num_rows > MOST_ROWS:
                problems.add(f"more than {MOST_ROWS} rows")
                return
            for number, fields in enumerate(_rows(file), start=1):
                rows.take(number, columns.arranged(fields))
    except (pa.ArrowException, OSError) as error:
        if isinstance(error, OSError) and error.errno is not None:
            raise
        problems.add(f"not a complete Parquet file ({str(error).splitlines()[0]:.200})")
    except ValueError as error:
        problems.add(str(error))


def parquet_rows(path: Path) -> Iterator[list[str]]:
    """Yield the names of the columns, then each row, as text.

    Raises
    ------
    InputError
        If the file cannot be read, or has more than `MOST_ROWS` rows.
    """
    try:
        with _opened(path) as file:
            if file.metadata.num_rows > MOST_ROWS:
                raise InputError(f"{path}: more than {MOST_ROWS} rows")
            yield list(file.schema_arrow.names)
            yield from _rows(file)
    except (pa.ArrowException, OSError) as error:
        if isinstance(error, OSError) and error.errno is not None:
            raise InputError(f"{path}: cannot be read ({error.strerror})") from None
        told = str(error).splitlines()[0]
        raise InputError(f"{path}: not a complete Parquet file ({told:.200})") from None


def _opened(path: Path) -> parquet.ParquetFile:
    """Open a file whose metadata are not too large."""
    return parquet.ParquetFile(
        path,
        thrift_string_size_limit=LARGEST_HEADER,
        thrift_container_size_limit=LARGEST_HEADER,
    )


def _rows(file: parquet.ParquetFile) -> Iterator[list[str]]:
    """Yield the fields of each row as text."""
    for batch in file.iter_batches(ROWS_AT_ONCE):
        for fields in zip(*(column.to_pylist() for column in batch.columns), strict=True):
            yield [_text(field) for field in fields]


def _text(field: Any) -> str:
    """Return a field as it would appear in a CSV file."""
    return "" if field is None or field != field else str(field).strip()


def write_parquet(columns: dict[str, NDArray[Any]], path: Path) -> None:
    """Write columns to a Parquet file; nan becomes an empty field."""
    table = pa.table({name: pa.array(values, from_pandas=True) for name, values in columns.items()})
    parquet.write_table(table, path)

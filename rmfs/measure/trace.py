"""The files of a trace and the versions of their formats.

`trace.parquet` contains every motion of the robots, `events.parquet` all other events, and
`layout.json` the explicit layout. These three files suffice to compute positions at any time;
checking or replaying a run also requires other files of the run folder, such as `run.json`. The
page on the trace format describes the three files.
"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

from rmfs.errors import InputError
from rmfs.measure.soundness import require_columns

if TYPE_CHECKING:
    from collections.abc import Mapping

    import pandas as pd

    from rmfs.layout.model import Layout

TRACE = "trace.parquet"
EVENTS = "events.parquet"
LAYOUT = "layout.json"

FORMATS = {TRACE: "rmfs-trace/2", EVENTS: "rmfs-events/2"}
EARLIER = {EVENTS: ("rmfs-events/1",)}
"""Older formats that can also be read; `rmfs-events/1` has fewer kinds of events."""
_KEY = b"rmfs-format"

DELTAS = ("t0_us", "t1_us", "time_us")
"""Columns stored as differences between successive rows, because this takes fewer bytes."""

TRACE_COLUMNS = (
    "robot",
    "t0_us",
    "t1_us",
    "kind",
    "from_wp",
    "to_wp",
    "heading0_rad",
    "heading1_rad",
    "pod",
    "top_speed_m_s",
)
EVENT_COLUMNS = ("time_us", "kind", "robot", "pod", "station", "order", "sku", "units", "detail")
_COLUMNS = {TRACE: TRACE_COLUMNS, EVENTS: EVENT_COLUMNS}


def write_trace(
    folder: Path, layout: Layout, motion: Mapping[str, Any], events: Mapping[str, Any]
) -> None:
    """Write the three files of a trace.

    Parameters
    ----------
    motion
        The columns of `Traffic.trace`.
    events
        The columns of `rmfs.measure.events.as_table`.

    Raises
    ------
    OSError
        If a file cannot be written.
    """
    from rmfs.layout.explicit import save_json

    save_json(layout, folder / LAYOUT)
    for name, columns in ((TRACE, motion), (EVENTS, events)):
        _write(folder / name, columns)


def _write(path: Path, columns: Mapping[str, Any]) -> None:
    import pandas as pd
    import pyarrow as pa  # type: ignore[import-untyped]
    from pyarrow import parquet

    table = pa.Table.from_pandas(pd.DataFrame(columns), preserve_index=False)
    table = table.replace_schema_metadata({_KEY: FORMATS[path.name].encode()})
    deltas = [name for name in DELTAS if name in columns]
    parquet.write_table(
        table,
        path,
        compression="zstd",
        compression_level=9,
        use_dictionary=[name for name in columns if name not in deltas],
        column_encoding=dict.fromkeys(deltas, "DELTA_BINARY_PACKED"),
    )


def read_motion(folder: Path) -> pd.DataFrame:
    """Read the motion of a run.

    Raises
    ------
    InputError
        If the file of the trace is missing, truncated, of another format or version, or lacks
        columns.
    """
    return _read(folder / TRACE)


def read_events(folder: Path) -> pd.DataFrame:
    """Read the events of a run; raises the same errors as `read_motion`."""
    return _read(folder / EVENTS)


def read_layout(folder: Path) -> Layout:
    """Read the layout of a run; raises `InputError` if its file is missing or invalid."""
    from rmfs.layout.explicit import read_json

    if not (folder / LAYOUT).is_file():
        raise _missing(folder / LAYOUT)
    return read_json(folder / LAYOUT)


def _read(path: Path) -> pd.DataFrame:
    import pyarrow as pa
    from pyarrow import parquet

    if not path.is_file():
        raise _missing(path)
    try:
        with parquet.ParquetFile(path) as file:
            _check(path, file.schema_arrow)
            table = file.read()
        require_columns(path, table, _COLUMNS[path.name])
        frame: pd.DataFrame = table.to_pandas()
        return frame
    except InputError:
        raise
    except (OSError, ValueError, pa.ArrowException) as error:
        reason = str(error).splitlines()[0] if str(error) else type(error).__name__
        raise InputError(f"{path}: truncated or not a trace ({reason})") from None


def _check(path: Path, schema: Any) -> None:
    """Refuse files of other formats or versions, and files that lack columns."""
    told = (schema.metadata or {}).get(_KEY, b"").decode("utf-8", "replace")
    expected = FORMATS[path.name]
    if told not in (expected, *EARLIER.get(path.name, ())):
        what = f"format {told!r}" if told else "not a trace of rmfs"
        raise InputError(f"{path}: {what}, expected {expected!r}")
    missing = [name for name in _COLUMNS[path.name] if name not in schema.names]
    if missing:
        raise InputError(f"{path}: column {', '.join(missing)} missing")


def _missing(path: Path) -> InputError:
    return InputError(
        f"{path.parent}: contains no trace ({path.name} is missing); run with --trace to get one"
    )

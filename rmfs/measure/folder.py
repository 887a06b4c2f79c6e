"""Writing and reading run folders: a folder is written completely or not at all."""

from __future__ import annotations

import json
import math
import shutil
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rmfs.errors import InputError
from rmfs.files import read_bounded, replacing, replacing_folder
from rmfs.measure.dictionary import TABLES, learn, names
from rmfs.measure.registry import columns_of
from rmfs.measure.results import Results
from rmfs.measure.soundness import require_events, require_motion
from rmfs.measure.told import Told, require_told
from rmfs.measure.trace import EVENTS, TRACE, read_events, read_layout, read_motion, write_trace

if TYPE_CHECKING:
    from collections.abc import Mapping
    from contextlib import AbstractContextManager

    import pandas as pd

    from rmfs.layout.model import Layout
    from rmfs.measure.checker import CheckReport
    from rmfs.measure.columns import Column
    from rmfs.measure.ended import Recorded

FORMAT = "rmfs-run/1"
PARAMETERS = "run.json"


def write_run(
    run: Recorded,
    target: Path,
    *,
    report: CheckReport | None = None,
    trace: bool = False,
    inputs: Mapping[str, str] | None = None,
) -> None:
    """Write a run folder, replacing an older one of the same name.

    Parameters
    ----------
    target
        The folder to create.
    report
        Result of the trace checker, for the column `collisions`.
    trace
        Whether to write the trace; only possible if the run has recorded one. Default False.
    inputs
        Layout, scenario and controllers as specified by the user: names or paths. Default: the
        names in `run.names`.

    Raises
    ------
    InputError
        If the folder cannot be written, or if a folder of this name contains something other than a
        run.
    """
    with reserved(target) as folder:
        fill(folder, run, report=report, trace=trace, inputs=inputs)


def reserved(target: Path, *, force: bool = True) -> AbstractContextManager[Path]:
    """Return a context manager that provides a temporary folder in which to write a run.

    If its context ends without an error, the temporary folder becomes the run folder `target`; see
    `rmfs.files.replacing_folder`.

    Parameters
    ----------
    force
        Whether to replace an older run folder of the same name. Default True.
    """
    return replacing_folder(target, PARAMETERS, "run folder", replace=force)


def fill(
    folder: Path,
    run: Recorded,
    *,
    report: CheckReport | None = None,
    trace: bool = False,
    inputs: Mapping[str, str] | None = None,
    tables: Mapping[str, pd.DataFrame] | None = None,
) -> None:
    """Write the files of a run into an existing folder; for other parameters, see `write_run`.

    Parameters
    ----------
    tables
        All tables of the run, if they have already been made. Default: they are made here.

    Raises
    ------
    InputError
        If a file cannot be written.
    """
    from rmfs.measure.events import as_table
    from rmfs.measure.footprints import all_tables
    from rmfs.measure.provenance import describe

    try:
        tables = all_tables(run, report) if tables is None else tables
        for name, frame in tables.items():
            _write_table(folder / f"{name}.parquet", frame)
        tables["footprint"].to_csv(folder / "footprint.csv", index=False, lineterminator="\n")
        if trace:
            assert run.events is not None
            write_trace(folder, run.layout, run.trace, as_table(run.events))
        parameters = plain({"format": FORMAT, **describe(run, report, inputs)})
        text = json.dumps(parameters, indent=2, ensure_ascii=False, allow_nan=False, default=str)
        (folder / PARAMETERS).write_text(text + "\n", encoding="utf-8")
    except OSError as error:
        raise InputError(f"{folder}: cannot be written ({error.strerror or error})") from None


def write_csv(run: RunFolder) -> list[Path]:
    """Write each table of a run folder as CSV beside its Parquet file; return the CSV files.

    Raises
    ------
    InputError
        If a table is missing, or the folder cannot be written.
    """
    written = []
    for name in TABLES:
        frame = run.table(name)
        path = run.path / f"{name}.csv"
        with replacing(path) as temporary:
            frame.to_csv(temporary, index=False, lineterminator="\n")
        written.append(path)
    return written


def plain(value: Any) -> Any:
    """Return `value` in a form for JSON: infinite numbers and nan are replaced by strings."""
    if isinstance(value, dict):
        return {key: plain(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [plain(item) for item in value]
    if isinstance(value, float) and not math.isfinite(value):
        return str(value)
    return value


def _write_table(path: Path, frame: pd.DataFrame) -> None:
    frame.to_parquet(path, index=False, compression="zstd")


@dataclass(frozen=True, slots=True, repr=False)
class RunFolder(Results):
    """A run loaded from its folder; tables are read on access.

    Attributes
    ----------
    path
        The folder.
    parameters
        The contents of `run.json`.
    """

    path: Path
    parameters: dict[str, Any]

    @property
    def told(self) -> Told:
        """The entries of `run.json` whose types are checked, as attributes."""
        return Told.model_validate(self.parameters)

    @property
    def own_columns(self) -> list[Column]:
        """Columns of the footprint that were added by the user's own measures."""
        return columns_of(self.parameters.get("measures", []))

    @property
    def footprint(self) -> pd.Series:
        """The footprint of the run."""
        return self.table("footprint").iloc[0]

    @property
    def trace(self) -> pd.DataFrame:
        """All pieces of motion.

        Raises
        ------
        InputError
            If the run was made without a trace, or the trace file is truncated or has another
            version of the format.
        """
        return read_motion(self.path)

    @property
    def events(self) -> pd.DataFrame:
        """All events except motion; raises the same errors as `trace`."""
        return read_events(self.path)

    @property
    def layout(self) -> Layout:
        """The layout, which is stored with the trace; raises the same errors as `trace`."""
        return read_layout(self.path)

    def check(self) -> CheckReport:
        """Check with the independent checker whether the motion is safe.

        Gaps, jumps and impossible times in the trace raise no error but are reported as findings.

        Raises
        ------
        InputError
            As for `trace`, and if the trace refers to robots, waypoints, pods or kinds of motion
            that do not exist.
        """
        from rmfs.measure.checker import Slow, check

        slow = [Slow(*one) for one in self.told.slow_robots]
        trace = {str(name): column.to_numpy() for name, column in self.trace.items()}
        return check(self.layout, trace, until_us=self.told.end_us, slow=slow)

    def replayed(self) -> tuple[Layout, pd.DataFrame, pd.DataFrame]:
        """Return the layout, the motion and the events, validated as required for a replay.

        Raises
        ------
        InputError
            If the run was made without a trace, or a file is missing, is truncated, has another
            version of the format, or contains robots, places, pods, stations, kinds or times that
            are impossible.
        """
        layout, motion, events = self.layout, self.trace, self.events
        skus = len(self.table("skus"))
        require_motion(self.path / TRACE, motion, layout, self.told.end_us)
        require_events(self.path / EVENTS, events, layout, skus, self.told.end_us)
        return layout, motion, events

    def save(self, path: str | Path, *, force: bool = False) -> RunFolder:
        """Copy the folder to `path`; see `Results.save`."""
        with reserved(Path(path), force=force) as folder:
            shutil.copytree(self.path, folder, dirs_exist_ok=True)
        return load_run(Path(path))

    def _in_folder(self, path: Path) -> RunFolder:
        return self

    def table(self, name: str) -> pd.DataFrame:
        """Read one table of the run.

        Raises
        ------
        InputError
            If there is no such table, or its file is missing or corrupted or lacks columns.
        """
        if name not in TABLES:
            raise InputError(f"{name}: no such table; valid: {', '.join(TABLES)}")
        path = self.path / f"{name}.parquet"
        frame = _read_table(path)
        missing = [column for column in names(name) if column not in frame]
        if missing:
            raise InputError(f"{path}: column {', '.join(missing)} missing")
        return frame


def load_run(path: str | Path) -> RunFolder:
    """Load a run folder; a table is read only when it is accessed.

    Raises
    ------
    InputError
        If `path` is not a run folder, or its `run.json` cannot be read, is corrupted or has another
        format.
    """
    path = Path(path)
    file = path / PARAMETERS
    if not file.exists():
        raise InputError(f"{path}: is not a run folder ({PARAMETERS} is missing)")
    try:
        parameters = json.loads(read_bounded(file))
    except (ValueError, RecursionError) as error:
        raise InputError(f"{file}: corrupted ({error!s:.200})") from None
    told = parameters.get("format") if isinstance(parameters, dict) else None
    if told != FORMAT:
        raise InputError(f"{file}: format {told!r}, expected {FORMAT!r}")
    require_told(file, parameters)
    run = RunFolder(path, parameters)
    learn(run.own_columns)
    return run


def _read_table(path: Path) -> pd.DataFrame:
    import pandas as pd
    import pyarrow  # type: ignore[import-untyped]

    try:
        return pd.read_parquet(path)
    except FileNotFoundError:
        raise InputError(f"{path}: no such file") from None
    except (OSError, ValueError, pyarrow.ArrowException) as error:
        reason = str(error).splitlines()[0] if str(error) else type(error).__name__
        raise InputError(f"{path}: corrupted ({reason})") from None

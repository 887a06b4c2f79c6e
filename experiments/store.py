"""The folder of an experiment's results.

- `plan.json`: the design, its arms and the hashes of its inputs
- `runs/`: the dataset, one small Parquet file per run; the files are merged from time to time
- `<table>/`: for each table that is kept, one Parquet file per run
- `failures/`: for each failed run, one JSON file with the traceback

Every file is written completely or not at all, so the dataset can be read at any time. A run is
stored under its key, a hash of everything that determines the run. Rows of finished runs are never
deleted, unless they are duplicates. Rows with outdated inputs are ignored, but count again if the
inputs are restored.
"""

from __future__ import annotations

import fcntl
import hashlib
import json
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pandas as pd
import pyarrow as pa  # type: ignore[import-untyped]
import pyarrow.parquet as pq  # type: ignore[import-untyped]

from rmfs.errors import InputError
from rmfs.files import replacing, write_text
from rmfs.measure.dictionary import names

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence

    from rmfs.experiments.running.job import Job, Outcome

RUNS, FAILURES, LOCK = "runs", "failures", ".lock"

MERGED = "merged-"
MANY = 256
"""Number of files of single runs that are merged into one."""

FEW = 16
"""Number of files of single runs that are read at a time."""

ORIGIN = ("run", "arm_digest", "replication", "arm", "design", "design_hash")
"""Columns of a stored row, before the footprint, that identify the run."""

CODE = ("rmfs_version", "git_commit", "code")
FINISHED = "finished"
PROVENANCE = (*CODE, "host", "elapsed_s", "cpu_s", FINISHED)
"""Columns of a stored row, after the footprint, on how the run was made; not reproducible."""

COLUMNS = [*ORIGIN, *names("footprint"), *PROVENANCE]
"""Columns of a stored row."""

_ATTEMPTS = 5

_NEVER_EMPTY = ("run", "arm_digest", "replication", "seed")


class Store:
    """Reads and writes the folder of an experiment's results.

    Parameters
    ----------
    folder
        The folder, created when something is written.
    """

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self._known: dict[Path, tuple[_Version, pa.Table]] = {}

    # writing

    @contextmanager
    def locked(self) -> Iterator[None]:
        """Lock the folder against other processes; remove half-written files of earlier processes.

        Raises
        ------
        InputError
            If another process has locked the folder, or the folder cannot be written.
        """
        try:
            (self.folder / RUNS).mkdir(parents=True, exist_ok=True)
            lock = (self.folder / LOCK).open("w")
        except OSError as error:
            raise InputError(f"{self.folder}: cannot be written ({error.strerror})") from None
        with lock:
            try:
                fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
            except OSError:
                raise InputError(f"{self.folder}: another process runs this experiment") from None
            for left in self.folder.glob("*/.*.parquet.*"):
                left.unlink(missing_ok=True)
            yield

    def add(self, job: Job, outcome: Outcome, code: Mapping[str, Any]) -> None:
        """Store the outcome of a run.

        Parameters
        ----------
        code
            Version of the code: values of the columns `rmfs_version`, `git_commit` and `code`.
        """
        if outcome.footprint is None:
            told = {
                "arm": job.arm,
                "replication": job.replication,
                "seed": job.seed,
                "design_hash": job.design_hash,
                "error": outcome.error,
                "traceback": outcome.traceback,
                "host": outcome.host,
                "failed": _now(),
            }
            text = json.dumps(told, indent=1, ensure_ascii=False)
            write_text(self.folder / FAILURES / f"{job.key}.json", text + "\n")
            return
        for name, table in outcome.tables.items():
            # the row comes last: where it is, everything is
            self._write(self.folder / name / f"{job.key}.parquet", _identified(table, job))
        row = _row(job, outcome, code)
        self._write(self.folder / RUNS / f"{job.key}.parquet", row)
        (self.folder / FAILURES / f"{job.key}.json").unlink(missing_ok=True)

    def merge(self, at_least: int = MANY) -> None:
        """Merge the files of single runs if there are at least `at_least` of them."""
        single = sorted(p for p in self._files() if not p.name.startswith(MERGED))
        if len(single) < at_least:
            return
        for start in range(0, len(single), MANY):
            chunk = single[start : start + MANY]
            # a table of one row takes a hundred times what it holds: few of them at a time
            parts = [
                _together([_read(path) for path in chunk[first : first + FEW]]).combine_chunks()
                for first in range(0, len(chunk), FEW)
            ]
            table = _together(parts)
            self._write(self.folder / RUNS / f"{MERGED}{_hash_of(chunk)}.parquet", table)
            # a reader that comes now meets some rows twice and drops the doubles
            for path in chunk:
                path.unlink()

    def _write(self, path: Path, frame: pd.DataFrame | pa.Table) -> None:
        table = (
            frame
            if isinstance(frame, pa.Table)
            else pa.Table.from_pandas(frame, preserve_index=False)
        )
        with replacing(path) as temporary:
            pq.write_table(table, temporary, compression="zstd")

    # reading

    def rows(self, columns: Sequence[str] | None = None) -> pd.DataFrame:
        """Read all rows, one per run; the frame is empty if there are none.

        If a run was repeated, its row is that of the last time.

        Parameters
        ----------
        columns
            Columns to read in addition to `run`, the key. Default: all.

        Raises
        ------
        InputError
            If a file is corrupted.
        """
        wanted = None if columns is None else list(dict.fromkeys(["run", *columns]))
        read = None if wanted is None else [*wanted, FINISHED]
        for _ in range(_ATTEMPTS):
            try:
                paths = sorted(self._files())
                tables = [self._rows(path, read) for path in paths]
                self._known = {p: self._known[p] for p in paths if p in self._known}
                break
            except FileNotFoundError:
                continue  # merged in between
        else:
            raise InputError(f"{self.folder / RUNS}: files disappear while they are read")
        if not tables:
            return pd.DataFrame(columns=pd.Index(wanted or COLUMNS))
        frame = _newest(_together(tables).to_pandas())
        return frame if wanted is None or FINISHED in wanted else frame.drop(columns=FINISHED)

    def _rows(self, path: Path, columns: Sequence[str] | None) -> pa.Table:
        """Return what `_rows` reads; a file that has been read as a whole is not read again."""
        version = _version(path)
        before = self._known.get(path)
        if before is not None and before[0] == version:
            table = before[1]
            if columns is None:
                return table
            # like reading: a column that the file lacks is left out
            return table.select([name for name in table.column_names if name in columns])
        table = _rows(path, columns)
        if columns is None:
            self._known[path] = version, table
        return table

    def finished(self, tables: Sequence[str] = ()) -> set[str]:
        """Return the keys of the finished runs for which all of `tables` are stored."""
        keys = set(self.rows(columns=[])["run"])
        for table in tables:
            keys &= {path.stem for path in (self.folder / table).glob("*.parquet")}
        return keys

    def table(self, name: str, keys: Sequence[str]) -> pd.DataFrame:
        """Read a kept table of the runs with these keys; runs without the table are left out.

        Raises
        ------
        InputError
            If the table was not kept for any run, or one of its files is corrupted.
        """
        if not (self.folder / name).is_dir():
            raise InputError(f'{self.folder}: table {name} was not kept; set keep = ["{name}"]')
        paths = [self.folder / name / f"{key}.parquet" for key in keys]
        tables = [_read(path) for path in paths if path.is_file()]
        return _together(tables).to_pandas() if tables else pd.DataFrame({"run": []})

    def failures(self) -> pd.DataFrame:
        """Return the failed runs, one row each.

        Raises
        ------
        InputError
            If a file is corrupted.
        """
        columns = ["run", "arm", "replication", "seed", "error", "traceback", "design_hash"]
        found = []
        for path in sorted((self.folder / FAILURES).glob("*.json")):
            # one that has vanished was made good in between
            with suppress(FileNotFoundError):
                found.append({"run": path.stem, **_read_failure(path, columns[1:])})
        return pd.DataFrame(found, columns=pd.Index(columns))

    def _files(self) -> list[Path]:
        # hidden ones are being written
        return [p for p in (self.folder / RUNS).glob("*.parquet") if not p.name.startswith(".")]


_Version = tuple[int, int, int]


def _version(path: Path) -> _Version:
    """Return what changes if a file is replaced; raises FileNotFoundError if it is not there."""
    found = path.stat()
    return found.st_ino, found.st_size, found.st_mtime_ns


def _read(path: Path, columns: Sequence[str] | None = None) -> pa.Table:
    """Read a stored table.

    Raises
    ------
    InputError
        If it is corrupted.
    FileNotFoundError
        If it is not there.
    """
    try:
        # of one file: no dataset of the folder, which costs more than the reading
        with pq.ParquetFile(path) as file:
            table = file.read(columns=None if columns is None else list(columns))
    except FileNotFoundError:
        raise
    except (OSError, pa.ArrowException) as error:
        raise _corrupted(path, str(error)) from None
    if "run" not in table.column_names:
        raise _corrupted(path, "no column run")
    return table


def _rows(path: Path, columns: Sequence[str] | None) -> pa.Table:
    """Read rows of runs, and check the columns that identify them; raises what `_read` raises."""
    table = _read(path, columns)
    for name in _NEVER_EMPTY if columns is None else set(columns) & set(_NEVER_EMPTY):
        if name not in table.column_names or table[name].to_pandas().isna().any():
            raise _corrupted(path, f"{name} is empty in a row")
    return table


def _newest(rows: pd.DataFrame) -> pd.DataFrame:
    """Return the row of each run that was finished last."""
    in_time = rows.sort_values(FINISHED, kind="stable", na_position="first")
    return in_time.drop_duplicates("run", keep="last").sort_index(ignore_index=True)


def _read_failure(path: Path, keys: Sequence[str]) -> dict[str, Any]:
    """Read the record of a failed run.

    Raises
    ------
    InputError
        If it is corrupted.
    FileNotFoundError
        If it is not there.
    """
    try:
        told = json.loads(path.read_text(encoding="utf-8"))
    except ValueError as error:
        raise _corrupted(path, str(error)) from None
    lacking = [key for key in keys if key not in told] if isinstance(told, dict) else keys
    if lacking:
        raise _corrupted(path, f"no {', '.join(lacking)}")
    return dict(told)


def _hash_of(chunk: Sequence[Path]) -> str:
    """Return a hash of the runs in these files, so that other runs are merged into another file."""
    return hashlib.sha256(" ".join(path.stem for path in chunk).encode()).hexdigest()[:24]


def _corrupted(path: Path, why: str) -> InputError:
    return InputError(
        f"{path}: corrupted ({' '.join(why.split())}); remove it and run the experiment "
        "again: only the runs in it are repeated"
    )


def _together(tables: list[pa.Table]) -> pa.Table:
    # rows of other versions of rmfs may have other columns
    try:
        return pa.concat_tables(tables, promote_options="permissive")
    except pa.ArrowException as error:
        raise InputError(
            f"stored results are incompatible ({' '.join(str(error).split())}); remove those "
            "with another type and run the experiment again: only the runs in them are "
            "repeated"
        ) from None


def _identified(table: pd.DataFrame, job: Job) -> pd.DataFrame:
    made = table.copy(deep=False)
    made.insert(0, "run", job.key)
    return made


def _row(job: Job, outcome: Outcome, code: Mapping[str, Any]) -> pd.DataFrame:
    assert outcome.footprint is not None
    before: dict[str, Any] = {
        "run": job.key,
        "arm_digest": job.arm_digest,
        "replication": job.replication,
        "arm": job.arm,
        "design": job.design,
        "design_hash": job.design_hash,
    }
    after = {
        **{name: str(code.get(name, "")) for name in CODE},
        "host": outcome.host,
        "elapsed_s": outcome.elapsed_s,
        "cpu_s": outcome.cpu_s,
        "finished": _now(),
    }
    parts = [
        pd.DataFrame([before], columns=pd.Index(ORIGIN)),
        outcome.footprint.reset_index(drop=True),
        pd.DataFrame([after], columns=pd.Index(PROVENANCE)),
    ]
    return pd.concat(parts, axis=1)


def _now() -> str:
    import datetime

    return datetime.datetime.now(datetime.UTC).isoformat(timespec="milliseconds")

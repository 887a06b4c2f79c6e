"""Best known values and bounds: one row per question, and the best answer as a file.

`FAMILY/SIZE/NAME.json.gz` is a question, `NAME.solution.json.gz` its best known answer, and
`best.csv` the table. Values and bounds are entered only by `Library.enter`, which accepts an answer
only if `checking` does, and refuses a value and a bound that contradict each other.
"""

from __future__ import annotations

import csv
import fcntl
import math
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from datetime import UTC, datetime
from typing import TYPE_CHECKING

import pandas as pd

from rmfs.errors import InputError
from rmfs.files import write_text
from rmfs.measure.provenance import commit, version
from rmfs.solvers.decisions.checking import TOLERANCE, check
from rmfs.solvers.decisions.files import Found, read, read_solution, write_solution

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from rmfs.solvers.decisions.files import Decision

TABLE = "best.csv"
LOCK = ".lock"
OPTIMAL, OPEN = "optimal", "open"
PROVEN = 1e-4
"""Relative gap that counts as zero, because CP-SAT rounds costs (for example to 1/1024 s)."""


@dataclass(frozen=True)
class Row:
    """Best known results of one question.

    Attributes
    ----------
    question
        Name of the question.
    family, size, load, moment
        Family of the question, and its origin: the size of the site, the kind of demand, and the
        part of the run (such as `early`).
    value, bound
        Best known value and bound; nan if there is none.
    value_by, bound_by
        How value and bound were found: method and limit, or the name of a solver or a person.
    value_when, bound_when
        Day of entry, and version and commit of rmfs.
    """

    question: str
    family: str
    size: str
    load: str = ""
    moment: str = ""
    value: float = math.nan
    value_by: str = ""
    value_when: str = ""
    bound: float = math.nan
    bound_by: str = ""
    bound_when: str = ""

    @property
    def gap(self) -> float:
        """Relative gap, ``|value - bound| / max(|value|, |bound|)``; nan if either is missing."""
        apart = abs(self.value - self.bound)
        return 0.0 if apart == 0.0 else apart / max(abs(self.value), abs(self.bound))

    @property
    def status(self) -> str:
        """`optimal` if value and bound agree within `PROVEN`, else `open`."""
        near = abs(self.value - self.bound) <= PROVEN * max(1.0, abs(self.value))
        return OPTIMAL if near else OPEN


@dataclass
class Library:
    """A folder of questions with its table.

    Attributes
    ----------
    folder
        Path of the library.
    rows
        Rows of the table, by name of the question.
    """

    folder: Path
    rows: dict[str, Row] = field(default_factory=dict)

    @classmethod
    def load(cls, folder: Path) -> Library:
        """Read the table, and add a row for each question in the folder that has none yet.

        Raises
        ------
        InputError
            If the folder contains no question.
        """
        known = {row.question: row for row in _rows(folder / TABLE)}
        rows = {}
        for path in questions(folder):
            name = path.name.removesuffix(".json.gz")
            rows[name] = known.get(name) or _first(path)
        if not rows:
            raise InputError(f"{folder}: no decision files")
        return cls(folder, rows)

    def path(self, row: Row) -> Path:
        """Return the file of a question."""
        return self.folder / row.family / row.size / f"{row.question}.json.gz"

    def answer(self, row: Row, decision: Decision) -> Found | None:
        """Return the best known answer; None if there is none."""
        path = _answer(self.path(row))
        return read_solution(decision, path) if path.exists() else None

    def enter(
        self, decision: Decision, found: Found | None, by: str, bound: float = math.nan
    ) -> list[str]:
        """Enter an answer and a bound, each if it is better than the known one; save the table.

        Parameters
        ----------
        decision
            A question of the library.
        found
            The answer, or None to enter only a bound; the answer's own bound is ignored.
        by
            How answer or bound was found, for the table.
        bound
            A proven bound. Default: none.

        Returns
        -------
        List of what was improved: `value`, `bound`, both or neither.

        Raises
        ------
        WrongError
            If the answer is infeasible.
        InputError
            If the question is not in the library, or value and bound contradict each other.
        """
        if decision.name not in self.rows:
            raise InputError(f"{decision.name}: is not in {self.folder}")
        with self._alone():
            return self._entered(decision, found, by, bound)

    def _entered(self, decision: Decision, found: Found | None, by: str, bound: float) -> list[str]:
        row = self.rows[decision.name]
        better, sign = [], decision.sign
        kept: Found | None = None
        when = stamp()
        if found is not None and found.is_there:
            value = check(decision, replace(found, bound=math.nan))
            slack = 1e-9 * max(1.0, abs(value))
            if math.isnan(row.value) or (row.value - value) * sign > slack:
                _refuse_beyond(row, value, row.bound, sign)
                row = replace(row, value=value, value_by=by, value_when=when)
                kept = replace(
                    found, objective=value, bound=math.nan, by={**found.by, "entered_by": by}
                )
                better.append("value")
        if math.isfinite(bound) and (math.isnan(row.bound) or (bound - row.bound) * sign > 0):
            _refuse_beyond(row, row.value, bound, sign)
            row = replace(row, bound=bound, bound_by=by, bound_when=when)
            better.append("bound")
        # nothing is written before value and bound are known to agree
        if kept is not None:
            write_solution(decision, kept, _answer(self.path(row)))
        if better:
            self.rows[row.question] = row
            self.save()
        return better

    @contextmanager
    def _alone(self) -> Iterator[None]:
        """Lock the table against other processes, and read the rows that they have entered."""
        with (self.folder / LOCK).open("w") as lock:
            fcntl.flock(lock, fcntl.LOCK_EX)
            for row in _rows(self.folder / TABLE):
                if row.question in self.rows:
                    self.rows[row.question] = row
            yield

    def save(self) -> None:
        """Write the table atomically."""
        write_text(self.folder / TABLE, self.frame().to_csv(index=False))

    def frame(self) -> pd.DataFrame:
        """Return the table, sorted by family, size and name, with gap and status."""
        rows = sorted(self.rows.values(), key=lambda row: (row.family, row.size, row.question))
        return pd.DataFrame([{**vars(row), "gap": row.gap, "status": row.status} for row in rows])


def questions(folder: Path) -> Iterator[Path]:
    """Yield the paths of the question files below a folder, sorted."""
    for path in sorted(folder.rglob("*.json.gz")):
        if ".solution." not in path.name:
            yield path


def stamp() -> str:
    """Return the day, version and commit to record with an entry."""
    head = commit()["git_commit"]
    return f"{datetime.now(UTC):%Y-%m-%d} rmfs {version()} {(head or 'no commit')[:12]}"


def _answer(question: Path) -> Path:
    return question.with_name(question.name.replace(".json.gz", ".solution.json.gz"))


def _first(path: Path) -> Row:
    decision = read(path)
    drawn = decision.provenance.get("drawn", {})
    return Row(
        decision.name,
        decision.family,
        path.parent.name,
        str(drawn.get("load", "")),
        str(drawn.get("moment", "")),
    )


def _rows(path: Path) -> Iterator[Row]:
    if not path.exists():
        return
    # read line by line: every number as the double that was written
    with path.open(encoding="utf-8", newline="") as file:
        for told in csv.DictReader(file):
            given = {key: told[key] for key in Row.__dataclass_fields__ if key in told}
            value, bound = (float(given.pop(key, "") or math.nan) for key in ("value", "bound"))
            yield Row(**given, value=value, bound=bound)


def _refuse_beyond(row: Row, value: float, bound: float, sign: int) -> None:
    if (bound - value) * sign > TOLERANCE * max(1.0, abs(value)):
        raise InputError(
            f"{row.question}: bound {bound!r} contradicts value {value!r}: one of them is wrong"
        )

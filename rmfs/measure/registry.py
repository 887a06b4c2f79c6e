"""Finds the classes of the measures that users specify.

A measure can be given as a class, as a reference (`module:Class` or `path/to/file.py:Class`), or
by name if an installed distribution has an entry point of this name in the group `rmfs.measures`.
"""

from __future__ import annotations

import difflib
import hashlib
import re
from functools import cache
from importlib.metadata import entry_points
from typing import TYPE_CHECKING, Any, get_args

from rmfs.errors import InputError
from rmfs.measure.base import Measure
from rmfs.measure.columns import DTYPES, Better, Column
from rmfs.measure.dictionary import FOOTPRINT, learn
from rmfs.references import is_reference, reference_of, resolve, source_file

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Sequence

GROUP = "rmfs.measures"
"""Entry-point group of third-party measures."""

RESERVED = frozenset(
    ("arm", "arm_digest", "code", "cpu_s", "design", "design_hash", "elapsed_s", "finished")
) | frozenset(("git_commit", "host", "replication", "rmfs_version", "run", "stage"))
"""Columns of experiment tables besides those of the footprint."""

_NAME = re.compile(r"[a-z][a-z0-9_]*")


def find(given: str | type[Measure]) -> type[Measure]:
    """Find the class of one measure.

    Raises
    ------
    InputError
        If there is no such measure, or it declares invalid columns.
    """
    if isinstance(given, str) and not is_reference(given):
        known = _installed()
        if given not in known:
            near = difflib.get_close_matches(given, known, n=1)
            hint = f"did you mean {near[0]}?" if near else _what_is_valid(sorted(known))
            raise InputError(f"no measure named {given}; {hint}")
        found = resolve(known[given], Measure, "measure")
    else:
        found = resolve(given, Measure, "measure")
    for problem in _problems(found):
        raise InputError(f"measure {found.__qualname__}: {problem}")
    learn(found.columns)
    return found


def find_all(given: Iterable[str | type[Measure]]) -> list[type[Measure]]:
    """Find the classes of several measures.

    Raises
    ------
    InputError
        As for `find`; also if two of them have a column of the same name.
    """
    found = list(dict.fromkeys(find(one) for one in given))
    owners: dict[str, type[Measure]] = {}
    for measure in found:
        for column in measure.columns:
            other = owners.setdefault(column.name, measure)
            if other is not measure:
                raise InputError(
                    f"measure {measure.__qualname__}: {other.__qualname__} also has a column "
                    f"{column.name}"
                )
    return found


def described(measures: Iterable[type[Measure]]) -> list[dict[str, Any]]:
    """Describe users' measures, each by its name, reference, hash of the source file, and columns.

    The reference is None for a measure that cannot be imported elsewhere, for example because it
    was defined in a notebook.
    """
    told = []
    for measure in measures:
        file = source_file(measure)
        try:
            reference: str | None = reference_of(measure)
        except InputError:  # defined in a notebook, so it cannot be found again
            reference = None
        told.append(
            {
                "name": measure.__qualname__,
                "reference": reference,
                "sha256": None if file is None else hashlib.sha256(file.read_bytes()).hexdigest(),
                "columns": [column.to_table() for column in measure.columns],
            }
        )
    return told


def columns_of(told: Sequence[dict[str, Any]]) -> list[Column]:
    """Return the columns of the measures in `told`, the result of `described`.

    The columns are also registered, so that tables and plots can describe them.
    """
    columns = [Column.from_table(column) for one in told for column in one["columns"]]
    learn(columns)
    return columns


@cache
def _installed() -> dict[str, str]:
    return {entry.name: entry.value for entry in entry_points(group=GROUP)}


def _what_is_valid(known: Sequence[str]) -> str:
    names = f"installed: {', '.join(known)}" if known else "none is installed"
    return f"{names}; a class of your own is given as module:Class or path/to/file.py:Class"


def _problems(measure: type[Measure]) -> Iterator[str]:
    """Yield what is wrong with the declared columns."""
    columns = list(measure.columns)
    if not columns:
        yield "declares no `columns`"
    shipped = {column.name for column in FOOTPRINT}
    seen: set[str] = set()
    for column in columns:
        if not isinstance(column, Column):
            yield f"columns: {column!r} is not an rmfs.measure.Column"
            return
        if not _NAME.fullmatch(column.name):
            yield f"column {column.name!r}: must consist of lower-case letters, digits and _"
        elif column.name in shipped or column.name in RESERVED or column.name in seen:
            yield f"column {column.name}: a column of this name exists already"
        if column.dtype not in DTYPES:
            yield (
                f"column {column.name}: type {column.dtype!r} is invalid; valid: "
                f"{', '.join(DTYPES)}"
            )
        if column.better not in get_args(Better):
            yield (
                f"column {column.name}: better must be more, less or neither "
                f"(given: {column.better!r})"
            )
        seen.add(column.name)

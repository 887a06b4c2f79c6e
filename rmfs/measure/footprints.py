"""Computes the footprint and the tables of a finished run."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from rmfs.errors import InputError
from rmfs.measure.dictionary import footprint_columns
from rmfs.measure.ended import EndedRun
from rmfs.measure.tables import MAKERS
from rmfs.measure.tables.tidy import tidy

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence

    import pandas as pd

    from rmfs.measure.base import Measure
    from rmfs.measure.checker import CheckReport
    from rmfs.measure.ended import Measured


def footprint(run: EndedRun, measures: Sequence[Measure]) -> pd.DataFrame:
    """Return the footprint as a table with one row.

    Raises
    ------
    InputError
        If a measure does not return exactly the columns that it declares, or returns a value of the
        wrong type.
    """
    values: dict[str, Any] = {}
    for measure in measures:
        values |= _values(measure, measure.footprint(run))
    row = {name: [value] for name, value in values.items()}
    columns = footprint_columns(measures)
    try:
        return tidy("footprint", columns, row)
    except (TypeError, ValueError, OverflowError) as error:
        wrong = next(iter(_misfits(columns, row)), None)
        if wrong is None:
            raise
        owner = next(type(m).__qualname__ for m in measures if wrong in {c.name for c in m.columns})
        raise InputError(
            f"measure {owner}: {wrong}: {values[wrong]!r} does not fit its type ({error})"
        ) from None


def all_tables(run: Measured, report: CheckReport | None = None) -> dict[str, pd.DataFrame]:
    """Return all tables of a run by name.

    In the footprint, the column `collisions` is empty if no `report` is given.
    """
    return some_tables(run, MAKERS, report)


def some_tables(
    run: Measured, names: Iterable[str], report: CheckReport | None = None
) -> dict[str, pd.DataFrame]:
    """Return the footprint and the tables listed in `names`; the keys are the tables' names.

    In the footprint, the column `collisions` is empty if no `report` is given.
    """
    ended = EndedRun(run, report)
    made = {"footprint": footprint(ended, run.measures)}
    return made | {name: ended.tables[name] for name in names}


def _values(measure: Measure, told: Mapping[str, Any]) -> dict[str, Any]:
    """Check that a measure returned the columns it declares."""
    declared = {column.name for column in measure.columns}
    wrong = sorted(declared ^ set(told))
    if wrong:
        raise InputError(
            f"measure {type(measure).__qualname__}: {', '.join(wrong)}: must be both declared in "
            "`columns` and returned by `footprint`"
        )
    return dict(told)


def _misfits(columns: Sequence[Any], row: Mapping[str, Any]) -> Iterable[str]:
    """Yield the columns whose value has the wrong type."""
    for column in columns:
        try:
            tidy("footprint", [column], {column.name: row[column.name]})
        except (TypeError, ValueError, OverflowError):
            yield column.name

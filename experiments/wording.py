"""Headings of columns and formats of p values in tables and figures."""

from __future__ import annotations

from rmfs.measure.dictionary import TABLES, learnt

SMALL = 0.001
"""Smallest p value that is written as a number; below it, "<" is used."""

_EFFECTS = {
    "sum_sq": "sum of squares",
    "f": "F",
    "eta_sq": "η²",
    "partial_eta_sq": "partial η²",
    "partial_eta_sq_low": "low",
    "partial_eta_sq_high": "high",
    "omega_sq": "ω²",
}


def heading(column: str) -> str:
    """Return the heading of a column of a table, in words with the unit.

    If `column` contains a comma, the text after it is not changed.
    """
    name, comma, rest = column.partition(",")
    known = {one.name for one in (*TABLES["footprint"], *learnt())}
    return (axis_label(name) if name in known else _EFFECTS.get(name, name)) + comma + rest


def p_value(p: float) -> str:
    """Format a p value as in papers: with three decimal places, or as "<0.001"; nan as "-"."""
    if p != p:
        return "-"
    return f"<{SMALL}" if p < SMALL else f"{p:.3f}"


def axis_label(column: str, table: str = "footprint", *, per: str = "") -> str:
    """Return an axis label for a column, in words with the unit.

    Parameters
    ----------
    per
        Unit by which a count is divided, such as "hour".
    """
    known = {one.name: one.unit for one in (*TABLES[table], *learnt())}
    unit = known.get(column, "")
    if column.endswith("_per_h"):
        return f"{_words(column.removesuffix('_per_h'))} per hour"
    for suffix in ("_s", "_m", "_share"):
        column = column.removesuffix(suffix)
    words = _words(column)
    if unit and unit not in words:
        return f"{words} ({unit} per {per})" if per else f"{words} ({unit})"
    return f"{words} per {per}" if per else words


def _words(column: str) -> str:
    return column.replace("_", " ")

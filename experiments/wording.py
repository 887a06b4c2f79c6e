"""How columns, effects and p values are written for people."""

from __future__ import annotations

from rmfs.measure.dictionary import TABLES, learnt

SMALL = 0.001
"""Below it, a p value is only said to be smaller."""

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

    What follows a comma stays as it is.
    """
    name, comma, rest = column.partition(",")
    known = {one.name for one in (*TABLES["footprint"], *learnt())}
    return (axis_label(name) if name in known else _EFFECTS.get(name, name)) + comma + rest


def p_value(p: float) -> str:
    """Write a p value as papers do: three digits, or that it is smaller."""
    if p != p:
        return "-"
    return f"<{SMALL}" if p < SMALL else f"{p:.3f}"


def axis_label(column: str, table: str = "footprint", *, per: str = "") -> str:
    """Return a label with the unit of a column.

    Parameters
    ----------
    per
        What a count is divided by, for example "hour".
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

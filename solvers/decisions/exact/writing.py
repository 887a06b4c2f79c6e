"""MPS and LP files; numbers are written with enough digits to be read back as the same doubles.

A constant in the objective is written as the cost of a column `one` that is fixed at 1, because
solvers differ in how they read constants. A row with two different finite bounds is written
as two rows.
"""

from __future__ import annotations

import json
from typing import TYPE_CHECKING

import numpy as np

from rmfs.files import write_text

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from numpy.typing import NDArray

    from rmfs.solvers.decisions.exact.formulation import Exact
    from rmfs.solvers.decisions.files import Decision

MAP = "rmfs-decision-map/1"
CONSTANT = "one"
FORMATS = ("mps", "lp")


def write_program(stated: Exact, path: Path) -> None:
    """Write a mathematical program as MPS or LP, depending on the suffix of the file.

    Parameters
    ----------
    stated
        The program, as returned by `exact`.
    path
        `NAME.mps` or `NAME.lp`.
    """
    lines = _mps(stated, path.stem) if path.suffix == ".mps" else _lp(stated)
    write_text(path, "\n".join(lines) + "\n")


def write_map(decision: Decision, stated: Exact, path: Path) -> None:
    """Write a file (`rmfs-decision-map/1`) with the decision that each column represents.

    Parameters
    ----------
    decision
        The question that was formulated.
    stated
        The exact program of the question.
    path
        The file.
    """
    means = zip(stated.names.name, stated.names.means, strict=True)
    told = {
        "format": MAP,
        "family": decision.family,
        "question": decision.hash,
        "value_is_objective_times": stated.factor,
        "columns": {name: meaning or None for name, meaning in means},
    }
    write_text(path, json.dumps(told, indent=1) + "\n")


def _sides(stated: Exact) -> Iterator[tuple[str, str, float, int]]:
    """Yield rows with one side each: name, E, L or G, right-hand side, and number in the matrix."""
    program = stated.program
    sides = zip(program.row_lower.tolist(), program.row_upper.tolist(), strict=True)
    for row, (low, high) in enumerate(sides):
        if low == high:
            yield f"r{row}", "E", low, row
            continue
        if low > -np.inf:
            yield f"r{row}", "G", low, row
        if high < np.inf:
            yield f"r{row}u" if low > -np.inf else f"r{row}", "L", high, row


def _number(value: float) -> str:
    """Return the shortest text that reads back as the same double; integers without a point."""
    return str(int(value)) if value == int(value) and abs(value) < 1e15 else repr(float(value))


def _by_column(stated: Exact) -> Iterator[list[tuple[int, float]]]:
    """Yield the entries of each column: row and coefficient."""
    matrix = stated.program.matrix.tocsc()
    for column in range(stated.program.columns):
        part = slice(int(matrix.indptr[column]), int(matrix.indptr[column + 1]))
        yield list(zip(matrix.indices[part].tolist(), matrix.data[part].tolist(), strict=True))


def _mps(stated: Exact, name: str) -> Iterator[str]:
    program, names = stated.program, stated.names.name
    rows: dict[int, list[str]] = {}
    yield f"NAME {name}"
    yield "ROWS"
    yield " N cost"
    for row, sense, _, number in _sides(stated):
        rows.setdefault(number, []).append(row)
        yield f" {sense} {row}"
    yield "COLUMNS"
    whole = program.integer.tolist()
    marks = 0
    for column, entries in enumerate(_by_column(stated)):
        if whole[column] and (column == 0 or not whole[column - 1]):
            yield f" MARKER{marks} 'MARKER' 'INTORG'"
            marks += 1
        yield f" {names[column]} cost {_number(program.cost[column])}"
        for number, value in entries:
            for row in rows.get(number, ()):
                yield f" {names[column]} {row} {_number(value)}"
        if whole[column] and (column + 1 == len(whole) or not whole[column + 1]):
            yield f" MARKER{marks} 'MARKER' 'INTEND'"
            marks += 1
    yield f" {CONSTANT} cost {_number(program.offset)}"
    yield "RHS"
    for row, _, right, _ in _sides(stated):
        if right:
            yield f" RHS {row} {_number(right)}"
    yield "BOUNDS"
    for column, (low, high) in enumerate(zip(program.lower, program.upper, strict=True)):
        if low == high:
            yield f" FX BND {names[column]} {_number(low)}"
        else:
            yield f" LO BND {names[column]} {_number(low)}"
            yield f" UP BND {names[column]} {_number(high)}"
    yield f" FX BND {CONSTANT} 1"
    yield from _quadratic(stated)
    yield "ENDATA"


def _quadratic(stated: Exact) -> Iterator[str]:
    """Yield the matrix Q of the cost x'Qx / 2: twice the costs of squares, on the diagonal."""
    if stated.square.any():
        yield "QUADOBJ"
        for column in np.flatnonzero(stated.square).tolist():
            name = stated.names.name[column]
            yield f" {name} {name} {_number(2.0 * stated.square[column])}"


def _lp(stated: Exact) -> Iterator[str]:
    program, names = stated.program, stated.names.name
    yield "Minimize"
    yield " cost:"
    for name, cost in zip(names, program.cost.tolist(), strict=True):
        if cost:
            yield f"  {_signed(cost)} {name}"
    yield f"  {_signed(program.offset)} {CONSTANT}"
    if stated.square.any():
        yield "  + ["
        for column in np.flatnonzero(stated.square).tolist():
            yield f"  {_signed(2.0 * stated.square[column])} {names[column]} ^ 2"
        yield "  ] / 2"
    yield "Subject To"
    signs = {"E": "=", "L": "<=", "G": ">="}
    for row, sense, right, number in _sides(stated):
        part = slice(int(program.row_start[number]), int(program.row_start[number + 1]))
        yield f" {row}:"
        if part.start == part.stop:
            # an empty row can make the program infeasible
            yield f"  + 0 {CONSTANT}"
        yield from _terms(program.coefficient[part], program.column[part], names)
        yield f"  {signs[sense]} {_number(right)}"
    yield "Bounds"
    for name, low, high in zip(names, program.lower, program.upper, strict=True):
        yield f" {_number(low)} <= {name} <= {_number(high)}"
    yield f" {CONSTANT} = 1"
    whole = [name for name, one in zip(names, program.integer, strict=True) if one]
    if whole:
        yield "Generals"
        yield from (f" {name}" for name in whole)
    yield "End"


def _terms(
    values: NDArray[np.float64], columns: NDArray[np.int64], names: list[str]
) -> Iterator[str]:
    for value, column in zip(values.tolist(), columns.tolist(), strict=True):
        yield f"  {_signed(value)} {names[column]}"


def _signed(value: float) -> str:
    return f"- {_number(-value)}" if value < 0 else f"+ {_number(value)}"

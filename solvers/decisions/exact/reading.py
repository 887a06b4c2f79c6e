"""Conversion of solvers' solution files to answers."""

from __future__ import annotations

import math
import re
from typing import TYPE_CHECKING

import numpy as np

from rmfs.errors import InputError
from rmfs.files import read_bounded
from rmfs.solvers.decisions.checking import WrongError, check
from rmfs.solvers.decisions.files import Found

if TYPE_CHECKING:
    from pathlib import Path

    from numpy.typing import NDArray

    from rmfs.solvers.decisions.exact.formulation import Exact
    from rmfs.solvers.decisions.files import Decision

_XML = re.compile(r'<variable\s[^>]*?name="([^"]+)"[^>]*?value="([^"]+)"')
_STATUS = frozenset(("*", "B", "NL", "NU", "NF", "NS"))
"""Words between name and value in files of GLPK."""
_NAME_ALONE = re.compile(r"^(\s*\d+ \S+)\n", re.MULTILINE)
"""Long names have a line of their own in files of GLPK."""


def read_columns(stated: Exact, path: Path) -> NDArray[np.float64]:
    """Read the value of each column from a solution file.

    The file consists of lines that contain a name followed by a value (HiGHS, SCIP, Gurobi, CBC),
    or is an XML file of CPLEX. A column that the file does not name gets the value nearest to 0
    within its bounds.

    Parameters
    ----------
    stated
        The program that was solved.
    path
        The solution file.

    Raises
    ------
    InputError
        If the file cannot be read, or names none of the columns.
    """
    text = read_bounded(path, 256).decode("utf-8", "replace")
    number = {name: column for column, name in enumerate(stated.names.name)}
    program = stated.program
    x = np.clip(np.zeros(program.columns), program.lower, program.upper)
    named = False
    for name, value in _pairs(text):
        # what comes again under its name is a dual value or a basis
        column = number.pop(name, None)
        if column is not None and math.isfinite(value):
            x[column] = value
            named = True
    if not named and program.columns:
        raise InputError(f"{path}: names no column of the program")
    x[program.integer] = np.rint(x[program.integer])
    return x


def answer_of(decision: Decision, stated: Exact, path: Path, by: dict[str, object]) -> Found:
    """Convert a solver's solution file to an answer, and check that the answer is feasible.

    Parameters
    ----------
    decision
        The recorded decision that is to be answered.
    stated
        The mathematical program of this decision.
    path
        The solution file.
    by
        How the solution was found, for the answer's `by`.

    Raises
    ------
    InputError
        If the file contains no solution, or an infeasible solution.
    """
    values = stated.answer(read_columns(stated, path))
    try:
        return Found(values, check(decision, Found(values)), by=by)
    except WrongError as error:
        raise InputError(f"{path}: {error}") from None


def _pairs(text: str) -> list[tuple[str, float]]:
    if "<variable" in text:
        return [(name, _number(value)) for name, value in _XML.findall(text)]
    found = []
    for line in _NAME_ALONE.sub(r"\1 ", text).splitlines():
        words = line.split()
        if len(words) > 3 and words[2] in _STATUS:
            del words[2]
        # a name is the first word, or the second behind a number
        for place in range(min(2, len(words) - 1)):
            value = _number(words[place + 1])
            if not math.isnan(value):
                found.append((words[place], value))
                break
    return found


def _number(word: str) -> float:
    try:
        return float(word)
    except ValueError:
        return math.nan

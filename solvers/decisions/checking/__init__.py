"""Verification of answers without the models, from the fields of question and answer alone.

One module per family implements the rules of the problem a second time, with loops instead of
arrays, and recomputes the value of the answer. Nothing here imports `rmfs.solvers.models` or
`rmfs.solvers.control`.
"""

from __future__ import annotations

from importlib import import_module
from math import isfinite, isnan
from typing import TYPE_CHECKING

from rmfs.solvers.decisions.checking.wrong import WrongError as WrongError

if TYPE_CHECKING:
    from rmfs.solvers.decisions.files import Decision, Found

TOLERANCE = 1e-6
"""Tolerance of stated objectives and bounds, relative to the value."""


def check(decision: Decision, found: Found) -> float:
    """Verify an answer and recompute its value.

    Parameters
    ----------
    decision
        The question that was answered.
    found
        The answer to be verified.

    Returns
    -------
    The recomputed value of the answer.

    Raises
    ------
    WrongError
        If the answer has no values, violates a constraint, or states a wrong objective or a bound
        that contradicts its value.
    """
    if found.values is None:
        raise WrongError("values: missing: the solution contains no answer")
    module = import_module(f"rmfs.solvers.decisions.checking.{decision.family}")
    value: float = module.value(decision.data, found.values)
    if not isfinite(value):
        raise WrongError("values: use something that is not allowed: the value is infinite")
    slack = TOLERANCE * max(1.0, abs(value))
    if not isnan(found.objective) and abs(found.objective - value) > slack:
        raise WrongError(f"objective: is {found.objective!r}, but the values give {value!r}")
    if not isnan(found.bound) and (found.bound - value) * decision.sign > slack:
        raise WrongError(f"bound: {found.bound!r} contradicts the value {value!r}")
    return value

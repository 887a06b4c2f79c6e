"""Converts solutions of models to answers for the simulation."""

from __future__ import annotations

from math import nan
from typing import TYPE_CHECKING, Any

from rmfs.control.asks import Answer

if TYPE_CHECKING:
    from collections.abc import Mapping

    from rmfs.control.asks import Plain
    from rmfs.solvers.models.solution import Solution


def answer(
    solution: Solution[Any], values: Mapping[str, Plain] | None, scale: float = nan
) -> Answer:
    """Convert a solution to an `Answer`.

    Parameters
    ----------
    solution
        Solution returned by the model.
    values
        Values of the solution as plain arrays and numbers; None if no solution was found.
    scale
        Number by which the absolute gap is divided to give the relative gap. Default (nan): the
        absolute value of the objective.
    """
    return Answer(
        solution=values if solution.found else None,
        objective=solution.objective,
        bound=solution.bound,
        status=solution.status.value,
        backend=solution.backend,
        work=solution.work,
        wall_s=solution.wall_s,
        build_s=solution.build_s,
        built=solution.built,
        scale=scale,
        found=solution.values,
    )

"""Exact mathematical programs of questions: their optimal solutions are the best answers.

The columns of a program have names, and its solutions can be converted to answers.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from rmfs.errors import InputError
from rmfs.solvers.decisions.models import model_data, plain_values
from rmfs.solvers.models.names import Names

if TYPE_CHECKING:
    from collections.abc import Mapping

    from numpy.typing import NDArray

    from rmfs.solvers.decisions.files import Decision
    from rmfs.solvers.decisions.schema import Plain
    from rmfs.solvers.models.backends.backend import Formulation
    from rmfs.solvers.models.program import LinearProgram


@dataclass(frozen=True)
class Exact:
    """A program whose optimal solutions are those of the question that it formulates.

    Attributes
    ----------
    program
        The program, to be minimised.
    names
        Names of the program's columns.
    answer
        Function that converts column values to the fields of an answer.
    factor
        Factor by which the program's objective is multiplied to give the question's value.
    square
        Cost coefficient of the square of each column, shape (n,); empty if the cost is linear.
    """

    program: LinearProgram
    names: Names
    answer: Callable[[NDArray[np.float64]], Plain]
    factor: float = 1.0
    square: NDArray[np.float64] = field(default_factory=lambda: np.zeros(0))


def exact(decision: Decision, where: str = "") -> Exact:
    """Formulate the exact program of a question.

    Parameters
    ----------
    decision
        The question to be formulated.
    where
        Name of the question in error messages, such as the path of its file. Default:
        `decision.name`.

    Raises
    ------
    InputError
        If the model rejects the data, or if a question of the family `sequencing` needs a SKU that
        no pod holds.
    """
    made: Exact = _STATED[decision.family](model_data(decision, where), where or decision.name)
    return made


def _of(family: str, stated: Formulation[Any]) -> Exact:
    """Convert a program of the models to an `Exact`."""
    names = Names(stated.program.columns)
    stated.names(names)
    return Exact(stated.program, names, lambda x: plain_values(family, stated.decode(x)))


def _pile_on(data: Any, where: str) -> Exact:
    from rmfs.solvers.models.pile_on import everything
    from rmfs.solvers.models.pile_on.program import formulate

    return _of("pile_on", formulate(data, everything(data)))


def _planning(data: Any, where: str) -> Exact:
    from rmfs.solvers.models.planning.program import Programme

    made = Programme(data)
    names = Names(made.linear.columns)
    made.name(names)
    return Exact(made.linear, names, lambda x: plain_values("planning", made.plan(x)))


def _sequencing(data: Any, where: str) -> Exact:
    from rmfs.solvers.models.sequencing import beam, objective
    from rmfs.solvers.models.sequencing.bounds import visits_bound
    from rmfs.solvers.models.sequencing.local_search import merged
    from rmfs.solvers.models.sequencing.program import formulate

    if not data.feasible:
        raise InputError(f"{where}: has no solution: no pod holds a SKU that is needed")
    plan = merged(beam.solve(data).required)
    least = int(min(visits_bound(data), objective(data, plan)))
    return _of("sequencing", formulate(data, plan.pods.size, least))


def _rack_allocation(data: Any, where: str) -> Exact:
    from rmfs.solvers.models.rack_allocation.program import formulate

    return _of("rack_allocation", formulate(data))


def _stays(data: Any, where: str) -> Exact:
    from rmfs.solvers.models.storage.stays.program import formulate

    return _of("stays", formulate(data, whole=False))


def _charging(data: Any, where: str) -> Exact:
    from rmfs.solvers.models.charging.program import formulate

    return _of("charging", formulate(data))


def _replenishment(data: Any, where: str) -> Exact:
    from rmfs.solvers.models.replenishment.program import formulate

    return _of("replenishment", formulate(data, whole=False))


def _placement(data: Any, where: str) -> Exact:
    from rmfs.solvers.decisions.exact import pairs

    return Exact(*pairs.placement(data))


def _matching(data: Any, where: str) -> Exact:
    from rmfs.solvers.decisions.exact import pairs

    return Exact(*pairs.matching(data))


def _balance(data: Any, where: str) -> Exact:
    from rmfs.solvers.decisions.exact import pairs

    return Exact(*pairs.balance(data))


def _zones(data: Any, where: str) -> Exact:
    from rmfs.solvers.decisions.exact import pairs

    program, names, answer, square = pairs.zones(data)
    return Exact(program, names, answer, square=square)


def _sequence(data: Any, where: str) -> Exact:
    from rmfs.solvers.decisions.exact import routes

    return Exact(*routes.routes(data))


def _run_bound(data: Any, where: str) -> Exact:
    from rmfs.solvers.models.run_bound.program import program

    linear, columns = program(data)
    blocks = {
        "units": columns.units,
        "visits": columns.visits,
        "lone_units": columns.lone_units,
        "bundles": columns.bundles,
        "refill_visits": columns.refill_visits,
    }
    names = Names(linear.columns)
    for name, at in blocks.items():
        names.block(name, at, name + "[{i}]", i=np.arange(len(at)))
    names.block("pods", columns.pods, i=np.arange(len(columns.pods)))
    return Exact(
        linear, names, lambda x: {name: x[at] for name, at in blocks.items()}, -1.0 / data.hours
    )


_STATED: Mapping[str, Callable[[Any, str], Exact]] = {
    "pile_on": _pile_on,
    "planning": _planning,
    "sequencing": _sequencing,
    "rack_allocation": _rack_allocation,
    "placement": _placement,
    "stays": _stays,
    "zones": _zones,
    "charging": _charging,
    "matching": _matching,
    "balance": _balance,
    "sequence": _sequence,
    "replenishment": _replenishment,
    "run_bound": _run_bound,
}

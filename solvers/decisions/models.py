"""Conversion of the fields of questions and answers to the dataclasses of models, and back."""

from __future__ import annotations

from dataclasses import fields, is_dataclass
from enum import Enum
from typing import TYPE_CHECKING, Any

import numpy as np

from rmfs.errors import InputError
from rmfs.solvers.decisions.schema import SCHEMAS
from rmfs.solvers.models.checks import ModelError
from rmfs.solvers.models.families import family as model

if TYPE_CHECKING:
    from rmfs.solvers.decisions.files import Decision
    from rmfs.solvers.decisions.schema import Field, Plain

DATA = {
    "pile_on": "PileOn",
    "planning": "Planning",
    "sequencing": "Sequencing",
    "rack_allocation": "RackAllocation",
    "placement": "Placement",
    "stays": "Stays",
    "zones": "Zones",
    "charging": "Charging",
    "matching": "Matching",
    "balance": "Balance",
    "sequence": "TaskSequence",
    "replenishment": "Replenishment",
    "run_bound": "RunBound",
}
"""Dataclass of the data of each family."""

_VALUES = {
    "pile_on": "Assignment",
    "planning": "Plan",
    "sequencing": "VisitSequence",
    "rack_allocation": "Allocation",
    "zones": "ZonePlan",
    "charging": "ChargePlan",
    "sequence": "Routes",
    "replenishment": "Stocking",
    "run_bound": "Throughput",
}
"""Dataclass of the values, for families whose values are not a single array."""

_PARTS = {
    "weights": "Weights",
    "picking": "PickStations",
    "refill": "Refill",
    "stock": "Stock",
    "orders": "Orders",
}


def family_of(data: object) -> str | None:
    """Return the name of the family to which a model's data belong; None if they belong to none."""
    for name, kind in DATA.items():
        if type(data).__name__ == kind and isinstance(data, getattr(model(name), kind)):
            return name
    return None


def plain_data(family: str, data: object) -> Plain:
    """Return the fields of a question from a model's data."""
    return {field.name: _taken(data, field) for field in SCHEMAS[family].data}


def plain_values(family: str, values: object) -> Plain:
    """Return the fields of an answer from a model's values."""
    named = SCHEMAS[family].values
    if family not in _VALUES:
        return {named[0].name: np.asarray(values)}
    return {field.name: _taken(values, field) for field in named}


def model_data(decision: Decision, where: str = "") -> Any:
    """Build the model's data from the fields of a question.

    Raises
    ------
    InputError
        If the model rejects the data.
    """
    module = model(decision.family)
    nested: dict[str, Any] = {}
    for name, value in decision.data.items():
        part, _, rest = name.rpartition(".")
        (nested.setdefault(part, {}) if part else nested)[rest] = value
    try:
        for part, kind in _PARTS.items():
            if isinstance(nested.get(part), dict):
                nested[part] = getattr(module, kind)(**_flags(nested[part]))
        if "variant" in nested:
            nested["variant"] = module.Variant(nested["variant"])  # type: ignore[attr-defined]
        return getattr(module, DATA[decision.family])(**nested)
    except ModelError as error:
        raise InputError(f"{where or decision.name}: data.{error}") from None


def model_values(decision: Decision, values: Plain) -> Any:
    """Build the model's values from the fields of an answer to a question."""
    if decision.family not in _VALUES:
        return np.asarray(next(iter(values.values())))
    kind = getattr(
        __import__(f"{model(decision.family).__name__}", fromlist=["_"]), _VALUES[decision.family]
    )
    given = dict(values)
    for field in decision.schema.values:
        if field.kind == "lists":
            given[field.name] = tuple(tuple(row) for row in values[field.name])
        if field.kind == "flag":
            given[field.name] = np.asarray(values[field.name]).astype(np.bool_)
    return kind(**given)


def _flags(part: dict[str, Any]) -> dict[str, Any]:
    """Convert flags, which are 0 or 1 in a question, to truth values."""
    truth = ("prospects", "join_visits")
    return {name: bool(value) if name in truth else value for name, value in part.items()}


def _taken(owner: Any, field: Field) -> Any:
    value = owner
    for name in field.name.split("."):
        value = getattr(value, name)
    if isinstance(value, Enum):
        return value.value
    if isinstance(value, np.ndarray):
        return value
    if field.kind == "flag" and not field.shape:
        return int(value)
    if field.kind == "lists":
        return [[int(one) for one in row] for row in value]
    return value


def plain_of(value: Any) -> Any:
    """Convert a setting passed along with a question, such as limits, to what JSON can store."""
    if is_dataclass(value) and not isinstance(value, type):
        return {one.name: plain_of(getattr(value, one.name)) for one in fields(value)}
    if isinstance(value, np.ndarray):
        return value.tolist()
    if isinstance(value, tuple | list):
        return [plain_of(one) for one in value]
    return value

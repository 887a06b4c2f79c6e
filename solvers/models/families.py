"""The families of models by name; each is imported when it is first used."""

from __future__ import annotations

from importlib import import_module
from typing import Any, Protocol, cast

from rmfs.solvers.models.checks import require
from rmfs.solvers.models.methods import Methods

FAMILIES = {
    "pile_on": "pile_on",
    "sequencing": "sequencing",
    "rack_allocation": "rack_allocation",
    "placement": "storage.placement",
    "stays": "storage.stays",
    "zones": "storage.zones",
    "matching": "tasks.matching",
    "balance": "tasks.balance",
    "sequence": "tasks.sequence",
    "replenishment": "replenishment",
    "planning": "planning",
    "charging": "charging",
    "run_bound": "run_bound",
}
"""Module path of each family, relative to `rmfs.solvers.models`."""


class Family(Protocol):
    """The interface that every family of models provides."""

    __name__: str
    solve: Methods[Any, Any]

    def methods(self) -> tuple[str, ...]:
        """Return the names of the methods."""

    def objective(self, data: Any, values: Any, /) -> float:
        """Return the objective of the decision `values` for the problem `data`."""

    def violations(self, data: Any, values: Any, /) -> list[str]:
        """Return descriptions of the constraints of `data` that a decision violates."""


def family(name: str) -> Family:
    """Import a family of models, and return its package.

    Parameters
    ----------
    name
        Name of the family, a key of `FAMILIES`.

    Raises
    ------
    ModelError
        If there is no family of this name.
    """
    require(name in FAMILIES, "family", f"must be one of {', '.join(FAMILIES)}")
    return cast("Family", import_module(f"rmfs.solvers.models.{FAMILIES[name]}"))

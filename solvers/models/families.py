"""The families of models by name, loaded when they are asked for."""

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
"""Where each family is, below `rmfs.solvers.models`."""


class Family(Protocol):
    """What every family has."""

    __name__: str
    solve: Methods[Any, Any]

    def methods(self) -> tuple[str, ...]:
        """Return the names of the methods."""

    def objective(self, data: Any, values: Any, /) -> float:
        """Return what values are worth."""

    def violations(self, data: Any, values: Any, /) -> list[str]:
        """Say in words what is wrong with values."""


def family(name: str) -> Family:
    """Load a family.

    Parameters
    ----------
    name
        Its name in `FAMILIES`.

    Raises
    ------
    ModelError
        If there is none of this name.
    """
    require(name in FAMILIES, "family", f"must be one of {', '.join(FAMILIES)}")
    return cast("Family", import_module(f"rmfs.solvers.models.{FAMILIES[name]}"))

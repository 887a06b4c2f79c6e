"""Common interface of all families: `solve(data, method)` selects a method by name."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Generic, Protocol, TypeVar

from rmfs.solvers.models.checks import require
from rmfs.solvers.models.solution import NO_LIMITS, Limits, Solution

D = TypeVar("D")
D_contra = TypeVar("D_contra", contravariant=True)
V = TypeVar("V")


class Method(Protocol[D_contra, V]):
    """The signature of `solve` in the module of each solution method."""

    def __call__(
        self, data: D_contra, limits: Limits = ..., *, seed: int = ..., start: V | None = ...
    ) -> Solution[V]:
        """Solve a problem; see `Methods`."""


class Methods(Generic[D, V]):
    """The methods of a family by name. Calling this object solves a problem by one of them.

    Parameters
    ----------
    methods
        The methods by name; each is named after its module.
    default
        Name of the method used by default.
    rule
        Name of the fast heuristic whose solution can be the `start` of the other methods; empty if
        there is none.

    Attributes
    ----------
    by_name
        The methods by name.
    """

    def __init__(
        self, methods: Mapping[str, Method[D, V]], *, default: str, rule: str = ""
    ) -> None:
        self.by_name = dict(methods)
        self.default = default
        self.rule = rule

    def names(self) -> tuple[str, ...]:
        """Return the names of the methods."""
        return tuple(self.by_name)

    def __call__(
        self,
        data: D,
        method: str = "",
        limits: Limits = NO_LIMITS,
        *,
        seed: int = 0,
        start: V | None = None,
        **options: Any,
    ) -> Solution[V]:
        """Solve a problem.

        Parameters
        ----------
        data
            The problem.
        method
            Name of the method. Default: the family's default.
        limits
            Limits in counted work; each method documents those that apply. Default: none, so that
            exact methods run to optimality.
        seed
            Seed of random choices, if the method makes any. Default 0.
        start
            Feasible values to start from. Methods that use them return nothing worse; the others
            ignore them. Default: none.
        options
            Further options of the method.

        Returns
        -------
        The solution, with a bound and the work it took.

        Raises
        ------
        ModelError
            If there is no such method, or the start is not feasible.
        WallGuardError
            If the wall-clock guard ran out.
        """
        named = method or self.default
        require(named in self.by_name, "method", f"must be one of {', '.join(self.by_name)}")
        return self.by_name[named](data, limits, seed=seed, start=start, **options)

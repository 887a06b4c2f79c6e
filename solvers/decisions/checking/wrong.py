"""Errors found in an answer."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterable


class WrongError(ValueError):
    """An answer is wrong; the message says what is wrong, and where."""


def require(condition: object, problem: str) -> None:
    """Raise a `WrongError` unless a condition holds."""
    if not condition:
        raise WrongError(problem)


def within(name: str, values: Iterable[int], low: int, end: int) -> None:
    """Require that every number lies within [low, end)."""
    for place, value in enumerate(values):
        require(low <= value < end, f"{name}[{place}]: must be from {low} to {end - 1}, is {value}")


def once(name: str, values: Iterable[int]) -> None:
    """Require that no number occurs twice."""
    seen: set[int] = set()
    for value in values:
        require(value not in seen, f"{name}: {value} occurs twice")
        seen.add(value)

"""Typed access to the attributes of RAWSim-O's XML elements; errors are collected."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from rmfs.layout.problems import stop_if_any

if TYPE_CHECKING:
    from xml.etree.ElementTree import Element

NOBODY = -1
"""RAWSim-O's id for "none"."""


class Problems:
    """Collects the errors in a file and raises them as one exception."""

    def __init__(self) -> None:
        self.found: list[str] = []

    def add(self, problem: str) -> None:
        """Add an error."""
        self.found.append(problem)

    def stop(self, source: object) -> None:
        """Raise an exception if errors were added.

        Raises
        ------
        InputError
            If errors were added. The message is a single line with the first errors and the number
            of further errors.
        """
        stop_if_any(self.found, source)


class Fields:
    """The attributes of one element.

    Parameters
    ----------
    element
        The element. Error messages contain its tag and its attribute `ID`.
    problems
        Collection of errors. For each missing or invalid value, an error is added and 0 or false is
        returned instead.
    """

    def __init__(self, element: Element, problems: Problems) -> None:
        self._element = element
        self._problems = problems

    @property
    def label(self) -> str:
        """The name of the element in error messages."""
        return f"{self._element.tag} {self._element.get('ID', '(without ID)')}"

    def number(self, name: str, default: float | None = None) -> float:
        """Return the finite number in an attribute, or `default` if the attribute is missing.

        A missing attribute is an error if `default` is None.
        """
        text = self._element.get(name)
        if text is None and default is not None:
            return default
        try:
            value = float(text or "")
        except ValueError:
            value = math.nan
        if not math.isfinite(value):
            self._wrong(name, "a number", text)
            return 0.0
        return value

    def whole(self, name: str, default: int | None = None) -> int:
        """Return the integer in an attribute, or `default` if the attribute is missing.

        A missing attribute is an error if `default` is None.
        """
        text = self._element.get(name)
        if text is None and default is not None:
            return default
        try:
            return int(text or "")
        except ValueError:
            self._wrong(name, "a whole number", text)
            return 0

    def switch(self, name: str) -> bool:
        """Return the truth value in an attribute; false if the attribute is missing."""
        text = self._element.get(name, "false")
        if text not in ("true", "false", "1", "0"):
            self._wrong(name, "true or false", text)
        return text in ("true", "1")

    def _wrong(self, name: str, expected: str, text: str | None) -> None:
        given = "is missing" if text is None else f"expected {expected} (given: {text!r})"
        self._problems.add(f"{self.label}: {name} {given}")


def slashed(text: str | None, parts: int) -> list[str] | None:
    """Return the parts of a text such as "a/b/c"; None if there are not exactly `parts` parts."""
    found = (text or "").strip().split("/")
    return found if len(found) == parts else None

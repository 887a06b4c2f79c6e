"""Conversion of the elements of a controller configuration: one class per kind of value.

For an absent element, RAWSim-O's default is written explicitly, as that of rmfs may differ.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, NamedTuple

if TYPE_CHECKING:
    from collections.abc import Mapping

    from rmfs.config import Table
    from rmfs.rawsimo.scenario.settings import Settings


class Number(NamedTuple):
    """A real number, converted to the parameter `key`."""

    key: str
    default: float

    def read(self, block: Settings, tag: str) -> Any:
        """Return the value of the element."""
        return block.number(tag, self.default)


class Whole(NamedTuple):
    """An integer."""

    key: str
    default: int

    def read(self, block: Settings, tag: str) -> Any:
        """Return the value of the element."""
        return block.whole(tag, self.default)


class Switch(NamedTuple):
    """A truth value."""

    key: str
    default: bool

    def read(self, block: Settings, tag: str) -> Any:
        """Return the value of the element."""
        return block.switch(tag, self.default)


class Word(NamedTuple):
    """One of several words, each with its value in rmfs."""

    key: str
    choices: Mapping[str, str] | Mapping[str, bool]
    default: str

    def read(self, block: Settings, tag: str) -> Any:
        """Return the value of the element's word."""
        return block.choice(tag, self.choices, self.default)


class Complement(NamedTuple):
    """A probability whose complement is the parameter of rmfs."""

    key: str
    default: float

    def read(self, block: Settings, tag: str) -> Any:
        """Return 1 minus the element's value, rounded to fifteen digits."""
        return round(1.0 - block.number(tag, self.default), 15)


class Numbers(NamedTuple):
    """Several numbers, in one text with commas or in one element each."""

    key: str
    default: tuple[float, ...]

    def read(self, block: Settings, tag: str) -> Any:
        """Return the values of the element."""
        return block.numbers(tag, self.default)


Element = Number | Whole | Switch | Word | Complement | Numbers

METRICS = {
    "Euclidean": "euclidean",
    "Euclid": "euclidean",
    "Manhattan": "manhattan",
    "ShortestPath": "path",
    "ShortestTime": "time",
}


@dataclass(frozen=True)
class Rule:
    """Conversion of a rule of RAWSim-O.

    Attributes
    ----------
    name
        Name of the rule in rmfs.
    elements
        Conversion of each element.
    left
        Elements that are not used, with the reason for each.
    """

    name: str
    elements: Mapping[str, Element] = field(default_factory=dict)
    left: Mapping[str, str] = field(default_factory=dict)


def translated(block: Settings, rule: Rule) -> Table:
    """Return the table of a rule in a controllers file; note what is left out.

    Raises
    ------
    InputError
        If a value is wrong.
    """
    for reason in dict.fromkeys(rule.left.values()):
        block.leave([tag for tag, told in rule.left.items() if told == reason], reason)
    return {"name": rule.name, **values_of(block, rule.elements)}


def values_of(block: Settings, elements: Mapping[str, Element]) -> Table:
    """Return the parameters given by the elements."""
    return {element.key: element.read(block, tag) for tag, element in elements.items()}

"""Conversion of the XML elements of RAWSim-O's controller configurations (.xconf).

There is one class per kind of value. An object of such a class converts an element to the parameter
`key` of rmfs. If the element is absent, the parameter is set to RAWSim-O's default, because the
default of rmfs may differ.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, NamedTuple

if TYPE_CHECKING:
    from collections.abc import Mapping

    from rmfs.config import Table
    from rmfs.rawsimo.scenario.settings import Settings


class Number(NamedTuple):
    """An element that contains a real number."""

    key: str
    default: float

    def read(self, block: Settings, tag: str) -> Any:
        """Return the value of the element."""
        return block.number(tag, self.default)


class Whole(NamedTuple):
    """An element that contains an integer."""

    key: str
    default: int

    def read(self, block: Settings, tag: str) -> Any:
        """Return the value of the element."""
        return block.whole(tag, self.default)


class Switch(NamedTuple):
    """An element that contains a truth value."""

    key: str
    default: bool

    def read(self, block: Settings, tag: str) -> Any:
        """Return the value of the element."""
        return block.switch(tag, self.default)


class Word(NamedTuple):
    """An element that contains one of the words `choices`, each mapped to a value in rmfs."""

    key: str
    choices: Mapping[str, str] | Mapping[str, bool]
    default: str

    def read(self, block: Settings, tag: str) -> Any:
        """Return the value in rmfs to which the word in the element is mapped."""
        return block.choice(tag, self.choices, self.default)


class Complement(NamedTuple):
    """An element that contains a probability; the parameter of rmfs is 1 minus this probability."""

    key: str
    default: float

    def read(self, block: Settings, tag: str) -> Any:
        """Return 1 minus the value of the element, rounded to fifteen decimal places."""
        return round(1.0 - block.number(tag, self.default), 15)


class Numbers(NamedTuple):
    """An element with numbers: either separated by commas, or one in each child element."""

    key: str
    default: tuple[float, ...]

    def read(self, block: Settings, tag: str) -> Any:
        """Return the numbers in the element."""
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
    """Conversion of a method or criterion of RAWSim-O to its counterpart in rmfs.

    Attributes
    ----------
    name
        Name of the rule or criterion in rmfs.
    elements
        Conversions of the elements that are used, by their tags.
    left
        For each known element that is not used, the reason; the keys are the tags of the elements.
    """

    name: str
    elements: Mapping[str, Element] = field(default_factory=dict)
    left: Mapping[str, str] = field(default_factory=dict)


def translated(block: Settings, rule: Rule) -> Table:
    """Return the table of a rule for a controllers file; add notes on unused elements.

    Raises
    ------
    InputError
        If a value is invalid.
    """
    for reason in dict.fromkeys(rule.left.values()):
        block.leave([tag for tag, told in rule.left.items() if told == reason], reason)
    return {"name": rule.name, **values_of(block, rule.elements)}


def values_of(block: Settings, elements: Mapping[str, Element]) -> Table:
    """Return the values of rmfs parameters, by name, converted from the elements of a block."""
    return {element.key: element.read(block, tag) for tag, element in elements.items()}

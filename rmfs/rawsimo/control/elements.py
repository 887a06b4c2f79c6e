"""Conversion of the XML elements of RAWSim-O's controller configurations (.xconf).

There is one class per kind of value. Each converts an element to the parameter `key` of rmfs. For
an absent element, RAWSim-O's default is written explicitly, as the default of rmfs may differ.
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
    """An element that contains one of several words, each of which stands for a value in rmfs."""

    key: str
    choices: Mapping[str, str] | Mapping[str, bool]
    default: str

    def read(self, block: Settings, tag: str) -> Any:
        """Return the value in rmfs for which the word in the element stands."""
        return block.choice(tag, self.choices, self.default)


class Complement(NamedTuple):
    """An element that contains a probability; the parameter of rmfs is 1 minus this probability."""

    key: str
    default: float

    def read(self, block: Settings, tag: str) -> Any:
        """Return 1 minus the value of the element, rounded to fifteen decimal places."""
        return round(1.0 - block.number(tag, self.default), 15)


class Numbers(NamedTuple):
    """An element that contains numbers: separated by commas, or each in a child element."""

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
        Conversions of the elements that are used, by tag.
    left
        Reasons why the other known elements are not used, by tag.
    """

    name: str
    elements: Mapping[str, Element] = field(default_factory=dict)
    left: Mapping[str, str] = field(default_factory=dict)


def translated(block: Settings, rule: Rule) -> Table:
    """Return the table of a rule for a controllers file, and note the elements in `rule.left`.

    Raises
    ------
    InputError
        If a value is wrong.
    """
    for reason in dict.fromkeys(rule.left.values()):
        block.leave([tag for tag, told in rule.left.items() if told == reason], reason)
    return {"name": rule.name, **values_of(block, rule.elements)}


def values_of(block: Settings, elements: Mapping[str, Element]) -> Table:
    """Return the parameters of rmfs, by name, as given by the elements of a block."""
    return {element.key: element.read(block, tag) for tag, element in elements.items()}

"""What an element of a controller configuration becomes: one small class per kind of value.

An element that is absent has RAWSim-O's default, which is written out: ours may differ.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, NamedTuple

if TYPE_CHECKING:
    from collections.abc import Mapping

    from rmfs.config import Table
    from rmfs.rawsimo.scenario.settings import Settings


class Number(NamedTuple):
    """A number, read into the parameter `key`."""

    key: str
    default: float

    def read(self, block: Settings, tag: str) -> Any:
        """Return the value of the element."""
        return block.number(tag, self.default)


class Whole(NamedTuple):
    """A whole number."""

    key: str
    default: int

    def read(self, block: Settings, tag: str) -> Any:
        """Return the value of the element."""
        return block.whole(tag, self.default)


class Switch(NamedTuple):
    """True or false."""

    key: str
    default: bool

    def read(self, block: Settings, tag: str) -> Any:
        """Return the value of the element."""
        return block.switch(tag, self.default)


class Word(NamedTuple):
    """One of several words, each with what it stands for here."""

    key: str
    choices: Mapping[str, str] | Mapping[str, bool]
    default: str

    def read(self, block: Settings, tag: str) -> Any:
        """Return what the element's word stands for."""
        return block.choice(tag, self.choices, self.default)


class Complement(NamedTuple):
    """A probability of which we give the other part."""

    key: str
    default: float

    def read(self, block: Settings, tag: str) -> Any:
        """Return 1 less the element's value, to fifteen digits."""
        return round(1.0 - block.number(tag, self.default), 15)


class Numbers(NamedTuple):
    """Several numbers: as a text with commas, or one to an element."""

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
    """What a rule of theirs becomes.

    Attributes
    ----------
    name
        Of our rule.
    elements
        What each element becomes.
    left
        Elements that are not used, each with the reason.
    """

    name: str
    elements: Mapping[str, Element] = field(default_factory=dict)
    left: Mapping[str, str] = field(default_factory=dict)


def translated(block: Settings, rule: Rule) -> Table:
    """Return our table for a rule of theirs; what is left out is noted.

    Raises
    ------
    InputError
        If a value is wrong.
    """
    for reason in dict.fromkeys(rule.left.values()):
        block.leave([tag for tag, told in rule.left.items() if told == reason], reason)
    return {"name": rule.name, **values_of(block, rule.elements)}


def values_of(block: Settings, elements: Mapping[str, Element]) -> Table:
    """Return the parameters that elements give."""
    return {element.key: element.read(block, tag) for tag, element in elements.items()}

"""Typed access to the elements of RAWSim-O's settings files and controller configurations.

Elements that are never read are reported in notes.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, TypeVar

from rmfs.errors import InputError
from rmfs.rawsimo.xml import SCHEMA_NAMESPACE

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping
    from pathlib import Path
    from xml.etree.ElementTree import Element

_T = TypeVar("_T")


class Settings:
    """The root or a block of a settings file or controller configuration.

    It remembers which of its elements have been read. For an absent element, a method with an
    argument `default` uses this default. A wrong value raises `InputError`.

    Parameters
    ----------
    element
        The root or block. If it is None, the block is absent, and all values are defaults.
    path
        The file, for messages.
    notes
        List to which notes are added, on elements that are not used and on differences between
        RAWSim-O and rmfs.

    Attributes
    ----------
    kind
        The type of the block (its attribute xsi:type); empty if it has none.
    """

    def __init__(self, element: Element | None, path: Path, notes: list[str]) -> None:
        self._path = path
        self._notes = notes
        self._elements: dict[str, Element] = {}
        self._read: set[str] = set()
        self.kind = _kind(element)
        for child in () if element is None else element:
            if child.tag in self._elements:
                raise self.error(child.tag, "occurs twice")
            self._elements[child.tag] = child

    def __contains__(self, tag: str) -> bool:
        return tag in self._elements

    @property
    def tags(self) -> list[str]:
        """Names of all elements in the block."""
        return list(self._elements)

    def error(self, tag: str, problem: str) -> InputError:
        """Return an exception that names an element and what is wrong with it."""
        return InputError(f"{self._path}: {tag}: {problem}")

    def note(self, text: str) -> None:
        """Add a note."""
        self._notes.append(text)

    def text(self, tag: str, default: str = "") -> str:
        """Return the text of an element."""
        self._read.add(tag)
        element = self._elements.get(tag)
        return default if element is None else (element.text or "").strip()

    def kind_of(self, tag: str) -> str:
        """Return the type of an element, or an empty text; the element still counts as unread."""
        return _kind(self._elements.get(tag))

    def choice(self, tag: str, choices: Mapping[str, _T], default: str) -> _T:
        """Return `choices[word]` for the text of an element, which must be a word in `choices`."""
        word = self.text(tag, default)
        if word not in choices:
            raise self.error(tag, f"must be one of {', '.join(choices)} (given: {word!r:.40})")
        return choices[word]

    def number(self, tag: str, default: float) -> float:
        """Return the finite number in an element."""
        return default if tag not in self else self._number(tag, self.text(tag))

    def whole(self, tag: str, default: int) -> int:
        """Return the integer in an element."""
        number = self.number(tag, default)
        if number % 1:
            raise self.error(tag, f"must be a whole number (given: {number:g})")
        return int(number)

    def switch(self, tag: str, default: bool) -> bool:
        """Return the truth value in an element."""
        return default if tag not in self else self._switch(tag, self.text(tag))

    def block(self, tag: str) -> Settings:
        """Return a block within this one; an absent block is treated as empty."""
        self._read.add(tag)
        return Settings(self._elements.get(tag), self._path, self._notes)

    def pairs(self, tag: str) -> list[tuple[float, float]]:
        """Return the pairs (key, number) listed in an element, in order of the keys."""
        return sorted(
            (self._number(tag, key), self._number(tag, value)) for key, value in self._pairs(tag)
        )

    def switches(self, tag: str) -> list[tuple[float, bool]]:
        """Return the pairs (key, truth value) listed in an element, in order of the keys."""
        return sorted(
            (self._number(tag, key), self._switch(tag, value)) for key, value in self._pairs(tag)
        )

    def words(self, tag: str, choices: Mapping[str, str]) -> list[tuple[float, str]]:
        """Return the keys and words listed in an element as pairs (key, `choices[word]`).

        The pairs are in order of the keys.
        """
        found = []
        for key, word in self._pairs(tag):
            if word not in choices:
                raise self.error(tag, f"must be one of {', '.join(choices)} (given: {word!r:.40})")
            found.append((self._number(tag, key), choices[word]))
        return sorted(found)

    def numbers(self, tag: str, default: tuple[float, ...]) -> list[float]:
        """Return the numbers in an element: one per child, or a list separated by commas."""
        self._read.add(tag)
        element = self._elements.get(tag)
        if element is None:
            return list(default)
        parts = [child.text or "" for child in element] or (element.text or "").split(",")
        return [self._number(tag, part.strip()) for part in parts]

    def weights(self, tag: str) -> dict[str, float]:
        """Return the weight of each word listed in an element, except words with weight 0."""
        numbers = {key: self._number(tag, value) for key, value in self._pairs(tag)}
        return {key: number for key, number in numbers.items() if number}

    def leave(self, tags: Iterable[str], reason: str) -> None:
        """Add a note on why the given elements, if present, are not used; count them as read."""
        present = [tag for tag in tags if tag in self]
        self._read.update(present)
        if present:
            self.note(f"{', '.join(present)} not used: {reason}")

    def leave_rest(self) -> None:
        """Add a note that lists the elements of the block that have not been read."""
        unknown = [tag for tag in self._elements if tag not in self._read]
        if unknown:
            self.note(
                f"{', '.join(unknown)} unknown, left out (RAWSim-O silently ignores unknown "
                "elements)"
            )

    def _pairs(self, tag: str) -> list[tuple[str, str]]:
        self._read.add(tag)
        return [
            ((pair.findtext("Key") or "").strip(), (pair.findtext("Value") or "").strip())
            for pair in self._elements.get(tag, ())
        ]

    def _number(self, tag: str, text: str) -> float:
        try:
            number = float(text)
        except ValueError:
            number = math.nan
        if not math.isfinite(number):
            raise self.error(tag, f"must be a finite number (given: {text!r:.40})")
        return number

    def _switch(self, tag: str, text: str) -> bool:
        if text not in ("true", "false", "1", "0"):
            raise self.error(tag, f"must be true or false (given: {text!r:.40})")
        return text in ("true", "1")


def _kind(element: Element | None) -> str:
    return "" if element is None else element.get(f"{SCHEMA_NAMESPACE}type", "")

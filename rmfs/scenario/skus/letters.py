"""Coloured letters as SKUs, as in the simulator Alphabet Soup.

Orders are words, and each letter of a word is a coloured tile that has to be picked. RAWSim-O calls
this the letter mode (item type Letter).
"""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from rmfs.errors import InputError
from rmfs.scenario import exact
from rmfs.scenario.problems import Problems
from rmfs.scenario.skus.drawing import draw_bundle_units, draw_space
from rmfs.scenario.skus.sku_set import SkuSet

if TYPE_CHECKING:
    from pathlib import Path

    from rmfs.scenario.parameters import LetterSkus

LONGEST_WORD = 64
MOST_WORDS = 1_000_000

_LONGEST_LINE = 8 * LONGEST_WORD


@dataclass(frozen=True)
class Alphabet:
    """Words and the colours of their letters; a SKU is a letter in one colour.

    SKUs are numbered by letter in alphabetical order and, for each letter, by colour in the
    sequence of `colours`.

    Attributes
    ----------
    words
        The words, each as the indices of its letters in `letters`.
    letters
        All letters of the words, in alphabetical order.
    colours
        Weight of each colour, by its name.
    """

    words: tuple[tuple[int, ...], ...]
    letters: tuple[str, ...]
    colours: dict[str, float]

    def sku(self, letter: int, colour: int) -> int:
        """Return the index of the SKU of a letter in a colour, both given by their indices."""
        return letter * len(self.colours) + colour


def letter_sku_set(config: LetterSkus) -> SkuSet:
    """Return the SKUs of a list of words.

    The popularity of a SKU is the frequency of its letter in all words, multiplied by the weight of
    its colour.

    Raises
    ------
    InputError
        If the words cannot be read.
    """
    alphabet = read_alphabet(config)
    frequency = Counter(letter for word in alphabet.words for letter in word)
    often = [frequency[letter] for letter in range(len(alphabet.letters))]
    popularity = np.outer(often, list(alphabet.colours.values())).ravel()
    count = len(popularity)
    return SkuSet(
        ids=np.arange(count, dtype=np.int64),
        popularity=exact.significant(popularity),
        space_per_unit=draw_space(config.space_per_unit, config.seed, count),
        bundle_units=draw_bundle_units(config.bundle_units, config.seed, count),
        names=tuple(
            f"{letter} {colour}" for letter in alphabet.letters for colour in alphabet.colours
        ),
    )


def read_alphabet(config: LetterSkus) -> Alphabet:
    """Read the file of words to which a scenario refers.

    Raises
    ------
    InputError
        If the words cannot be read.
    """
    words = _read_words(config.words)
    letters = tuple(sorted({letter for word in words for letter in word}))
    number = {letter: index for index, letter in enumerate(letters)}
    coded = tuple(tuple(number[letter] for letter in word) for word in words)
    return Alphabet(coded, letters, config.colours)


def _read_words(path: Path) -> tuple[str, ...]:
    """Read a text file with one word per line; case and empty lines are ignored."""
    problems = Problems(path)
    words = []
    try:
        with path.open("rb") as file:
            for number in range(1, MOST_WORDS + 2):
                raw = file.readline(_LONGEST_LINE)
                if not raw:
                    break
                if len(raw) == _LONGEST_LINE or number > MOST_WORDS:
                    problems.add(
                        f"line {number}: is too long, or beyond the maximum of {MOST_WORDS} words"
                    )
                    break
                word = raw.decode("utf-8-sig" if number == 1 else "utf-8").strip().lower()
                if len(word) > LONGEST_WORD:
                    problems.add(f"line {number}: is longer than {LONGEST_WORD} letters")
                elif word and not word.isalpha():
                    problems.add(f"line {number}: {word!r:.40} must consist of letters only")
                elif word:
                    words.append(word)
    except OSError as error:
        raise InputError(f"{path}: cannot be read ({error.strerror})") from None
    except UnicodeDecodeError:
        raise InputError(f"{path}: is not UTF-8 text") from None
    if not words:
        problems.add("no word")
    problems.stop_if_any()
    return tuple(words)

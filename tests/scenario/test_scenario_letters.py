"""Coloured words: their letters as SKUs, and orders that are words."""

from __future__ import annotations

from collections import Counter
from pathlib import Path

import numpy as np
import pytest
from scenario_tools import SIGNIFICANT, SITE, FakeState, drive, scenario
from scipy import stats

from rmfs.errors import InputError
from rmfs.scenario import Scenario, initial_stock, load, order_intake, sku_set
from rmfs.scenario.parameters import LetterSkus
from rmfs.scenario.skus.letters import read_alphabet

WORDS = "abba\nBEE\n\ncab\n"
TWO_COLOURS = {"red": 3.0, "green": 1.0}


def words_file(folder: Path, text: str | bytes = WORDS) -> Path:
    path = folder / "words.txt"
    path.write_bytes(text if isinstance(text, bytes) else text.encode())
    return path


def letters(folder: Path, **tables) -> Scenario:
    skus = {"words": str(words_file(folder)), "colours": TWO_COLOURS}
    return scenario(**({"skus": skus, "orders": {"content": "words"}} | tables))


def test_skus_are_letters_in_colours_as_popular_as_they_are_frequent(tmp_path: Path):
    skus = sku_set(letters(tmp_path).skus)
    assert skus.names == tuple(f"{letter} {colour}" for letter in "abce" for colour in TWO_COLOURS)
    frequency = np.array([3, 4, 1, 2]) / 10
    expected = np.outer(frequency, [0.75, 0.25]).ravel()
    assert skus.by_popularity.probabilities == pytest.approx(expected)
    assert (skus.bundle_units == 6).all()
    assert (skus.space_per_unit == 5.0).all()


def test_words_colours_and_units_follow_their_distributions(tmp_path: Path):
    given = letters(tmp_path, demand={"mode": "poisson", "initial_orders": 8000})
    skus = sku_set(given.skus)
    come = drive(order_intake(given, skus, SITE, 1), FakeState(8), 0)
    words: Counter[str] = Counter()
    ordered = np.zeros(8)
    for order in come:
        units: Counter[str] = Counter()
        for sku, count in zip(order.skus, order.units, strict=True):
            units[skus.names[sku][0]] += count
        words["".join(sorted(units))] += 1
        ordered[list(order.skus)] += order.units
        assert len(set(order.skus)) == len(order.skus)
    assert set(words) == {"ab", "be", "abc"}
    assert stats.chisquare(list(words.values())).pvalue > SIGNIFICANT
    # units of a letter have their own distribution; summed up they are as popular as said
    expected = skus.by_popularity.probabilities
    assert ordered / ordered.sum() == pytest.approx(expected, abs=0.01)
    per_letter = ordered.sum() / (8000 * 10 / 3)
    counts = np.arange(1, 4)
    assert per_letter == pytest.approx(
        given.orders.units_per_letter.probabilities() @ counts, rel=0.01
    )


def test_colours_of_a_letter(tmp_path: Path):
    given = scenario(
        skus={"words": str(words_file(tmp_path, "x\n")), "colours": {"r": 1, "g": 2, "b": 5}},
        orders={"content": "words"},
        demand={"mode": "poisson", "initial_orders": 4000},
    )
    come = drive(order_intake(given, sku_set(given.skus), SITE, 1), FakeState(3), 0)
    counts = np.bincount([order.skus[0] for order in come])
    assert stats.chisquare(counts, [500, 1000, 2500]).pvalue > SIGNIFICANT


def test_words_do_not_look_at_stock(tmp_path: Path):
    given = letters(tmp_path, demand={"mode": "backlog", "orders": 20, "pause_by_stock": False})
    skus = sku_set(given.skus)
    rich = drive(order_intake(given, skus, SITE, 1), FakeState(8), 0)
    poor = FakeState(8, uncommitted=np.zeros(8, np.int64))
    assert drive(order_intake(given, skus, SITE, 1), poor, 0) == rich
    assert len(rich) == 20
    assert drive(order_intake(given, skus, SITE, 2), FakeState(8), 0) != rich


def test_words_and_letters_need_each_other(tmp_path: Path):
    with pytest.raises(InputError, match=r'orders: content = "words" and skus.words must be used'):
        scenario(orders={"content": "words"})
    with pytest.raises(InputError, match=r'orders: content = "words" and skus.words must be used'):
        letters(tmp_path, orders={})


def test_the_shipped_scenario():
    given = load("letters")
    skus = sku_set(given.skus)
    assert len(skus) % 3 == 0
    assert set("".join(name[0] for name in skus.names)) <= set("abcdefghijklmnopqrstuvwxyz")
    assert initial_stock(skus, np.full(10, 500.0), given.stock.initial_share, 1).share >= 0.05
    longest = max(len(word) for word in read_alphabet(given.skus).words)
    come = drive(order_intake(given, skus, SITE, 1), FakeState(len(skus)), 0)
    assert len(come) == 100
    assert 3 < max(len(order.skus) for order in come) <= longest


BROKEN = {
    "": "no word",
    "\n \n": "no word",
    "a b\n": "line 1: 'a b' must consist of letters only",
    "ab1\nc-d\n": "line 1: 'ab1' must consist of letters only; line 2: 'c-d' must",
    "a" * 65: "line 1: is longer than 64 letters",
    "a" * 1000: "line 1: is too long",
    b"\xff\xfe\x00": "is not UTF-8 text",
    b"ab\x00": "must consist of letters only",
}


@pytest.mark.parametrize(("text", "problem"), BROKEN.items())
def test_broken_lists_of_words(tmp_path: Path, text: str | bytes, problem: str):
    path = words_file(tmp_path, text)
    with pytest.raises(InputError) as caught:
        sku_set(LetterSkus(words=path))
    assert str(caught.value).startswith(f"{path}: ")
    assert problem in str(caught.value)

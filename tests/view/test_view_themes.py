"""Stations, tasks and delay are told apart on both floors, by those who are colour-blind too."""

import re
from itertools import combinations, product
from pathlib import Path

import numpy as np
import pytest
from colour_vision import apart, contrast, difference

from rmfs.view import pages
from rmfs.view.themes import THEMES

GROUPS_APART = 10.0
"""Least difference (CIEDE2000) of colours of different groups; about 2 can just be seen."""
WITHIN = 10.0
CONTRAST = 3.0
"""Of what is drawn to what it is drawn on (WCAG 2, success criterion 1.4.11)."""


@pytest.mark.parametrize(
    ("one", "other", "expected"),
    [
        ((50.0, 2.6772, -79.7751), (50.0, 0.0, -82.7485), 2.0425),
        ((50.0, -1.3802, -84.2814), (50.0, 0.0, -82.7485), 1.0),
        ((60.2574, -34.0099, 36.2677), (60.4626, -34.1751, 39.4387), 1.2644),
        ((6.7747, -0.2908, -2.4247), (5.8714, -0.0985, -2.2286), 0.6377),
    ],
)
def test_differences_are_those_published(one, other, expected) -> None:
    """Pairs 1, 4, 17 and 33 of the table of Sharma, Wu and Dalal (2005)."""
    assert difference(np.array(one), np.array(other)) == pytest.approx(expected, abs=1e-4)


@pytest.mark.parametrize("name", THEMES)
def test_groups_are_apart_and_stand_out(name: str) -> None:
    theme = THEMES[name]
    stations = {**theme.stations, "elevator": theme.elevator}
    tasks = dict(theme.tasks)
    delay = {f"delay {n}": colour for n, colour in enumerate(theme.delay)}
    pod = {"pod": theme.pod}
    # robots are coloured by task or by delay, never by both
    for one, other in [
        (stations, tasks),
        (stations, delay),
        (stations, pod),
        (tasks, pod),
        (delay, pod),
    ]:
        for (a, first), (b, second) in product(one.items(), other.items()):
            assert apart(first, second) >= GROUPS_APART, (name, a, b)
    for group in (stations, tasks, delay):
        for (a, first), (b, second) in combinations(group.items(), 2):
            assert apart(first, second) >= WITHIN, (name, a, b)
    for what, colour in {**stations, **tasks, **pod, **delay}.items():
        # no delay is to be seen least
        least = 1.5 if what == "delay 0" else CONTRAST
        assert contrast(colour, theme.floor) >= least, (name, what)


def test_the_page_has_the_same_floors() -> None:
    text = (Path(pages.__file__).parent / "web/src/draw/palette.ts").read_text("utf-8")
    floors = re.findall(r'^  (light|dark): \{ back: "[^"]*", floor: "(#\w+)"', text, re.MULTILINE)
    assert dict(floors) == {name: theme.floor for name, theme in THEMES.items()}

"""Seconds of a call and of a unit of work: fitted by hand, and measured of a controller."""

from __future__ import annotations

import pandas as pd
import pytest

from rmfs.simulation.pacing.computed import SECONDS_PER_CALL, SECONDS_PER_ENTRY, SECONDS_PER_UNIT
from tests.tools import calibrate


def test_a_line_through_the_calls() -> None:
    """Half a second a call, two a unit, a quarter an entry; of equal work all is in the units."""
    measured = pd.DataFrame(
        [
            ("one", 1.0, 0.0, 2.5),
            ("one", 2.0, 8.0, 6.5),
            ("one", 4.0, 0.0, 8.5),
            ("one", 4.0, 4.0, 9.5),
            ("same", 4.0, 0.0, 2.0),
        ],
        columns=["backend", "work", "built", "seconds"],
    )
    found = calibrate.rates(measured)
    assert found.loc["one", "seconds_per_call"] == pytest.approx(0.5)
    assert found.loc["one", "seconds_per_unit"] == pytest.approx(2.0)
    assert found.loc["one", "seconds_per_entry"] == pytest.approx(0.25)
    assert found.loc["one", "error"] == pytest.approx(0.0, abs=1e-12)
    assert found.loc["same", "seconds_per_call"] == 0.0
    assert found.loc["same", "seconds_per_unit"] == pytest.approx(0.5)


def test_rates_below_zero_are_not_believed() -> None:
    measured = pd.DataFrame(
        [("one", 1.0, 0.0, 3.0), ("one", 2.0, 0.0, 2.0)],
        columns=["backend", "work", "built", "seconds"],
    )
    found = calibrate.rates(measured)
    assert found.loc["one", "seconds_per_unit"] == 0.0
    assert found.loc["one", "seconds_per_call"] == pytest.approx(2 / (1 / 3 + 1 / 2))


def test_what_is_charged_is_compared_case_by_case() -> None:
    measured = pd.DataFrame(
        [("a", "one", 1.0, 2.0, 3.0), ("a", "one", 1.0, 2.0, 5.0), ("b", "one", 0.0, 4.0, 1.0)],
        columns=["case", "backend", "work", "built", "seconds"],
    )
    found = pd.DataFrame(
        {"seconds_per_call": 0.5, "seconds_per_unit": 1.0, "seconds_per_entry": 0.25}, ["one"]
    )
    told = calibrate.charged(measured, found)
    assert told.loc["a"].tolist() == [2, 4.0, pytest.approx(0.5)]
    assert told.loc["b"].tolist() == [1, 1.0, pytest.approx(1.5)]


def test_questions_of_a_run_are_answered_again() -> None:
    asks = calibrate.questions("small", "small", "hadgs", [(["scenario", "duration_s"], 120.0)])
    measured = calibrate.answered(asks[:3], "hadgs")
    assert list(measured["backend"]) == ["rule"] * 3
    assert (measured["work"] > 0).all() and (measured["seconds"] > 0).all()


def test_the_defaults_are_those_published() -> None:
    published = pd.read_csv(calibrate.PLACE.with_suffix(".csv"), index_col="backend")
    for name, rates in (
        ("seconds_per_unit", SECONDS_PER_UNIT),
        ("seconds_per_call", SECONDS_PER_CALL),
        ("seconds_per_entry", SECONDS_PER_ENTRY),
    ):
        assert rates == pytest.approx(published[name].to_dict(), rel=0.005)


def test_what_is_published_charges_every_case_within_a_half() -> None:
    published = pd.read_csv(calibrate.CASES_PLACE)
    assert set(published["case"]) <= {calibrate.named(case) for case in calibrate.CASES}
    assert len(published) > 15
    asked = published[published["seconds"] > 0.001]
    assert asked["charged"].between(1 / 1.5, 1.5).all()

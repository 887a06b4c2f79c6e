"""Calibration: what is found keeps its promise, and what cannot be found is told in a line."""

from __future__ import annotations

import json
from functools import cache
from math import exp

import numpy as np
import pytest

from rmfs.cli import main
from rmfs.errors import InputError
from rmfs.experiments.calibration import Goal, calibrate
from rmfs.experiments.calibration.command import steps_table, verdict

NOISE = 0.08
QUICK = [
    *("--layout", "small", "--scenario", "small-arrivals", "--key", "scenario.demand.orders_per_h"),
    *("--column", "pick_station_idle_share", "--between", "20", "300", "--target", "0.6"),
    *("--tolerance", "0.3", "--test-seeds", "3", "--search-seeds", "2", "--jobs", "1"),
    *("--set", "scenario.duration_s=300", "--set", "scenario.demand.initial_orders=2"),
]


def share(level: float) -> float:
    """A mean that falls with the level like an on-time share."""
    return 1.0 / (1.0 + exp((level - 250.0) / 40.0))


@cache
def drawn(seed: int) -> float:
    return np.random.default_rng(seed).normal()


class Noisy:
    """Responses with noise by seed, part of which the levels share; keeps what it was asked."""

    def __init__(self, mean=share, noise: float = NOISE) -> None:
        self.mean, self.noise = mean, noise
        self.asked: list[tuple[float, range]] = []

    def __call__(self, level, seeds):
        self.asked.append((level, seeds))
        shared = [drawn(seed) for seed in seeds]
        own = [np.random.default_rng([seed, int(1000 * level)]).normal() for seed in seeds]
        noise = np.array(shared) * 0.8 + np.array(own) * 0.6
        return self.mean(level) + self.noise * noise


def sought(**changes) -> Goal:
    given = {"target": 0.9, "tolerance": 0.04, "low": 50.0, "high": 400.0} | changes
    return Goal(**given)


def quiet(_step) -> None:
    """Say nothing."""


class TestPromise:
    @pytest.mark.parametrize(("target", "noise"), [(0.5, NOISE), (0.9, NOISE), (0.97, 0.02)])
    def test_the_mean_is_within_the_tolerance_as_often_as_promised(self, target, noise) -> None:
        """Of 200 calibrations 95 % keep the tolerance at least; here the truth is known."""
        kept = 0
        for repetition in range(200):
            goal = sought(target=target, first_seed=10_000 * repetition)
            found = calibrate(goal, Noisy(noise=noise), quiet)
            assert found.found
            kept += abs(share(found.level) - target) <= goal.tolerance
        assert kept >= 190

    def test_a_rising_mean_is_followed_as_well(self) -> None:
        found = calibrate(sought(target=0.3), Noisy(lambda level: 1.0 - share(level)), quiet)
        assert 1.0 - share(found.level) == pytest.approx(0.3, abs=0.04)
        assert found.slope > 0

    def test_without_noise_ten_seeds_will_do(self) -> None:
        found = calibrate(sought(), Noisy(noise=0.0), quiet)
        assert found.steps[-1].seeds == 10
        assert found.half_width == pytest.approx(0.0, abs=1e-9)

    def test_no_test_has_seeds_that_were_looked_at_before(self) -> None:
        goal = sought(tolerance=0.01, first_seed=7)
        found = calibrate(goal, Noisy(noise=0.03), quiet)
        tests = [step for step in found.steps if step.phase == "test"]
        used = [seed for s in tests for seed in range(s.first_seed, s.first_seed + s.seeds)]
        search = {7 + seed for seed in range(goal.search_seeds)}
        assert len(set(used)) == len(used)
        assert not search & set(used)
        assert min(search | set(used)) == 7

    def test_a_search_that_misleads_is_put_right_by_tests(self) -> None:
        """The seeds of the search are all off by the same: their curve is shifted to the test."""

        def misleading(level, seeds):
            mean = share(level) + (0.1 if min(seeds) < 4 else 0.0)
            return mean + 0.03 * np.array([np.random.default_rng(s).normal() for s in seeds])

        found = calibrate(sought(tolerance=0.02), misleading, quiet)
        tests = [step for step in found.steps if step.phase == "test"]
        assert len(tests) > 1
        assert [step.verdict for step in tests].count("stands") == 1
        assert found.level == tests[-1].level
        assert share(found.level) == pytest.approx(0.9, abs=0.02)

    def test_the_same_goal_finds_the_same(self) -> None:
        assert calibrate(sought(), Noisy(), quiet) == calibrate(sought(), Noisy(), quiet)


class TestRefusals:
    def test_a_target_beyond_both_ends(self) -> None:
        respond = Noisy(noise=0.001)
        with pytest.raises(InputError, match=r"between 300 and 400: .* and is 0.9"):
            calibrate(sought(low=300.0), respond, quiet)
        assert max(len(seeds) for _, seeds in respond.asked) == 32

    def test_too_few_runs_are_told_and_not_exceeded(self) -> None:
        respond = Noisy(noise=0.3)
        found = calibrate(sought(tolerance=0.01, most_runs=100), respond, quiet)
        assert not found.found
        assert found.runs <= 100
        assert len({(level, seed) for level, seeds in respond.asked for seed in seeds}) <= 100

    @pytest.mark.parametrize(
        ("key", "value"),
        [
            ("tolerance", 0.0),
            ("low", 400.0),
            ("confidence", 1.0),
            ("search_seeds", 0),
            ("test_seeds", 2),
            ("most_runs", 5),
            ("first_seed", -1),
            ("target", float("nan")),
        ],
    )
    def test_numbers_out_of_range(self, key, value) -> None:
        with pytest.raises(InputError, match=f"^{key} = "):
            sought(**{key: value})

    def test_runs_without_a_value(self) -> None:
        with pytest.raises(InputError, match="at 50: a run has no value"):
            calibrate(sought(), lambda _level, seeds: np.full(len(seeds), np.nan), quiet)


class TestCommand:
    def test_finds_stores_and_goes_on(self, tmp_path, monkeypatch, capsys) -> None:
        """A second call with the same folder runs nothing again and finds the same."""
        monkeypatch.chdir(tmp_path)
        given = ["experiment", "calibrate", *QUICK, "--out", "found", "--file", "steps.md"]
        assert main(given) == 0
        first = capsys.readouterr().out
        assert "pick_station_idle_share is 0.6 within 0.3 with confidence 95%" in first
        told = json.loads((tmp_path / "found" / "calibration.json").read_text())
        assert told["key"] == "scenario.demand.orders_per_h"
        assert 20 < told["level"] < 300
        assert (tmp_path / "steps.md").read_text().count("stands") == 1
        before = sorted(path.name for path in (tmp_path / "found" / "runs").iterdir())
        assert main(given) == 0
        assert capsys.readouterr().out == first
        assert sorted(path.name for path in (tmp_path / "found" / "runs").iterdir()) == before

    @pytest.mark.parametrize(
        ("changes", "told"),
        [
            (["--column", "on_time"], "column on_time: not a number of the footprint"),
            (["--column", "wall_s"], "column wall_s: not a number"),
            (["--key", "scenario.demand.order_per_h"], "order_per_h"),
            (["--set", "scenario.demand.orders_per_h=3"], "is the parameter to calibrate"),
            (["--set", "orders"], "expected KEY=VALUE"),
            (["--between", "300", "20"], "low = 300: must be below high = 20"),
            (["--between", "-5", "20"], "orders_per_h"),
            (["--tolerance", "0"], "tolerance = 0: must be above 0"),
            (["--layout", "smal"], "smal"),
        ],
    )
    def test_bad_input_is_one_line(self, changes, told, tmp_path, monkeypatch, capsys) -> None:
        monkeypatch.chdir(tmp_path)
        assert main(["experiment", "calibrate", *QUICK, *changes, "--out", "x"]) == 2
        err = capsys.readouterr().err
        assert told in err
        assert len(err.strip().splitlines()) == 1
        assert not list(tmp_path.iterdir())


def test_the_table_shows_every_digit_of_a_level() -> None:
    """The result can be read from it, however small it is."""
    goal = sought(target=0.5, low=1e-4, high=8e-4, tolerance=0.2, confidence=0.999)
    found = calibrate(goal, Noisy(lambda level: 1000.0 * level, noise=0.05), quiet)
    table = steps_table(found, "scenario.rate", "on_time_share")
    rows = [line.split("|") for line in table.to("markdown").splitlines() if line[:1] == "|"][2:]
    assert [float(row[3]) for row in rows] == [step.level for step in found.steps]
    assert "confidence 99.9%" in table.caption
    assert "confidence 99.9%" in verdict(found, "scenario.rate", "on_time_share")

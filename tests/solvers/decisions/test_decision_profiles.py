"""Gaps, integrals and profiles, on figures worked out by hand."""

from __future__ import annotations

import math

import pandas as pd
import pytest
from decision_samples import sample

from rmfs.solvers.decisions.profiling import limits, points, primal_gap, primal_integral
from rmfs.solvers.decisions.ranking import (
    data_profile,
    integrals,
    performance,
    times_to_gap,
    with_gaps,
)


@pytest.mark.parametrize(
    ("value", "best", "gap"),
    [(0, 0, 0), (2, -1, 1), (-1, -2, 0.5), (4, 2, 0.5), (0, 3, 1), (math.nan, 3, 1), (3, 3, 0)],
)
def test_primal_gaps(value: float, best: float, gap: float) -> None:
    assert primal_gap(value, best) == gap


def test_the_primal_integral_is_the_area_below_the_gap() -> None:
    # nothing until 1, half until 3, then all; the worse value at 2 does not count
    assert primal_integral([(3, 0.0), (1, 0.5), (2, 0.7)], 4) == pytest.approx((1 + 1) / 4)
    assert primal_integral([], 5) == 1.0
    assert primal_integral([(9, 0.0)], 5) == 1.0


def test_limits_double() -> None:
    assert limits("cp_sat", 0.005) == [0.001, 0.002, 0.004]
    assert limits("highs", 9) == [1, 2, 4, 8]
    assert limits("flow", 9) == [9]


TABLE = pd.DataFrame(
    [
        ("q1", "stays", "a", 0, 1.0, 1.0, 1.0, 20.0),
        ("q1", "stays", "a", 0, 2.0, 2.0, 2.0, 10.0),
        ("q1", "stays", "b", 0, 1.0, 1.0, 4.0, 10.0),
        ("q2", "stays", "a", 0, 1.0, 1.0, 1.0, math.nan),
        ("q2", "stays", "b", 0, 1.0, 1.0, 3.0, 5.0),
    ],
    columns=["question", "family", "method", "seed", "work_limit", "work", "wall_s", "value"],
)


def test_profiles_of_a_table() -> None:
    table = with_gaps(TABLE)
    assert table["gap"].tolist() == [0.5, 0.0, 0.0, 1.0, 0.0]
    times = times_to_gap(table, 0.01)
    assert times.loc[("q1", 0)].tolist() == [2.0, 4.0]
    assert times.loc[("q2", 0)].tolist() == [math.inf, 3.0]
    shares = performance(times, [1, 2])
    assert shares["a"].tolist() == [0.5, 0.5]
    assert shares["b"].tolist() == [0.5, 1.0]
    assert data_profile(times, [1, 2, 3, 4])["b"].tolist() == [0.0, 0.0, 0.5, 1.0]
    areas = integrals(table).set_index(["question", "method"])["over_wall"]
    assert areas["q1", "a"] == pytest.approx((1 + 0.5) / 4)


def test_a_better_known_value_counts() -> None:
    assert with_gaps(TABLE, {"q1": 5.0, "q2": 9.0})["gap"].tolist() == [0.75, 0.5, 0.5, 1.0, 0.0]
    more = TABLE.assign(family="run_bound")
    assert with_gaps(more)["best"].tolist() == [20.0, 20.0, 20.0, 5.0, 5.0]


def test_points_repeat_but_for_the_clock() -> None:
    """And a longer limit is never worse."""
    question = sample("pile_on", 3)
    rows = [list(points(question, "cp_sat", 0.004)) for _ in range(2)]
    for one, other in zip(*rows, strict=True):
        assert {k: v for k, v in one.items() if not k.endswith("_s")} == {
            k: v for k, v in other.items() if not k.endswith("_s")
        }
    values = [row["value"] for row in rows[0]]
    assert len(values) == 3
    assert values == sorted(values, reverse=True)

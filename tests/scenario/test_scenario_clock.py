"""Times in whole microseconds, cycles and down periods."""

from __future__ import annotations

from itertools import islice

import numpy as np
import pytest

from rmfs.scenario.clock import US_PER_H, US_PER_S, Cycle, Openings, first_us, nearest_us
from rmfs.scenario.parameters import DownPeriods

HOUR = 3600.0


def test_the_first_microsecond_not_before_a_time():
    rng = np.random.default_rng(1)
    for time_us in rng.integers(0, 10**12, 5000).tolist():
        assert first_us(time_us / US_PER_S) == time_us
        assert nearest_us(time_us / US_PER_S) == time_us
    for time_s in (rng.random(5000) * 1e6).tolist():
        time_us = first_us(time_s)
        assert time_us / US_PER_S >= time_s > (time_us - 1) / US_PER_S


def test_times_of_a_cycle_come_again():
    cycle = Cycle(10.0, gone_s=4.0)
    phases = [0, 5 * US_PER_S]
    come = [(time_us / US_PER_S, which) for time_us, which in islice(cycle.times_us(phases), 5)]
    assert come == [(1.0, 1), (6.0, 0), (11.0, 1), (16.0, 0), (21.0, 1)]
    assert [cycle.phase_us(time_us) for time_us in (0, 6 * US_PER_S)] == [4 * US_PER_S, 0]


def test_a_time_of_the_cycle_at_time_zero_comes_at_once():
    for gone_s in (0.0, 4.0, 14.0):
        times = Cycle(10.0, gone_s).times_us([nearest_us(gone_s % 10)])
        assert next(times) == (0, 0)


NIGHT = DownPeriods(periods_s=[[0, 6 * HOUR], [22 * HOUR, 24 * HOUR]])


@pytest.mark.parametrize(
    ("hour", "is_open", "opens"),
    [(0, False, 6), (5.999, False, 6), (6, True, 6), (21.999, True, 21.999), (22, False, 30)],
)
def test_night_wraps_round_midnight(hour: float, is_open: bool, opens: float):
    openings = Openings(NIGHT, 0.0)
    now_us = round(hour * US_PER_H)
    assert openings.is_open(now_us) == is_open
    assert openings.open_from_us(now_us) == round(opens * US_PER_H)


def test_down_periods_follow_the_clock():
    openings = Openings(NIGHT, gone_s=5 * HOUR)
    assert not openings.is_open(0)
    assert openings.open_from_us(0) == US_PER_H
    assert openings.open_from_us(17 * US_PER_H) == 25 * US_PER_H


def test_periods_that_touch_are_one():
    openings = Openings(DownPeriods(cycle_s=10, periods_s=[[1, 3], [3, 5]]), 0.0)
    assert openings.open_from_us(US_PER_S) == 5 * US_PER_S
    assert not openings.is_open(3 * US_PER_S)


def test_never_down():
    assert Openings(None, 0.0).is_open(0)
    assert Openings(None, 0.0).open_from_us(17) == 17

"""The narrow phase against dense sampling and against itself."""

from __future__ import annotations

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from rmfs.measure.checker.distance import below, minimum, squared_distance
from rmfs.measure.checker.motion import Pieces

position = st.floats(-5, 5)
speed = st.floats(-1.5, 1.5)
bend = st.floats(-0.5, 0.5)


@st.composite
def motions(draw):
    """A piece of up to 10 s, anywhere within a small hall."""
    begin = draw(st.floats(0, 1000))
    values = [begin, begin + draw(st.floats(0.1, 10))]
    values += [draw(one) for one in (position, position, speed, speed, bend, bend)]
    numbers = (np.array([value]) for value in values)
    return Pieces(np.zeros(1, np.int64), *numbers, np.zeros(1, np.bool_))


def sampled(one: Pieces, other: Pieces, count: int = 4001) -> np.ndarray:
    begin, end = max(one.t0_s[0], other.t0_s[0]), min(one.t1_s[0], other.t1_s[0])
    time = np.linspace(begin, end, count)
    x1, y1 = one.at(time)
    x2, y2 = other.at(time)
    return (x1 - x2) ** 2 + (y1 - y2) ** 2


@given(motions(), motions(), st.floats(0.1, 5.0))
@settings(max_examples=200, deadline=None)
def test_verdict_agrees_with_dense_sampling(one, other, limit):
    if max(one.t0_s[0], other.t0_s[0]) >= min(one.t1_s[0], other.t1_s[0]):
        other = Pieces(other.row, one.t0_s, one.t1_s, *(getattr(other, n) for n in _REST))
    least = sampled(one, other).min()
    _, _, power = squared_distance(one, other)
    verdict = bool(below(power, np.array([limit**2]))[0])
    if least < limit**2 - 1e-9:
        assert verdict
    # samples are at most 2.5 ms apart, and the relative speed at most 20 m/s
    if np.sqrt(least) - 0.05 > limit:
        assert not verdict


_REST = ("x_m", "y_m", "vx", "vy", "hx", "hy", "guided")


@given(motions(), motions())
@settings(max_examples=200, deadline=None)
def test_minimum_is_reached_and_not_undercut(one, other):
    other = Pieces(other.row, one.t0_s, one.t1_s, *(getattr(other, n) for n in _REST))
    _, _, power = squared_distance(one, other)
    where, value = minimum(power)
    samples = sampled(one, other)
    assert 0 <= where[0] <= 1
    assert value[0] <= samples.min() + 1e-9
    assert not below(power, value - 1e-9)[0]
    assert below(power, value + 1e-9)[0]


def test_a_touch_between_the_ends_is_found():
    """D² = (u - 0.3)² + 0.25: the ends are far, the minimum of 0.25 lies inside."""
    power = np.array([[0.09 + 0.25, -0.6, 1.0, 0.0, 0.0]])
    assert below(power, np.array([0.25 + 1e-12]))[0]
    assert not below(power, np.array([0.25 - 1e-12]))[0]


def test_two_minima_are_both_seen():
    """D² = 64 (u - 1/4)² (u - 3/4)² + slope: the lower of two valleys counts."""
    valleys = np.poly([0.25, 0.25, 0.75, 0.75])[::-1] * 64
    for slope, expected in [(0.1, 0.25), (-0.1, 0.75)]:
        power = valleys + np.array([0.5, slope, 0, 0, 0])
        where, _ = minimum(power[None])
        assert abs(where[0] - expected) < 0.01

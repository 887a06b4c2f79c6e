import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from rmfs.traffic import Motion

speeds = st.floats(0.2, 3.0)
rates = st.floats(0.1, 3.0)
lengths = st.floats(0.05, 60.0)
shares = st.floats(0.0, 1.0)


@given(rates, rates, speeds, shares, lengths)
def test_position_is_the_integral_of_speed(a, b, top, share, length):
    """Numerical integration of the speed gives the position at every time."""
    motion = Motion(a, b, top, share * top, length)
    time = np.linspace(0.0, motion.duration(), 4001)
    speed = np.array([motion.speed_at(t) for t in time])
    steps = np.diff(time) * (speed[1:] + speed[:-1]) / 2
    integral = np.concatenate([[0.0], np.cumsum(steps)])
    position = np.array([motion.position_at(t) for t in time])
    # two kinks of the speed may lie inside a step: each costs at most (a + b) dt^2 / 8
    tolerance = 1e-9 + 2 * (a + b) * (time[1] - time[0]) ** 2
    assert np.abs(position - integral).max() < tolerance


@given(rates, rates, speeds, shares, lengths, shares)
def test_time_and_position_are_inverse(a, b, top, share, length, where):
    motion = Motion(a, b, top, share * top, length)
    distance = where * length
    assert abs(motion.position_at(motion.time_at(distance)) - distance) < 1e-6


@given(rates, rates, speeds, shares, lengths)
def test_limits_are_kept(a, b, top, share, length):
    """Never faster than the top speed, never accelerating or braking harder than allowed."""
    motion = Motion(a, b, top, share * top, length)
    time = np.linspace(0.0, motion.duration(), 500)
    speed = np.array([motion.speed_at(t) for t in time])
    change = np.diff(speed) / np.diff(time)
    assert speed.max() <= top + 1e-9
    assert change.max() <= a + 1e-6
    assert change.min() >= -b - 1e-6


@given(rates, rates, speeds, lengths, lengths)
def test_longer_ways_take_longer(a, b, top, one, other):
    short, long = sorted((one, other))
    assert Motion(a, b, top, 0.0, short).duration() <= Motion(a, b, top, 0.0, long).duration()


def test_the_published_run_times():
    """0.5 m/s2, 1.5 m/s: 2 m in 4 s, 5 m in 6.33 s, 10 m in 9.67 s (path-planning study)."""
    for length, seconds in [(1.0, 8**0.5), (2.0, 4.0), (5.0, 19 / 3), (10.0, 29 / 3)]:
        assert abs(Motion(0.5, 0.5, 1.5, 0.0, length).duration() - seconds) < 1e-9


def test_braking_all_the_way():
    """From 1 m/s at 0.5 m/s2, 0.75 m are not enough to stop: 1 s to 0.5 m/s covers them."""
    motion = Motion(0.5, 0.5, 1.5, 1.0, 0.75)
    assert abs(motion.duration() - 1.0) < 1e-9
    assert abs(motion.speed_at(motion.duration()) - 0.5) < 1e-9

"""Pickers: fatigue and recovery against the published equations."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from rmfs.scenario.parameters import Pickers
from rmfs.world.pickers import HOUR_S, Picker, Staff, after_rest, after_work

GROWS, GOES = 0.6, 1.8


def staff(**given) -> tuple[Staff, Picker]:
    one = Picker(0, 0, 0, 1.0)
    made = Staff(Pickers.model_validate(given), [one], [10.0])
    return made, one


def test_work_and_rest_are_the_equations_of_the_paper():
    """F(t) = 1 - exp(-λ t), what is left after a rest of τ is F exp(-μ τ), and so on.

    Jaber, Givi and Neumann (2013): the first cycle from zero, the next ones from what was left.
    """
    work_h, rest_h, left = 1.5, 0.25, 0.0
    for cycle in range(6):
        fatigue = left + (1.0 - left) * (1.0 - np.exp(-GROWS * work_h))
        assert after_work(left, GROWS, work_h * HOUR_S) == pytest.approx(fatigue, rel=1e-12)
        rested = fatigue * np.exp(-GOES * rest_h)
        assert after_rest(fatigue, GOES, rest_h * HOUR_S) == pytest.approx(rested, rel=1e-12)
        if cycle == 0:
            assert fatigue == pytest.approx(1.0 - np.exp(-0.9))
        left = rested
    # the cycles approach their fixed point, as the curves of the model do
    peak = (1 - np.exp(-GROWS * work_h)) / (1 - np.exp(-GROWS * work_h - GOES * rest_h))
    for _ in range(60):
        fatigue = after_work(left, GROWS, work_h * HOUR_S)
        left = after_rest(fatigue, GOES, rest_h * HOUR_S)
    assert fatigue == pytest.approx(peak)


@pytest.mark.parametrize("begin", [0.0, 0.3, 0.9])
def test_they_solve_their_differential_equations(begin):
    span = (0.0, 2.0)
    grown = solve_ivp(lambda t, f: GROWS * (1 - f), span, [begin], rtol=1e-9, atol=1e-12)
    assert after_work(begin, GROWS, 2 * HOUR_S) == pytest.approx(grown.y[0, -1], rel=1e-6)
    gone = solve_ivp(lambda t, f: -GOES * f, span, [begin], rtol=1e-9, atol=1e-12)
    assert after_rest(begin, GOES, 2 * HOUR_S) == pytest.approx(gone.y[0, -1], rel=1e-6, abs=1e-9)


def test_work_in_pieces_is_work_at_once():
    made = after_work(after_work(0.1, GROWS, 700.0), GROWS, 1300.0)
    assert made == pytest.approx(after_work(0.1, GROWS, 2000.0))


def test_a_day_of_a_picker():
    """Work, a wait, work over the end of the shift, a break; looked at all the time."""
    given = {"per_h": GROWS, "recovery_per_h": GOES, "waiting_rests": 0.5, "initial": 0.0}
    people, one = staff(fatigue=given)
    people.come(one, 0.0)
    people.begin_unit(one, 0.0, 600.0)
    for look_s in (100.0, 599.0, 650.0, 900.0):
        people.fatigue(one, look_s)
    expected = after_rest(after_work(0.0, GROWS, 600.0), GOES * 0.5, 400.0)
    assert people.fatigue(one, 1000.0) == pytest.approx(expected)
    people.begin_unit(one, 1000.0, 300.0)
    people.leave(one, 1200.0)  # the unit is done before the picker goes
    assert people.at_station == [None]
    expected = after_rest(after_work(expected, GROWS, 300.0), GOES, 700.0)
    assert people.fatigue(one, 2000.0) == pytest.approx(expected)
    people.come(one, 2000.0)
    people.verify()
    assert people.fatigue(one, 2000.0) == pytest.approx(expected)
    assert people.unit_s(0, 2000.0) == pytest.approx(10.0 * (1.0 + 0.3 * expected))


def test_slow_people_take_longer():
    people, one = staff()
    one.speed = 0.8
    assert people.unit_s(0, 0.0) == np.inf
    people.come(one, 0.0)
    assert people.unit_s(0, 0.0) == pytest.approx(12.5)

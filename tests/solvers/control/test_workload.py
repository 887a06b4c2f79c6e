"""Work of stations and by how much it exceeds the least."""

from __future__ import annotations

import numpy as np
from doubles import Situation, small_layout

from rmfs.solvers.control.pile_on.parameters import PileOnParameters
from rmfs.solvers.control.pile_on.snapshot import _travel
from rmfs.solvers.control.workload import excess_s


def two_stations() -> Situation:
    """Station 0 has five units to pick, station 1 has two."""
    situation = Situation(small_layout(places=4, pods=2, pick_stations=2))
    situation.stock(0, s0=9)
    situation.assigned(station=0, s0=3)
    situation.assigned(station=0, s0=2)
    situation.assigned(station=1, s0=2)
    return situation


def test_three_units_more_than_the_other_station():
    view = two_stations().view
    found = excess_s(view, view.pick_stations)
    assert found.tolist() == [3 * view.unit_s(0), 0.0]


def test_a_station_that_is_off_is_not_compared_with():
    situation = two_stations()
    situation.world.pick_stations[1].active = False
    view = situation.view
    assert excess_s(view, view.pick_stations)[0] == 0.0
    situation.world.pick_stations[0].active = False
    assert excess_s(view, view.pick_stations).tolist() == [0.0, 0.0]


def test_pile_on_pays_for_visits_of_the_busier_station():
    view = two_stations().view
    plain, even = (_travel(view, PileOnParameters(balance=b)) for b in (0.0, 2.0))
    assert np.allclose(even - plain, [[6 * view.unit_s(0), 0.0]] * len(plain))

"""What a pick station does at a pile-on, against figures worked out on paper."""

from __future__ import annotations

from dataclasses import replace
from math import inf, sqrt

import pytest
from scripted_trace import grid

from rmfs.layout.model import PickStation
from rmfs.measure.tables.at_pile_on import change_s, units_per_h


def street(transfer_s, pick_s):
    """Three waypoints in a row, 1 m apart, the station in the middle."""
    station = PickStation(1, (1, 0), 0.4, 6, transfer_s, pick_s, 1)
    return replace(grid(3, 1, [0]), pick_stations=(station,)), station


def least_change(layout):
    """Straight on: to speed up over 1 m, and to brake over 1 m."""
    kind = layout.robot_kinds[0]
    out = min(sqrt(2 / kind.acceleration_m_s2), 1e9)
    back = min(sqrt(2 / kind.deceleration_m_s2), 1e9)
    assert kind.top_speed_m_s**2 >= 2 * max(kind.acceleration_m_s2, kind.deceleration_m_s2)
    return out + back


def test_the_change_of_robots():
    layout, _ = street(10, 3)
    kind = replace(
        layout.robot_kinds[0], acceleration_m_s2=0.5, deceleration_m_s2=0.5, top_speed_m_s=1.5
    )
    layout = replace(layout, robot_kinds=(kind,))
    assert change_s(layout, 1) == pytest.approx(least_change(layout)) == pytest.approx(4.0)
    # at the end of the street the robot has to turn round
    assert change_s(layout, 2) == pytest.approx(4.0 + kind.full_turn_s / 2)
    slow = replace(layout, robot_kinds=(replace(kind, top_speed_m_s=0.5),))
    # 0.25 m in 1 s to speed up, 0.75 m in 1.5 s, and the same to brake
    assert change_s(slow, 1) == pytest.approx(5.0)
    # the faster robot counts
    both = replace(layout, robot_kinds=(slow.robot_kinds[0], kind))
    assert change_s(both, 1) == pytest.approx(4.0)


@pytest.mark.parametrize(
    ("transfer_s", "pick_s", "units", "rate"),
    [
        (10, 3, 1, 360),  # the change of 4 s is hidden behind the transfer
        (10, 8, 1, 3600 / 12),
        (10, 8, 4, 3600 * 4 / 42),
        (10, 8, inf, 360),
        (5, 8, 2, 3600 * 2 / (8 + 12)),
        (0, 0, inf, inf),
    ],
)
def test_the_rate(transfer_s, pick_s, units, rate):
    layout, station = street(transfer_s, pick_s)
    kind = replace(
        layout.robot_kinds[0], acceleration_m_s2=0.5, deceleration_m_s2=0.5, top_speed_m_s=1.5
    )
    layout = replace(layout, robot_kinds=(kind,))
    assert units_per_h(layout, station, units) == pytest.approx(rate)

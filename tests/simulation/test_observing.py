"""Who looks at a run, and when, changes nothing in it."""

from __future__ import annotations

import random

import pytest
from test_golden_footprints import RULES, hashes, written

from rmfs.simulation.kernel import Kernel


def looked_at(simulation: Kernel, progress: object = None) -> None:
    """Stop at random moments and look at everything that traffic shows."""
    moments = random.Random(5)
    traffic = simulation.traffic
    time_s = 0.0
    while time_s < simulation.end_s:
        time_s = min(time_s + moments.uniform(0.5, 45.0), simulation.end_s)
        simulation.run_until(time_s)
        for robot in range(len(traffic.motion()["distance_m"])):
            traffic.plan(robot)
            traffic.robot_waypoint(robot)
        traffic.heat()
        traffic.edges()


@pytest.mark.parametrize("name", RULES)
def test_a_run_that_is_looked_at_is_the_same_run(name: str) -> None:
    golden = written()
    assert hashes(RULES[name], golden["columns"], looked_at) == golden["runs"][name]

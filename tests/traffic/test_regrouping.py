"""Plans made anew from wherever robots say they are: no panic, whatever they say and when."""

import random

import pytest
from random_tasks import RandomTasks

from rmfs.layout import load

SECOND = 1_000_000


def said(traffic, layout, draw, robot):
    """Where a robot stands or will stop: where its plan has it, mostly."""
    moves = traffic.plan(robot)
    begun = moves[0] if moves and moves[0].start_us < traffic.now_us else None
    if draw.random() < 0.15:
        later_us = traffic.now_us + draw.choice([0, 4 * SECOND])
        return draw.randrange(layout.waypoints), 0.0, later_us
    if begun is not None and draw.random() < 0.1:
        return None
    if begun is not None:
        stop = [begun.from_waypoint, *traffic.clearance(robot)][-1]
        return stop, begun.heading_rad, max(begun.end_us, traffic.now_us)
    return moves[0].from_waypoint if moves else traffic.rest_waypoint(robot), 0.0, 0


@pytest.mark.parametrize("seed", [0, 9, 44, 102, 823, *range(2000, 2020)])
def test_robots_anywhere_and_late(seed):
    """Robots stray while they are served, while they lift, and while others wait for them.

    The first five seeds ended in panics: "only driving steps are planned" where a robot had strayed
    from the head of a queue, and overlaps after a delay and after a stop that was to come.
    """
    draw = random.Random(seed)
    layout = load("default" if seed % 2 else "small", [(["robots"], draw.choice([2, 4, 6, 8]))])
    tasks = RandomTasks(layout, seed, record_trace=False)
    traffic, regrouped = tasks.traffic, 0
    for _ in range(60):
        tasks.run(traffic.now_us / SECOND + draw.choice([0.05, 0.5, 2, 6, 20]))
        if draw.random() < 0.2:
            late_us = draw.randrange(5 * SECOND)
            traffic.delay(draw.randrange(layout.robots), late_us, begun=draw.random() < 0.7)
            continue
        rests = [said(traffic, layout, draw, robot) for robot in range(layout.robots)]
        try:
            traffic.regroup(rests)
        except ValueError:  # two at one place
            continue
        regrouped += 1
    assert regrouped > 5

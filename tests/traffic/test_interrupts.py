"""Long work of the compiled core ends at once when a signal comes, and its traffic says so."""

import signal
import time
from contextlib import contextmanager

import pytest
from planning_sample import planning
from random_tasks import RandomTasks

from rmfs.control.choices import choose
from rmfs.control.pp import planner_settings
from rmfs.control.problems import Problem
from rmfs.errors import InternalError
from rmfs.layout import load
from rmfs.solvers.models.planning.compiled import visits

WITHOUT_END = {"nodes": 1e12, "nodes_per_robot": 1e12, "labels": 1e12}


class EnoughError(Exception):
    """What the handler raises."""


@contextmanager
def interrupted(after_s: float = 1.0):
    def handler(*_: object) -> None:
        raise EnoughError

    before = signal.signal(signal.SIGALRM, handler)
    signal.setitimer(signal.ITIMER_REAL, after_s)
    began = time.monotonic()
    try:
        with pytest.raises(EnoughError):
            yield
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, before)
    assert time.monotonic() - began < 20  # also on a busy machine


def test_a_search_of_plans():
    given = visits(planning(stations=4, orders=60, pods=50, skus=30, visits=5))
    with interrupted():
        given.searched([[] for _ in range(4)], 10**12, 1)
    # what was asked is whole: only the answer is missing
    assert given.searched([[] for _ in range(4)], 10, 1)


def test_traffic():
    usual = planner_settings(choose(Problem.PP, {"name": "od-id"}, "test"), 0)
    endless = usual._replace(parameters={**usual.parameters, **WITHOUT_END})
    tasks = RandomTasks(load("small", [(["robots"], 24)]), 1, record_trace=False, planner=endless)
    with interrupted():
        tasks.run(3600)
    with pytest.raises(InternalError, match="was interrupted while it worked"):
        tasks.traffic.advance(10**12)

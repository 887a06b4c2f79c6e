"""Functions that change in steps."""

from __future__ import annotations

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from rmfs.measure.log import Log
from rmfs.measure.recorder import TASKS, Recorder
from rmfs.measure.steps import Steps, counts, covered
from rmfs.measure.tables.logs import Logs
from rmfs.measure.tables.robots import with_task

times = st.lists(st.floats(0, 100), max_size=20)


def test_intervals_with_open_ends():
    steps = Steps.between([0.0, 5.0, 7.0], [6.0, np.nan, np.nan])
    assert steps.at([0.0, 4.9, 5.0, 6.0, 7.0, 99.0]).tolist() == [1, 1, 2, 1, 2, 2]
    assert steps.mean(4.0, 8.0) == (1 + 2 + 1 + 2) / 4


def test_before_the_first_change():
    assert Steps([5.0], 1.0, initial=3.0).at([0.0, 5.0]).tolist() == [3, 4]
    assert Steps([], 1.0, initial=3.0).mean(0, 10) == 3.0


def test_an_empty_interval_has_no_mean():
    assert np.isnan(Steps([], 1.0).mean(3.0, 3.0))


@given(times, st.floats(0, 50), st.floats(1, 50))
def test_mean_agrees_with_fine_sampling(changes, begin, length):
    steps = Steps(changes, 1.0)
    grid = begin + (np.arange(20_000) + 0.5) / 20_000 * length
    assert abs(steps.mean(begin, begin + length) - steps.at(grid).mean()) < 0.02


@given(times)
def test_counts_miss_nothing(events):
    edges = np.array([0.0, 10.0, 50.0, 100.0])
    assert counts(events, edges).sum() == len(events)


def test_counts_are_of_the_interval_that_ends_with_them():
    assert counts([0.0, 10.0, 10.1], np.array([0.0, 10.0, 20.0])).tolist() == [2, 1]


def test_covered_time():
    begin, end = np.array([1.0, 5.0]), np.array([2.0, 8.0])
    assert covered(begin, end, np.array([0, 1.5, 3, 6, 9.0])).tolist() == [0, 0.5, 1, 2, 4]
    assert covered(begin[:0], end[:0], np.array([3.0])).tolist() == [0]


def test_a_task_that_ends_with_the_run_is_not_counted_beside_the_next() -> None:
    """At 100 s, the end of the run, the robot starts to park; the other still rests."""
    tasks = Log(begin_s="f8", robot="i2", kind="i1")
    for begin_s, robot, task in [(0.0, 0, "pick"), (0.0, 1, "rest"), (100.0, 0, "park")]:
        tasks.add(begin_s, robot, TASKS.index(task))
    recorder = Recorder()
    recorder.layout, recorder.world = None, None
    recorder.tasks, recorder.end_s = tasks, 100.0
    logs = Logs(recorder)
    at_end = {task: int(with_task(logs, task).at(100.0)) for task in ("pick", "park", "rest")}
    assert at_end == {"pick": 0, "park": 1, "rest": 1}
    assert int(with_task(logs, "pick").at(99.0)) == 1

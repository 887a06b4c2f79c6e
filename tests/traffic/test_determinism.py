import hashlib

from random_tasks import RandomTasks

from rmfs.layout import load


def digest(trace):
    h = hashlib.sha256()
    for name in sorted(trace):
        h.update(trace[name].tobytes())
    return h.hexdigest()


def test_the_same_tasks_give_the_same_trace():
    one = RandomTasks(load("default"), 5).run(600).traffic.trace()
    two = RandomTasks(load("default"), 5).run(600).traffic.trace()
    other = RandomTasks(load("default"), 6).run(600).traffic.trace()
    assert digest(one) == digest(two) != digest(other)


def test_advancing_in_small_steps_changes_nothing():
    """How far the caller advances at a time is not part of the result."""
    whole = RandomTasks(load("default"), 5).run(400).traffic.trace()
    stepped = RandomTasks(load("default"), 5)
    for second in range(1, 401):
        stepped.run(second)
    assert digest(whole) == digest(stepped.traffic.trace())

r"""The routes of robots as a mixed-integer program with times.

The owner o of a pod is the robot r that carries it now (o = r), or the task u that brings it to a
station (o = R + u, for R robots). The columns state

- `first`: whether robot r, which carries no pod, begins with task t;
- `onward`: whether the pod of owner o is stored at place l, and the same robot then does task t;
- `last`: whether the pod of owner o is stored at place l, and the robot's route ends there;
- `leave`: whether task t is left undone;
- `arrive`, `late`: when the pod of task t arrives at its station, and how late it is.

If a robot does task t after task u and stores the pod of u at place l in between, the pod of t
arrives only after the robot has finished task u and made the trips. M is a large constant;
service, store, fetch and bring stand for the fields `service_s`, `store_s`, `fetch_s` and `bring_s`
of `TaskSequence`:

.. math::

    arrive_t \ge arrive_u + service_u + store_{ul} + fetch_{lt} + bring_t
        - M (1 - onward_{R+u,l,t})
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from rmfs.solvers.decisions.schema import Plain
from rmfs.solvers.models.names import Names
from rmfs.solvers.models.program import LinearProgram, ProgramBuilder
from rmfs.solvers.models.tasks.sequence.candidates import every_way

if TYPE_CHECKING:
    from rmfs.solvers.models.tasks.sequence import TaskSequence


def routes(
    data: TaskSequence,
) -> tuple[LinearProgram, Names, Callable[[NDArray[np.float64]], Plain]]:
    """Return the program, its column names, and a function from column values to an answer.

    Parameters
    ----------
    data
        The data of the question.
    """
    ways, robots, tasks = every_way(data), data.robots, data.tasks
    builder = ProgramBuilder()
    store = np.vstack([data.stow_s, data.store_s])
    robot, begun = ways.first.T
    owner, place, task = ways.onward.T
    ender, end = ways.last.T
    bring = data.bring_s
    reach = data.reach_s[robot, begun] + bring[begun]
    drive = store[owner, place] + data.fetch_s[place, task] + bring[task]
    first = builder.columns(len(robot), cost=reach)
    onward = builder.columns(len(owner), cost=drive)
    last = builder.columns(len(ender), cost=store[ender, end])
    may_stay = np.isfinite(data.skip_s)
    left = builder.columns(tasks, cost=np.where(may_stay, data.skip_s, 0.0), upper=may_stay)
    horizon = _horizon(data, reach, drive)
    latest = np.minimum(data.latest_s, horizon)
    # a task that cannot be in its window has to be left
    arrive = builder.columns(
        tasks, lower=np.minimum(data.earliest_s, latest), upper=latest, integer=False
    )
    has_due = np.isfinite(data.due_s)
    late = builder.columns(
        tasks,
        cost=np.where(has_due, float(data.late_weight), 0.0),
        upper=np.where(has_due, horizon - np.minimum(np.where(has_due, data.due_s, 0.0), 0.0), 0.0),
        integer=False,
    )
    t = np.arange(tasks)
    # each task is begun once or left; each pod is stored once if its task is done
    builder.rows(tasks, (begun, first, 1), (task, onward, 1), (t, left, 1), lower=1, upper=1)
    served = np.zeros(robots + tasks)
    served[:robots] = data.carrying
    served[robots:] = 1.0
    builder.rows(
        robots + tasks,
        (owner, onward, 1),
        (ender, last, 1),
        (robots + t, left, 1),
        lower=served,
        upper=served,
    )
    builder.rows(robots, (robot, first, 1), upper=1)
    builder.rows(data.places, (place, onward, 1), (end, last, 1), upper=1)
    # what is never in time is left
    hopeless = (data.earliest_s > data.latest_s).astype(float)
    builder.rows(tasks, (t, left, 1), lower=hopeless)
    _times(builder, data, (first, robot, begun), (onward, owner, task), reach, drive, arrive)
    builder.rows(
        int(has_due.sum()),
        (np.arange(int(has_due.sum())), late[has_due], 1.0),
        (np.arange(int(has_due.sum())), arrive[has_due], -1.0),
        # a task that is left is never late
        (np.arange(int(has_due.sum())), left[has_due], 2.0 * horizon + np.abs(data.due_s[has_due])),
        lower=-data.due_s[has_due],
    )
    program = builder.build()
    names = Names(program.columns)
    names.block("first", first, "robot {r} begins with task {t}", r=robot, t=begun)
    names.block(
        "onward", onward, "owner {o} stores at {l}, then task {t}", o=owner, l=place, t=task
    )
    names.block("last", last, "owner {o} stores at {l}, then nothing", o=ender, l=end)
    names.block("leave", left, "place[{t}] = -1", t=t)
    names.block("arrive", arrive, t=t)
    names.block("late", late, t=t)

    def answer(x: NDArray[np.float64]) -> Plain:
        at = np.full(robots + tasks, -1)
        begins = {int(r): int(b) for r, b in ways.first[x[first] > 0.5]}
        follows = {}
        for o, one, b in ways.onward[x[onward] > 0.5].tolist():
            at[o], follows[o] = one, b
        for o, one in ways.last[x[last] > 0.5].tolist():
            at[o] = one
        found = []
        for r in range(robots):
            mine: list[int] = []
            next_ = follows.get(r) if data.carrying[r] else begins.get(r)
            while next_ is not None and next_ not in mine:
                mine.append(next_)
                next_ = follows.get(robots + next_)
            found.append(mine)
        return {"tasks": found, "place": at[robots:], "robot_place": at[:robots]}

    return program, names, answer


def _horizon(data: TaskSequence, reach: NDArray[np.float64], drive: NDArray[np.float64]) -> float:
    """Return a time by which any sensible plan ends, even if one robot does all tasks."""
    longest = float(max(reach.max(initial=0.0), drive.max(initial=0.0)))
    waits = float(data.ready_s.max(initial=0.0) + data.earliest_s.max(initial=0.0))
    return waits + data.tasks * longest + float(data.service_s.sum()) + longest


def _times(
    builder: ProgramBuilder,
    data: TaskSequence,
    first: tuple[NDArray[np.int64], ...],
    onward: tuple[NDArray[np.int64], ...],
    reach: NDArray[np.float64],
    drive: NDArray[np.float64],
    arrive: NDArray[np.int64],
) -> None:
    """Let no pod arrive before its robot can bring it."""
    column, robot, task = first
    row = np.arange(len(column))
    # at its begin a robot is alone: arrive >= ready + reach where it is the first
    earliest = data.ready_s[robot] + reach
    builder.rows(len(row), (row, arrive[task], 1.0), (row, column, -earliest), lower=0.0)
    column, owner, task = onward
    robots = data.robots
    from_robot = owner < robots
    some = np.flatnonzero(from_robot)
    earliest = data.ready_s[owner[some]] + drive[some]
    row = np.arange(len(some))
    builder.rows(
        len(row), (row, arrive[task[some]], 1.0), (row, column[some], -earliest), lower=0.0
    )
    some = np.flatnonzero(~from_robot)
    before = owner[some] - robots
    takes = data.service_s[before] + drive[some]
    # the time before is at most its upper bound, so that this M is enough
    program_upper = _upper(data, reach, drive, before)
    big = program_upper + takes
    row = np.arange(len(some))
    builder.rows(
        len(row),
        (row, arrive[task[some]], 1.0),
        (row, arrive[before], -1.0),
        (row, column[some], -big),
        lower=takes - big,
    )


def _upper(
    data: TaskSequence,
    reach: NDArray[np.float64],
    drive: NDArray[np.float64],
    task: NDArray[np.int64],
) -> NDArray[np.float64]:
    horizon = _horizon(data, reach, drive)
    upper: NDArray[np.float64] = np.minimum(data.latest_s, horizon)[task]
    return upper

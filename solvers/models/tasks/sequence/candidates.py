"""Arcs considered by a search: all arcs, or the shortest ones and those of a given plan."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rmfs.solvers.models.tasks.sequence.data import NONE, Routes, TaskSequence


@dataclass(frozen=True)
class Ways:
    """Arcs that routes may use.

    The *owner* of a pod to be stored is the robot that carries it initially, or the task that
    brings it to a station. Robot r has the owner number r; task t has R + t, where R is the number
    of robots.

    Attributes
    ----------
    first
        Arcs of robots without a pod to their first tasks, shape (A, 2): robot, task.
    onward
        Arcs from owners, via the place where the owner's pod is stored, to the pod of the next
        task, shape (B, 3): owner, place, task.
    last
        Arcs from owners to the place where the owner's pod is stored at the end of a route, shape
        (C, 2): owner, place.
    complete
        Whether all arcs of the problem are included.
    """

    first: NDArray[np.int64]
    onward: NDArray[np.int64]
    last: NDArray[np.int64]
    complete: bool


def every_way(data: TaskSequence) -> Ways:
    """Return all arcs of a problem.

    Parameters
    ----------
    data
        The problem.
    """
    first = np.argwhere(np.isfinite(_first_s(data)))
    store_s = _owners_s(data)
    last = np.argwhere(np.isfinite(store_s))
    fetches = np.isfinite(data.fetch_s)[last[:, 1]]
    row, task = np.nonzero(fetches)
    onward = np.column_stack([last[row], task])
    return Ways(first, _without_loops(data, onward), last, complete=True)


def short_ways(data: TaskSequence, keep: Routes, *, tasks: int, places: int) -> Ways:
    """Return the shortest arcs, together with the arcs of a plan, so that the plan stays feasible.

    A task may follow an owner (see `Ways`) if the task is among the tasks nearest to the owner or
    the owner is among the owners nearest to the task, by travel time via the best place. For each
    such pair, there is one arc for each of the best places. In the same way, a task may come first
    for a robot without a pod if the task is among the nearest to the robot or the robot is among
    the nearest to the task. A route may end at the places nearest to the station of its last task;
    a route without tasks may end at those nearest to the initial position of its robot.

    Parameters
    ----------
    data
        The problem.
    keep
        A plan.
    tasks
        Number of tasks, owners, or robots without a pod that count as nearest.
    places
        Number of places considered for each pair of owner and task, and for the end of each route.

    Returns
    -------
    The arcs, without duplicates, sorted by index.
    """
    first_s, store_s = _first_s(data), _owners_s(data)
    first = np.argwhere(_among_nearest(first_s, tasks) & np.isfinite(first_s))
    last = np.argwhere(_nearest(store_s, places) & np.isfinite(store_s))
    onward = [np.zeros((0, 3), np.int64)]
    via_s = shortest_over_places(store_s, data.fetch_s)
    pairs = _among_nearest(via_s, tasks) & np.isfinite(via_s)
    for owner in range(len(store_s)):
        after = np.flatnonzero(pairs[owner])
        over_s = store_s[owner] + data.fetch_s[:, after].T
        near = _nearest(over_s, places) & np.isfinite(over_s)
        which, place = np.nonzero(near)
        onward.append(np.column_stack([np.full(len(place), owner), place, after[which]]))
    kept_first, kept_onward, kept_last = _ways_of(data, keep)
    return Ways(
        np.unique(np.vstack([first, kept_first]), axis=0),
        _without_loops(data, np.unique(np.vstack([*onward, kept_onward]), axis=0)),
        np.unique(np.vstack([last, kept_last]), axis=0),
        complete=False,
    )


def shortest_over_places(
    to_place_s: NDArray[np.float64], from_place_s: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Return the travel times via the best place, computed row by row to save memory.

    Parameters
    ----------
    to_place_s
        Travel times to places, shape (M, L), in s.
    from_place_s
        Travel times from places, shape (L, N), in s.

    Returns
    -------
    Travel times via the best place, shape (M, N), in s; infinite if no place is possible.
    """
    shortest = np.full((len(to_place_s), from_place_s.shape[1]), np.inf)
    for row, way_s in enumerate(to_place_s):
        near = np.isfinite(way_s)
        both_s = way_s[near, np.newaxis] + from_place_s[near]
        shortest[row] = both_s.min(axis=0, initial=np.inf)
    return shortest


def _first_s(data: TaskSequence) -> NDArray[np.float64]:
    """Return the empty drives from robots without a pod, infinite for the others, shape (R, T)."""
    first_s: NDArray[np.float64] = np.where(data.carrying[:, np.newaxis], np.inf, data.reach_s)
    return first_s


def _owners_s(data: TaskSequence) -> NDArray[np.float64]:
    """Return the drives of owners with their pods to places, shape (R + T, L)."""
    stow_s = np.where(data.carrying[:, np.newaxis], data.stow_s, np.inf)
    return np.vstack([stow_s, data.store_s])


def _nearest(way_s: NDArray[np.float64], count: int) -> NDArray[np.bool_]:
    """Mark the shortest drives of each row; ties go to the lowest index."""
    order = np.argsort(way_s, axis=1, kind="stable")[:, :count]
    marked = np.zeros(way_s.shape, bool)
    np.put_along_axis(marked, order, values=True, axis=1)
    return marked


def _among_nearest(way_s: NDArray[np.float64], count: int) -> NDArray[np.bool_]:
    """Mark drives that are among the shortest of their row or of their column."""
    return _nearest(way_s, count) | _nearest(way_s.T, count).T


def _without_loops(data: TaskSequence, onward: NDArray[np.int64]) -> NDArray[np.int64]:
    """Remove arcs from a task to itself."""
    ways: NDArray[np.int64] = onward[onward[:, 0] != onward[:, 2] + data.robots]
    return ways


def _ways_of(
    data: TaskSequence, routes: Routes
) -> tuple[NDArray[np.int64], NDArray[np.int64], NDArray[np.int64]]:
    """Return the arcs that routes use, in the three tables of `Ways`."""
    first, onward, last = [], [], []
    for robot, tasks in enumerate(routes.tasks):
        owner, place = robot, int(routes.robot_place[robot])
        for task in tasks:
            if place == NONE:
                first.append((robot, task))
            else:
                onward.append((owner, place, task))
            owner, place = data.robots + task, int(routes.place[task])
        if place != NONE:
            last.append((owner, place))
    return (
        np.array(first, np.int64).reshape(-1, 2),
        np.array(onward, np.int64).reshape(-1, 3),
        np.array(last, np.int64).reshape(-1, 2),
    )

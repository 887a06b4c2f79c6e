"""Exact programs of questions that optimisers solve as assignments or flows, or with Clarabel."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from rmfs.solvers.decisions.schema import Plain
from rmfs.solvers.models.names import Names
from rmfs.solvers.models.program import LinearProgram, ProgramBuilder

if TYPE_CHECKING:
    from rmfs.solvers.models.storage.placement import Placement
    from rmfs.solvers.models.storage.zones import Zones
    from rmfs.solvers.models.tasks.balance import Balance
    from rmfs.solvers.models.tasks.matching import Matching

Reals = NDArray[np.float64]
Stated = tuple[LinearProgram, Names, Callable[[Reals], Plain]]


def placement(data: Placement) -> Stated:
    """Return the program that assigns one place to each pod, and at most one pod to each place."""
    cost = data.cost_s
    pods, places = cost.shape
    allowed = np.isfinite(cost)
    builder = ProgramBuilder()
    x = builder.columns(cost.shape, cost=np.where(allowed, cost, 0.0), upper=allowed)
    pod, place = np.arange(pods)[:, np.newaxis], np.arange(places)
    builder.rows(pods, (pod, x, 1.0), lower=1.0, upper=1.0)
    builder.rows(places, (place, x, 1.0), upper=1.0)
    program = builder.build()
    names = Names(program.columns)
    names.block("store", x, "place[{p}] = {l}", p=pod, l=place)

    def answer(values: Reals) -> Plain:
        return {"place": values[x].argmax(axis=1) if places else np.full(pods, -1)}

    return program, names, answer


def matching(data: Matching) -> Stated:
    """Return the program that assigns robots to tasks.

    Each robot does at most one task, and each task is done by at most one robot.
    """
    builder = ProgramBuilder()
    x, left = _robots(builder, data)
    return _named(builder, x, left)


def balance(data: Balance) -> Stated:
    """Return the program of `matching` with additional costs of waiting in queues.

    The k-th robot sent to a station waits for the pods already there or on their way, and for the
    k - 1 robots sent before it.
    """
    builder = ProgramBuilder()
    x, left = _robots(builder, data.pairs)
    stations = len(data.room)
    most = np.minimum(data.room, np.bincount(data.station, minlength=stations))
    of = np.repeat(np.arange(stations), most)
    rank = np.arange(len(of)) - np.repeat(np.cumsum(most) - most, most)
    seat = builder.columns(len(of), cost=(data.queue[of] + rank) * data.service_s[of])
    builder.rows(stations, (data.station, x, 1.0), (of, seat, -1.0), lower=0.0, upper=0.0)
    stated = _named(builder, x, left)
    stated[1].block("seat", seat, s=of, k=rank)
    return stated


def _robots(builder: ProgramBuilder, data: Matching) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    cost = data.travel_s
    robots, tasks = cost.shape
    allowed, may_stay = np.isfinite(cost), np.isfinite(data.leave_s)
    x = builder.columns(cost.shape, cost=np.where(allowed, cost, 0.0), upper=allowed)
    left = builder.columns(tasks, cost=np.where(may_stay, data.leave_s, 0.0), upper=may_stay)
    robot, task = np.arange(robots)[:, np.newaxis], np.arange(tasks)
    builder.rows(tasks, (task, x, 1.0), (task, left, 1.0), lower=1.0, upper=1.0)
    builder.rows(robots, (robot, x, 1.0), upper=1.0)
    return x, left


def _named(builder: ProgramBuilder, x: NDArray[np.int64], left: NDArray[np.int64]) -> Stated:
    program = builder.build()
    names = Names(program.columns)
    robot, task = np.arange(len(x))[:, np.newaxis], np.arange(len(left))
    names.block("send", x, "robot[{t}] = {r}", r=robot, t=task)
    names.block("leave", left, "robot[{t}] = -1", t=task)

    def answer(values: Reals) -> Plain:
        sent = values[x] > 0.5
        if not len(x):
            return {"robot": np.full(len(left), -1)}
        return {"robot": np.where(sent.any(axis=0), sent.argmax(axis=0), -1)}

    return program, names, answer


def zones(data: Zones) -> tuple[LinearProgram, Names, Callable[[Reals], Plain], Reals]:
    """Return the program that distributes pods over zones.

    The last returned value contains the cost coefficients of the squares of the columns, as the
    cost includes the square of each zone's traffic.
    """
    classes, count = data.visit_s.shape
    builder = ProgramBuilder()
    rate = data.rate_per_h[:, np.newaxis]
    most = data.pods[:, np.newaxis]
    x = builder.columns((classes, count), cost=rate * data.visit_s, upper=most, integer=False)
    reach = float((data.rate_per_h * data.pods).sum())
    traffic = builder.columns(count, upper=reach, integer=False)
    kind, zone = np.arange(classes)[:, np.newaxis], np.arange(count)
    builder.rows(classes, (kind, x, 1.0), lower=data.pods, upper=data.pods)
    builder.rows(count, (zone, x, 1.0), upper=data.places)
    builder.rows(count, (zone, x, rate), (zone, traffic, -1.0), lower=0.0, upper=0.0)
    program = builder.build()
    square = np.zeros(program.columns)
    square[traffic] = data.congestion_s_h
    names = Names(program.columns)
    names.block("standing", x, "standing[{i}, {j}]", i=kind, j=zone)
    names.block("traffic", traffic, j=zone)

    def answer(values: Reals) -> Plain:
        from rmfs.solvers.models.storage.zones.repair import repaired

        # solvers are off by their tolerance; every pod must stand somewhere
        standing = repaired(data, np.maximum(values[x], 0.0))
        return {"standing": standing, "price_per_h": np.zeros(count)}

    return program, names, answer, square

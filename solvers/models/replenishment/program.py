r"""Replenishment as an integer program.

Bundles go to pods (x) or are left (l), pods go to stations (y), and the load of a pod counts at its
station (w):

.. math::

    \sum_p x_{bp} + l_b = 1, \quad x_{bp} \le \sum_s y_{ps} \le 1, \quad
    \sum_b space_b\, x_{bp} \le \sum_s w_{ps}, \\
    w_{ps} \le \min(podspace_p, stationspace_s)\, y_{ps}, \quad \sum_p w_{ps} \le stationspace_s

An equivalent program without w would give x a third index s, which would multiply the number of
columns x by the number of stations. Spaces are counted in sixteenths of a space unit, so all
numbers except the costs are integers.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rmfs.solvers.models.backends.backend import Formulation
from rmfs.solvers.models.names import Names
from rmfs.solvers.models.program import LinearProgram, ProgramBuilder
from rmfs.solvers.models.replenishment.data import (
    LEFT,
    PARTS,
    Replenishment,
    Stocking,
    objective,
    violations,
)


@dataclass(frozen=True)
class Columns:
    """The columns of the program, in the order x, y, w, l.

    Attributes
    ----------
    bundle, pod
        Bundle and pod of each column x, shape (X,).
    brought, station
        Pod and station of each column y; the columns w have the same pairs in the same order; shape
        (Y,).
    """

    bundle: NDArray[np.int64]
    pod: NDArray[np.int64]
    brought: NDArray[np.int64]
    station: NDArray[np.int64]

    @classmethod
    def of(cls, data: Replenishment) -> Columns:
        """Return the columns for all allowed pairs of bundle and pod, and of pod and station.

        Parameters
        ----------
        data
            The problem.
        """
        allowed = np.isfinite(data.worth_s) & (data.space[:, np.newaxis] <= data.pod_space)
        allowed &= np.isfinite(data.trip_s).any(axis=1)
        wanted = np.zeros(len(data.pod_space), bool)
        bundle, pod = np.nonzero(allowed)
        wanted[pod] = True
        brought, station = np.nonzero(np.isfinite(data.trip_s) & wanted[:, np.newaxis])
        return cls(bundle, pod, brought, station)


def program(data: Replenishment, columns: Columns, *, whole: bool) -> LinearProgram:
    """Formulate the problem in matrix form.

    Parameters
    ----------
    data
        The problem.
    columns
        The columns of the program.
    whole
        Whether the loads w must be integers. This does not change the optimum, because integer
        loads exist for all feasible integer x and y. CP-SAT requires integer loads; branch and
        bound is ten times as fast without this requirement.
    """
    bundles, (pods, stations) = len(data.space), data.trip_s.shape
    bundle, pod, brought, station = columns.bundle, columns.pod, columns.brought, columns.station
    must = np.isinf(data.leave_s)
    space = data.space * PARTS
    room = np.minimum(data.pod_space[brought], data.station_space[station]) * PARTS
    builder = ProgramBuilder()
    x = builder.columns(len(bundle), cost=-data.worth_s[bundle, pod])
    y = builder.columns(len(brought), cost=data.trip_s[brought, station])
    w = builder.columns(len(brought), upper=room, integer=whole)
    left = builder.columns(bundles, cost=np.where(must, 0.0, data.leave_s), upper=~must)

    builder.rows(bundles, (bundle, x, 1.0), (np.arange(bundles), left, 1.0), lower=1.0, upper=1.0)
    pair, option = _meet(pod, brought)
    builder.rows(len(bundle), (np.arange(len(bundle)), x, 1.0), (pair, y[option], -1.0), upper=0.0)
    builder.rows(pods, (brought, y, 1.0), upper=1.0)
    builder.rows(pods, (pod, x, space[bundle]), (brought, w, -1.0), upper=0.0)
    each = np.arange(len(brought))
    builder.rows(len(brought), (each, w, 1.0), (each, y, -room), upper=0.0)
    builder.rows(stations, (station, w, 1.0), upper=data.station_space * PARTS)
    return builder.build()


def _meet(
    pod: NDArray[np.int64], brought: NDArray[np.int64]
) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """List the pairs (index into `pod`, index into `brought`) of the same pod."""
    # options are sorted by pod, so those of a pod are a range
    begin = np.searchsorted(brought, pod, side="left")
    count = np.searchsorted(brought, pod, side="right") - begin
    pair = np.repeat(np.arange(len(pod)), count)
    option = np.arange(len(pair)) - np.repeat(np.cumsum(count) - count, count)
    return pair, option + np.repeat(begin, count)


def columns_of(data: Replenishment, columns: Columns, stocking: Stocking) -> NDArray[np.float64]:
    """Turn a stocking into column values of the program.

    Parameters
    ----------
    data
        The problem.
    columns
        The columns of the program.
    stocking
        The pod of each bundle and the station of each pod.
    """
    stored = stocking.pod != LEFT
    load = np.bincount(
        stocking.pod[stored], weights=data.space[stored] * PARTS, minlength=len(data.pod_space)
    )
    chosen = stocking.station[columns.brought] == columns.station
    x = stocking.pod[columns.bundle] == columns.pod
    w = np.where(chosen, load[columns.brought], 0.0)
    return np.concatenate([x, chosen, w, ~stored]).astype(np.float64)


def stocking_of(data: Replenishment, columns: Columns, x: NDArray[np.float64]) -> Stocking:
    """Turn column values of the program into a stocking.

    Pods without a bundle are not brought, even if the column values bring them.

    Parameters
    ----------
    data
        The problem.
    columns
        The columns of the program.
    x
        The value of each column.
    """
    pairs = len(columns.bundle)
    stored = x[:pairs] > 0.5
    chosen = x[pairs : pairs + len(columns.brought)] > 0.5
    pod = np.full(len(data.space), LEFT, np.int64)
    station = np.full(len(data.pod_space), LEFT, np.int64)
    pod[columns.bundle[stored]] = columns.pod[stored]
    station[columns.brought[chosen]] = columns.station[chosen]
    empty = np.ones(len(station), bool)
    empty[pod[pod != LEFT]] = False
    station[empty] = LEFT
    return Stocking(pod, station)


def formulate(data: Replenishment, *, whole: bool) -> Formulation[Stocking]:
    """Formulate the problem as a mixed-integer program.

    Parameters
    ----------
    data
        The problem.
    whole
        Whether the loads w must be integers, too, as some solvers require (see `program`).
    """
    columns = Columns.of(data)
    return Formulation(
        program(data, columns, whole=whole),
        lambda stocking: columns_of(data, columns, stocking),
        lambda x: stocking_of(data, columns, x),
        lambda stocking: objective(data, stocking),
        lambda stocking: violations(data, stocking),
        lambda names: _name(columns, names),
    )


def _name(columns: Columns, names: Names) -> None:
    pairs, options = len(columns.bundle), len(columns.brought)
    x, y, w, left = np.split(
        np.arange(len(names.name)), [pairs, pairs + options, pairs + 2 * options]
    )
    names.block("store", x, "pod[{b}] = {p}", b=columns.bundle, p=columns.pod)
    names.block("bring", y, "station[{p}] = {s}", p=columns.brought, s=columns.station)
    names.block("load", w, p=columns.brought, s=columns.station)
    names.block("left", left, "pod[{b}] = -1", b=np.arange(len(left)))

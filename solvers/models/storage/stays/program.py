r"""The integer program, in which the number of pods in each zone is carried over between periods.

.. math::

    y_{zt} = y_{z,t-1} + \sum_{s \text{ begins in } t} x_{sz}
    - \sum_{s \text{ is over in } t} x_{sz}, \qquad 0 \le y_{zt} \le k_z

where :math:`x_{sz}` is 1 if stay s is in zone z, and :math:`y_{zt}` is the number of pods in zone z
in period t (`Stays.periods`); a stay *is over* in the first period after its last one. Each zone
could instead have one constraint per maximal set of simultaneous stays. The rows above are
equivalent, but the number of their nonzeros grows linearly with the number of stays, not
quadratically. The rows of a single zone form a network matrix, so the relaxation is strong.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from rmfs.solvers.models.backends.backend import Formulation
from rmfs.solvers.models.names import Names
from rmfs.solvers.models.program import LinearProgram, ProgramBuilder
from rmfs.solvers.models.storage.stays.data import Stays, objective, violations


def program(data: Stays, *, whole: bool) -> LinearProgram:
    """Formulate the problem in matrix form.

    Parameters
    ----------
    data
        The problem.
    whole
        Whether y is declared integer. CP-SAT requires the declaration. Branch and bound does not,
        because y is integer whenever x is.

    Returns
    -------
    The program, whose first S * Z columns are x, stay by stay.
    """
    stays, zones = data.cost_s.shape
    first, last, periods = data.periods
    allowed = np.isfinite(data.cost_s)
    builder = ProgramBuilder()
    x = builder.columns((stays, zones), cost=np.where(allowed, data.cost_s, 0.0), upper=allowed)
    y = builder.columns((zones, periods), upper=data.capacity[:, np.newaxis], integer=whole)
    builder.rows(stays, (np.arange(stays)[:, np.newaxis], x, 1.0), lower=1.0, upper=1.0)
    count = np.arange(zones * periods).reshape(zones, periods)
    over = last < periods
    builder.rows(
        zones * periods,
        (count, y, 1.0),
        (count[:, 1:], y[:, :-1], -1.0),
        (count[:, first].T, x, -1.0),
        (count[:, last[over]].T, x[over], 1.0),
        lower=0.0,
        upper=0.0,
    )
    return builder.build()


def columns_of(data: Stays, zone: NDArray[np.int64]) -> NDArray[np.float64]:
    """Turn a choice of zones into column values of the program.

    Parameters
    ----------
    data
        The problem.
    zone
        Zone of each stay, shape (S,).
    """
    chosen = np.zeros(data.cost_s.shape)
    chosen[np.arange(len(zone)), zone] = 1.0
    present = [data.present(zone, each) for each in range(len(data.capacity))]
    return np.concatenate([chosen.ravel(), *(each.astype(np.float64) for each in present)])


def zones_of(data: Stays, x: NDArray[np.float64]) -> NDArray[np.int64]:
    """Turn column values of the program into a choice of zones.

    Parameters
    ----------
    data
        The problem.
    x
        The column values.
    """
    if not data.cost_s.size:
        return np.zeros(0, np.int64)
    chosen = x[: data.cost_s.size].reshape(data.cost_s.shape)
    zone: NDArray[np.int64] = chosen.argmax(axis=1)
    return zone


def formulate(data: Stays, *, whole: bool) -> Formulation[NDArray[np.int64]]:
    """Formulate the problem as an integer program.

    Parameters
    ----------
    data
        The problem.
    whole
        Whether the solver requires all columns to be integer.
    """
    return Formulation(
        program(data, whole=whole),
        lambda zone: columns_of(data, zone),
        lambda x: zones_of(data, x),
        lambda zone: objective(data, zone),
        lambda zone: violations(data, zone),
        lambda names: _name(data, names),
    )


def _name(data: Stays, names: Names) -> None:
    stays, zones = data.cost_s.shape
    x, y = np.split(np.arange(len(names.name)), [stays * zones])
    stay, zone = np.arange(stays)[:, np.newaxis], np.arange(zones)
    names.block("stay", x.reshape(stays, zones), "zone[{n}] = {z}", n=stay, z=zone)
    if y.size:
        y = y.reshape(zones, -1)
        names.block("present", y, z=zone[:, np.newaxis], t=np.arange(y.shape[1]))

r"""The linear program behind the proven bound; each of its inequalities holds for every run.

A *pick* occupies station s for :math:`\tau_s` and the robot for :math:`\pi_s` seconds from its
start. A *visit* is a stay of a pod at the head of a station's queue; it counts if a pick (at a
replenishment station: the storing of a bundle) starts during the visit and in the window
:math:`[0, H]`. :math:`n_s` units and :math:`v_s` visits are counted at pick station s, :math:`m_q`
bundles and :math:`z_q` visits at replenishment station q. With :math:`a_s = \max(\tau_s, \pi_s)`
and :math:`b_s = \max(\tau_s, \pi_s + c_s)`, where :math:`c_s` is the least changeover:

1. :math:`a_s n_s + (b_s - a_s) v_s \le H + b_s`. Picks of one visit start at least :math:`a_s`
   apart; the last pick of a visit and the first pick of the next visit start at least :math:`b_s`
   apart. All :math:`n_s - 1` gaps, :math:`v_s - 1` of them between visits, fit between 0 and H.
2. :math:`n_s \le \lfloor H / a_s \rfloor + 1`, for the same reason and because units are whole.
3. :math:`v_s \le n_s \le u_s v_s`: a visit that counts has at least one unit and at most
   :math:`u_s` units (see `RunBound.visit_units`).
4. :math:`m_q \le z_q B`, and :math:`\beta_q m_q \le H + \beta_q`: a visit stores at most B bundles,
   and a bundle occupies its station for :math:`\beta_q`.
5. Robots: :math:`\sum_s [a_s n_s + (w_s + \pi_s - a_s) v_s] + \sum_q [\beta_q m_q + w_q z_q] \le
   R\,(H + E)` with R robots. A visit with k units holds its robot for at least :math:`(k - 1) a_s
   + \pi_s`, one with k bundles for :math:`k \beta_q`. Each visit needs a drive in and a drive out,
   which together take at least :math:`w_s` or :math:`w_q` seconds (`visit_legs` divides a drive
   between two stations into halves, so nothing counts twice). Of these times, only the drive in of
   a robot's first visit, and the last service and the drive out of its last visit, can lie outside
   the window: at most E seconds per robot (`RunBound.end_effect_s`).
6. Content: :math:`\sum_s n_s \le \sum_p K_p y_p + g \sum_q m_q`, :math:`0 \le y_p \le 1`,
   :math:`\sum_p y_p \le \sum_s v_s`, where :math:`y_p` is 1 if units are picked from pod p. A unit
   picked in the window was in its pod p at the start (one of at most :math:`K_p`) or has come since
   in a bundle of at most g units; and there are no more pods with picks than visits. Integrality of
   :math:`y_p` is relaxed.
7. Demand: :math:`\sum_s n_s \le D`, the number of units asked for.
8. Slots: :math:`n_s \le l_s + U C_s (v_s + 1)`, :math:`\sum_s l_s \le L`. An order is *lone* if one
   visit serves it whole, otherwise *spread*. Of the :math:`n_s` units, :math:`l_s` go to lone
   orders, which have at most L units in total. A spread order served in a visit was open when the
   visit began or is still open when it ends, so a visit serves at most :math:`2 C_s` of them, with
   :math:`C_s` slots. Each spread order is served in at least two visits within the window, unless
   an end of the window cuts it off, which happens to at most :math:`C_s` orders at each end. So
   there are no more than :math:`C_s (v_s + 1)` spread orders, of at most U units each.

So the counts of every run are a feasible point, and the units picked in the run are at most the
optimum. The reported bound is not the optimum found by a solver but the dual value of the solver's
multipliers after a repair that makes them dual feasible. This value is rounded up, and no solver
error can push it below the optimum.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rmfs.solvers.models.program import LinearProgram, ProgramBuilder
from rmfs.solvers.models.run_bound.data import RunBound, Throughput

_ROUNDING = 1e-9
"""Relative amount that is added to a quotient of times before the quotient is rounded down."""


@dataclass(frozen=True)
class Columns:
    """Column indices: per pick station, per replenishment station and per distinct pod content."""

    units: NDArray[np.int64]
    visits: NDArray[np.int64]
    lone_units: NDArray[np.int64]
    bundles: NDArray[np.int64]
    refill_visits: NDArray[np.int64]
    pods: NDArray[np.int64]


def violations(data: RunBound, values: Throughput) -> list[str]:
    """Return a list with one message if the counts violate any inequality, otherwise an empty list.

    The counts of every simulated run must satisfy all inequalities.

    Parameters
    ----------
    data
        The warehouse.
    values
        The counts in the window.
    """
    linear, columns = program(data)
    x = np.zeros(linear.columns)
    x[columns.units], x[columns.visits] = values.units, values.visits
    x[columns.lone_units] = values.lone_units
    x[columns.bundles], x[columns.refill_visits] = values.bundles, values.refill_visits
    # the fullest pods are the ones visited: that is the most the contents allow
    pods = linear.upper[columns.pods]
    before = np.cumsum(pods) - pods
    x[columns.pods] = np.clip(values.visits.sum() - before, 0.0, pods)
    broken = linear.violation(x) > _ROUNDING * max(1.0, data.duration_s * max(1, data.robots))
    return ["no run can reach these counts"] if broken else []


def program(data: RunBound) -> tuple[LinearProgram, Columns]:
    """Formulate the inequalities of the module's docstring.

    Parameters
    ----------
    data
        The warehouse.

    Returns
    -------
    The program, which minimises the negative of the number of units, and its columns.
    """
    builder = ProgramBuilder()
    columns = _columns(builder, data)
    _limit_pick_stations(builder, columns, data)
    _limit_robots(builder, columns, data)
    _limit_stock(builder, columns, data)
    _limit_orders(builder, columns, data)
    return builder.build(), columns


def _limit_pick_stations(builder: ProgramBuilder, columns: Columns, data: RunBound) -> None:
    """Rows 1 and 3; row 2 is in the columns' upper bounds."""
    cadence, change = data.picking.cadence_s, data.picking.change_s
    n, v, s = columns.units, columns.visits, np.arange(len(cadence))
    builder.rows(len(s), (s, n, cadence), (s, v, change - cadence), upper=data.duration_s + change)
    builder.rows(len(s), (s, v, 1.0), (s, n, -1.0), upper=0.0)
    builder.rows(len(s), (s, n, 1.0), (s, v, -data.visit_units), upper=0.0)


def _limit_robots(builder: ProgramBuilder, columns: Columns, data: RunBound) -> None:
    """Row 5, for all robots together."""
    picking, refill = data.picking, data.refill
    once_s = picking.inbound_s + picking.outbound_s + picking.unit_pick_s - picking.cadence_s
    builder.rows(
        1,
        (0, columns.units, picking.cadence_s),
        (0, columns.visits, once_s),
        (0, columns.bundles, refill.bundle_transfer_s),
        (0, columns.refill_visits, refill.inbound_s + refill.outbound_s),
        upper=data.robots * (data.duration_s + data.end_effect_s),
    )


def _limit_stock(builder: ProgramBuilder, columns: Columns, data: RunBound) -> None:
    """Rows 4 and 6; the time of the replenishment stations is in the columns' upper bounds."""
    n, v, m, y = columns.units, columns.visits, columns.bundles, columns.pods
    q = np.arange(len(m))
    most = -float(data.refill.bundles_per_visit)
    builder.rows(len(q), (q, m, 1.0), (q, columns.refill_visits, most), upper=0.0)
    content, bundle = -_contents(data)[0], -float(data.refill.bundle_units)
    builder.rows(1, (0, n, 1.0), (0, y, content), (0, m, bundle), upper=0.0)
    builder.rows(1, (0, y, 1.0), (0, v, -1.0), upper=0.0)


def _limit_orders(builder: ProgramBuilder, columns: Columns, data: RunBound) -> None:
    """Rows 7 and 8, where they say anything."""
    orders, n = data.orders, columns.units
    if math.isfinite(orders.units):
        builder.rows(1, (0, n, 1.0), upper=orders.units)
    if math.isfinite(orders.lone_units) and math.isfinite(orders.largest_order_units):
        s, lone = np.arange(len(n)), columns.lone_units
        spread = data.picking.order_slots * orders.largest_order_units
        builder.rows(
            len(s), (s, n, 1.0), (s, lone, -1.0), (s, columns.visits, -spread), upper=spread
        )
        builder.rows(1, (0, lone, 1.0), upper=orders.lone_units)


def _columns(builder: ProgramBuilder, data: RunBound) -> Columns:
    """Make the columns with the largest values they can have."""
    picking, refill = data.picking, data.refill
    works = (picking.order_slots > 0) & (data.robots > 0) & (len(data.stock.pod_units) > 0)
    units = np.where(works, _at_most(data.duration_s, picking.cadence_s), 0.0)
    bundles = _at_most(data.duration_s, refill.bundle_transfer_s)
    n = builder.columns(len(units), cost=-1.0, upper=units, integer=False)
    v = builder.columns(len(units), upper=units, integer=False)
    lone = builder.columns(len(units), upper=units, integer=False)
    m = builder.columns(len(bundles), upper=bundles, integer=False)
    z = builder.columns(len(bundles), upper=bundles, integer=False)
    counts = _contents(data)[1]
    return Columns(n, v, lone, m, z, builder.columns(len(counts), upper=counts, integer=False))


def _at_most(duration_s: float, each_s: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return how many times that are so far apart fit into the window."""
    whole: NDArray[np.float64] = np.floor(duration_s / each_s * (1.0 + _ROUNDING)) + 1.0
    return whole


def _contents(data: RunBound) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return the different contents of pods, fullest first, and how many pods have each."""
    content, count = np.unique(data.stock.pod_units, return_counts=True)
    return content[::-1].astype(np.float64), count[::-1].astype(np.float64)

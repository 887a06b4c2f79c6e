r"""The linear program for the bound on units per hour; its inequalities hold for every run.

A *pick* at station s occupies the station for at least :math:`\tau_s` seconds and the robot for at
least :math:`\pi_s` seconds, both from the start of the pick. A *visit* is a stay of a pod at the
head of a station's queue. A visit counts if a pick (at a replenishment station: the storing of a
bundle) starts during the visit and in the window :math:`[0, H]`. The counts are :math:`n_s` units
and :math:`v_s` visits at pick station s, and :math:`m_q` bundles and :math:`z_q` visits at
replenishment station q. Let :math:`c_s` be the least changeover time from one pod to the next,
:math:`a_s = \max(\tau_s, \pi_s)` and :math:`b_s = \max(\tau_s, \pi_s + c_s)`, all in seconds. The
inequalities are:

1. :math:`a_s n_s + (b_s - a_s) v_s \le H + b_s`. Picks of one visit start at least :math:`a_s`
   apart; the last pick of a visit and the first pick of the next visit start at least :math:`b_s`
   apart. The :math:`n_s - 1` gaps between picks, of which :math:`v_s - 1` are gaps between visits,
   together fit into the window.
2. :math:`n_s \le \lfloor H / a_s \rfloor + 1`, for the same reason and because units are whole.
3. :math:`v_s \le n_s \le u_s v_s`: at least one unit and at most :math:`u_s` units (see
   `RunBound.visit_units`) are picked in a visit that counts.
4. :math:`m_q \le z_q B`, and :math:`\beta_q m_q \le H + \beta_q`: a visit stores at most B bundles,
   and a bundle occupies the station and the robot for at least :math:`\beta_q` seconds.
5. Robots: :math:`\sum_s [a_s n_s + (w_s + \pi_s - a_s) v_s] + \sum_q [\beta_q m_q + w_q z_q] \le
   R\,(H + E)` with R robots. A visit with k units occupies its robot for at least :math:`(k - 1)
   a_s + \pi_s` seconds, and a visit with k bundles for at least :math:`k \beta_q` seconds. Each
   visit needs a drive to the station and a drive away from it, which together take at least
   :math:`w_s` or :math:`w_q` seconds. (Half of a drive between two stations is charged to each of
   the two visits, so nothing counts twice; see `visit_legs`.) For each robot, at most E seconds of
   these times lie outside the window: the drive to its first visit, the last service of its last
   visit, and the drive away from that visit (`RunBound.end_effect_s`).
6. Content: :math:`\sum_s n_s \le \sum_p K_p y_p + g \sum_q m_q`, :math:`0 \le y_p \le 1`,
   :math:`\sum_p y_p \le \sum_s v_s`, where :math:`y_p` is 1 if units are picked from pod p. Each
   unit picked from pod p either was there at the start of the window, as one of at most
   :math:`K_p` units, or was stored later, in a bundle of at most g units. There are at least as
   many visits as pods from which units are picked. Integrality of :math:`y_p` is relaxed.
7. Demand: :math:`\sum_s n_s \le D`, the number of units ordered.
8. Slots: :math:`n_s \le l_s + U C_s (v_s + 1)`, :math:`\sum_s l_s \le L`, where :math:`C_s` is the
   number of order slots. An order is *lone* if one visit serves it whole, otherwise *spread*. Of
   the :math:`n_s` units, :math:`l_s` go to lone orders, which have at most L units in total. A
   spread order that is served in a visit is open when the visit begins or when the visit ends, so
   a visit serves at most :math:`2 C_s` spread orders. Each spread order is served in at least two
   visits in the window, except for at most :math:`C_s` orders that are open when the window begins
   and at most :math:`C_s` orders that are open when it ends. So there are at most :math:`C_s (v_s +
   1)` spread orders, of at most U units each.

Therefore the counts of every run are a feasible point, and the number of units picked in the run is
at most the optimum. The reported bound is not the optimum found by the solver. It is the dual value
of the solver's multipliers, which are first repaired so that they are dual feasible. This value is
rounded up, so no error of the solver can push it below the optimum.
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
    """Indices of the columns of the program.

    Attributes
    ----------
    units, visits, lone_units
        Columns n, v and l, one per pick station each.
    bundles, refill_visits
        Columns m and z, one per replenishment station each.
    pods
        Columns y, one per distinct content of pods; the upper bound of a column is the number of
        pods with this content.
    """

    units: NDArray[np.int64]
    visits: NDArray[np.int64]
    lone_units: NDArray[np.int64]
    bundles: NDArray[np.int64]
    refill_visits: NDArray[np.int64]
    pods: NDArray[np.int64]


def violations(data: RunBound, values: Throughput) -> list[str]:
    """Return one message if the counts violate any inequality, otherwise an empty list.

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
    """Formulate the linear program that the module docstring describes.

    Parameters
    ----------
    data
        The warehouse.

    Returns
    -------
    The program, which minimises minus the number of units picked, and the indices of its columns.
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
    """Rows 7 and 8, if their limits are finite."""
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
    """Return how many events fit into the window if they are at least `each_s` apart."""
    whole: NDArray[np.float64] = np.floor(duration_s / each_s * (1.0 + _ROUNDING)) + 1.0
    return whole


def _contents(data: RunBound) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return the different contents of pods, fullest first, and how many pods have each."""
    content, count = np.unique(data.stock.pod_units, return_counts=True)
    return content[::-1].astype(np.float64), count[::-1].astype(np.float64)

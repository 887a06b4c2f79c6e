"""Bounds on units per hour from single resources: weaker than the linear program, but simpler."""

from __future__ import annotations

import math

import numpy as np

from rmfs.solvers.models.run_bound.data import RunBound


def single_bounds(data: RunBound) -> dict[str, float]:
    r"""Return upper bounds on the units per hour, each from a single resource.

    The symbols are those of the module `program`. The number of units picked in the window is at
    most

    - ``stations``: :math:`\sum_s (H / a_s + 1)`, as if stations never waited for a pod;
    - ``robots``: :math:`R (H + E) / \min_s (a_s + (w_s + \pi_s - a_s) / u_s)`, as if all visits
      went to the station with the least robot time per unit and had the largest possible pile-on
      :math:`u_s`; for a station at which a visit with a single unit takes less robot time per unit,
      the term in the minimum is :math:`w_s + \pi_s`;
    - ``demand``: the number of units ordered.

    Parameters
    ----------
    data
        The warehouse.

    Returns
    -------
    The bounds by name, converted to units per hour. Up to rounding, none is below the bound of the
    linear program.
    """
    picking = data.picking
    cadence = picking.cadence_s
    stations = float((data.duration_s / cadence + 1.0).sum())
    visit_s = picking.inbound_s + picking.outbound_s + picking.unit_pick_s
    largest = data.visit_units
    worth_it = largest > 0
    if not worth_it.any():
        return {"stations": 0.0, "robots": 0.0, "demand": data.orders.units / data.hours}
    full = cadence + (visit_s - cadence) / np.maximum(largest, 1.0)
    # a visit of one unit can cost less robot time per unit than a long one
    per_unit_s = float(np.minimum(full, visit_s)[worth_it].min())
    time_s = data.robots * (data.duration_s + data.end_effect_s)
    robots = time_s / per_unit_s if per_unit_s > 0 else math.inf
    each = {"stations": stations, "robots": robots, "demand": data.orders.units}
    return {name: units / data.hours for name, units in each.items()}

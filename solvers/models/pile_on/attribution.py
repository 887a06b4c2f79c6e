"""Which pod supplies which units: the step from aggregate supply to reservations.

The models only ask that the pods of a station together hold what its orders take (as M1G does; the
attribution follows greedily). Because that holds per station and SKU, serving the lines one after
the other from the pods one after the other always works out.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from rmfs.solvers.models.pile_on.data import Integers, PileOn
from rmfs.solvers.models.pile_on.values import Assignment, uncovered


@dataclass(frozen=True)
class Picks:
    """Units of a pod for a line, one row per pair; no line is split over pods without need.

    Parameters
    ----------
    line, pod, units
        Arrays of equal length, sorted by line, then by turn of the pods.
    """

    line: Integers
    pod: Integers
    units: Integers


def attribute(data: PileOn, values: Assignment) -> Picks:
    """Give every covered line its units.

    Pods on their way come before called ones, and within each kind the pod with most units left of
    the SKU comes first. What inbound pods bring for orders already at the station stays for those.

    Parameters
    ----------
    data
        The input.
    values
        A feasible decision.

    Returns
    -------
    The picks; they add up to the units of every covered line.
    """
    station = np.maximum(data.inbound, values.pod_station)
    left = data.stock.copy()
    # Open demand that the decision covers is set aside first.
    kept = data.open_units - uncovered(data, values)
    for at, sku in np.argwhere(kept > 0).tolist():
        _take(data, left, np.flatnonzero(station == at), sku, int(kept[at, sku]))
    rows: list[tuple[int, int, int]] = []
    for line in np.flatnonzero(values.line_station >= 0).tolist():
        pods = np.flatnonzero(station == values.line_station[line])
        picks = _take(data, left, pods, int(data.line_sku[line]), int(data.line_units[line]))
        rows += [(line, pod, units) for pod, units in picks]
    table = np.array(rows, dtype=np.int64).reshape(-1, 3)
    return Picks(table[:, 0], table[:, 1], table[:, 2])


def _take(
    data: PileOn, left: Integers, pods: Integers, sku: int, units: int
) -> list[tuple[int, int]]:
    """Take units of a SKU from pods: inbound first, then most left, then index."""
    order = np.lexsort((pods, -left[pods, sku], data.inbound[pods] < 0))
    taken = []
    for pod in pods[order].tolist():
        part = min(units, int(left[pod, sku]))
        if part:
            left[pod, sku] -= part
            units -= part
            taken.append((pod, part))
    return taken

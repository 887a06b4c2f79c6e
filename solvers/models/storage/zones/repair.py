"""Make an almost feasible plan feasible."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from rmfs.solvers.models.storage.zones.data import Zones


def repaired(data: Zones, standing: NDArray[np.float64]) -> NDArray[np.float64]:
    """Turn an almost feasible table of pods per class and zone into an exactly feasible one.

    Negative numbers become 0. Each row is scaled so that its sum is the number of pods of the
    class; the pods of a row of zeros are spread over the zones in proportion to their places. Then
    excess pods of each zone are moved to zones with room, in the order of the zones.

    Parameters
    ----------
    data
        The problem, with a place for every pod.
    standing
        Number of pods of each class in each zone, shape (I, J), almost feasible.

    Returns
    -------
    A feasible table, shape (I, J).
    """
    fixed = np.maximum(standing, 0.0)
    total = fixed.sum(axis=1)
    some = total > 0
    fixed[some] *= (data.pods[some] / total[some])[:, np.newaxis]
    fixed[~some] = data.pods[~some, np.newaxis] * (data.places / (data.places.sum() or 1.0))
    room = data.places - fixed.sum(axis=0)
    for full in np.flatnonzero(room < 0).tolist():
        for free in np.flatnonzero(room > 0).tolist():
            amount = min(-room[full], room[free])
            if amount <= 0:
                break
            # taken from all classes in proportion
            part = fixed[:, full] * (amount / fixed[:, full].sum())
            fixed[:, full] = np.maximum(fixed[:, full] - part, 0.0)
            fixed[:, free] += part
            room[full] += amount
            room[free] -= amount
    return fixed

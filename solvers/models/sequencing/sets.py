"""Rack sequencing as bit sets of SKUs, without the SKUs and pods that do not matter.

SKUs that no order needs are dropped. A pod is dropped if another pod can replace it at every visit,
that is, holds all needed SKUs of the dropped pod. Of several pods with the same needed SKUs, the
one with the lowest index is kept.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from rmfs.solvers.models.sequencing.data import Integers, Sequencing


@dataclass(frozen=True)
class Sets:
    """Sets of SKUs as integers: bit k stands for the k-th of the SKUs that some order needs.

    Parameters
    ----------
    needs
        Set of the SKUs that each order needs.
    holds
        Set of the needed SKUs that each useful pod holds; see `useful_pods`.
    pod
        Index of each useful pod in the input, shape (len(holds),).
    """

    needs: tuple[int, ...]
    holds: tuple[int, ...]
    pod: Integers


def reduce(data: Sequencing) -> Sets:
    """Build the bit sets of an input.

    Parameters
    ----------
    data
        The input.
    """
    skus = np.flatnonzero(data.needs.any(axis=0))
    pods = useful_pods(data)
    return Sets(
        needs=tuple(_bits(row) for row in data.needs[:, skus].tolist()),
        holds=tuple(_bits(row) for row in data.holds[np.ix_(pods, skus)].tolist()),
        pod=pods,
    )


def useful_pods(data: Sequencing) -> Integers:
    """Return, in ascending order, the pods that hold needed SKUs and are not dominated.

    A SKU is needed if some order needs it. Pod p is dominated if another pod holds all needed SKUs
    of p and at least one more, or if a pod with a lower index holds the same needed SKUs as p.

    Parameters
    ----------
    data
        The input.
    """
    holds = data.holds[:, data.needs.any(axis=0)]
    common = holds.astype(np.float32) @ holds.T.astype(np.float32)
    size = holds.sum(axis=1)
    within = common == size[:, None]  # [i, j]: all that i has, j has too
    larger = size[None, :] > size[:, None]
    earlier = (size[None, :] == size[:, None]) & np.tri(size.size, k=-1, dtype=np.bool_)
    return np.flatnonzero((size > 0) & ~(within & (larger | earlier)).any(axis=1))


def _bits(row: list[bool]) -> int:
    """The set of true positions as bits."""
    return sum(1 << i for i, member in enumerate(row) if member)

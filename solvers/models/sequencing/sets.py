"""The problem as bit sets without irrelevant pods and SKUs, for the search methods.

SKUs that no order needs are dropped, and so are pods whose needed SKUs are all on another pod (a
pod that can do more never costs more). Of equal pods the one with the lowest index is kept.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from rmfs.solvers.models.sequencing.data import Integers, Sequencing


@dataclass(frozen=True)
class Sets:
    """Bit sets of SKUs.

    Parameters
    ----------
    needs
        Needed SKUs of each order.
    holds
        Needed SKUs that each remaining pod holds.
    pod
        The remaining pods in the numbering of the input, shape (len(holds),).
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

    A pod is dominated if another pod holds all of its needed SKUs and at least one more, or if a
    pod with a lower index holds the same needed SKUs.

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

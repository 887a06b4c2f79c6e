"""Names of the columns of a programme, for who solves it elsewhere."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike


class Names:
    """What the columns of a programme are called, and which decision each one takes.

    Parameters
    ----------
    columns
        How many columns there are.

    Attributes
    ----------
    name
        Of each column.
    means
        What it decides where it is 1, such as `pod_station[3] = 1`; empty for auxiliary columns.
    """

    def __init__(self, columns: int) -> None:
        self.name = [f"column_{number}" for number in range(columns)]
        self.means = [""] * columns

    def block(self, name: str, columns: ArrayLike, means: str = "", **indices: ArrayLike) -> None:
        """Name a block of columns by their indices.

        Parameters
        ----------
        name
            Of the block.
        columns
            Its columns.
        means
            What a column decides, with the letters of the indices in braces:
            `pod_station[{p}] = {s}`.
        indices
            By letter, values that broadcast to the shape of the columns.
        """
        number = np.asarray(columns)
        arrays = [
            np.broadcast_to(np.asarray(one), number.shape).ravel() for one in indices.values()
        ]
        for place, column in enumerate(number.ravel().tolist()):
            at = {letter: int(one[place]) for letter, one in zip(indices, arrays, strict=True)}
            self.name[column] = "_".join([name, *(f"{key}{value}" for key, value in at.items())])
            self.means[column] = means.format(**at)

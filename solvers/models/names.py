"""Names of the columns of a program, for users who solve it with another tool."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike


class Names:
    """The name of each column of a program, and the decision it stands for.

    Parameters
    ----------
    columns
        Number of columns.

    Attributes
    ----------
    name
        Name of each column.
    means
        The decision that each column makes if it is 1, such as `pod_station[3] = 1`; empty for
        auxiliary columns.
    """

    def __init__(self, columns: int) -> None:
        self.name = [f"column_{number}" for number in range(columns)]
        self.means = [""] * columns

    def block(self, name: str, columns: ArrayLike, means: str = "", **indices: ArrayLike) -> None:
        """Name a block of columns by their indices.

        Parameters
        ----------
        name
            Name of the block.
        columns
            The columns of the block.
        means
            The decision that a column makes if it is 1, with the letters of the indices in braces,
            such as `pod_station[{p}] = {s}`.
        indices
            Index values by letter; they broadcast to the shape of the columns.
        """
        number = np.asarray(columns)
        arrays = [
            np.broadcast_to(np.asarray(one), number.shape).ravel() for one in indices.values()
        ]
        for place, column in enumerate(number.ravel().tolist()):
            at = {letter: int(one[place]) for letter, one in zip(indices, arrays, strict=True)}
            self.name[column] = "_".join([name, *(f"{key}{value}" for key, value in at.items())])
            self.means[column] = means.format(**at)

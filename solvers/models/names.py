"""Names of the columns of a program, for users who solve it with another tool."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike


class Names:
    """The name of each column of a program, and the decision that the column represents.

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
        """Name the columns of a block by the block and their indices, such as `call_p3_s1`.

        Parameters
        ----------
        name
            Name of the block, such as `call`.
        columns
            The columns of the block.
        means
            The decision that a column makes if it is 1, with placeholders for the indices, such as
            `pod_station[{p}] = {s}`. Default: none (auxiliary columns).
        indices
            Values of each index; the keyword is the letter of the index. The values broadcast to
            the shape of `columns`.
        """
        number = np.asarray(columns)
        arrays = [
            np.broadcast_to(np.asarray(one), number.shape).ravel() for one in indices.values()
        ]
        for place, column in enumerate(number.ravel().tolist()):
            at = {letter: int(one[place]) for letter, one in zip(indices, arrays, strict=True)}
            self.name[column] = "_".join([name, *(f"{key}{value}" for key, value in at.items())])
            self.means[column] = means.format(**at)

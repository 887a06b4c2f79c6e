"""Mixed-integer linear programs in matrix form, and a builder that fills them in blocks.

A model is formulated once as a `LinearProgram`, which the back ends of
`rmfs.solvers.models.backends` pass to the solvers. Building is vectorised: one call per family of
columns or rows.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TypeVar

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.sparse import csr_array

from rmfs.solvers.models.checks import flags, integers, reals, require

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]
Kind = TypeVar("Kind", bound=np.generic)


@dataclass(frozen=True)
class LinearProgram:
    """Minimise ``cost·x + offset`` over ``row_lower <= A x <= row_upper, lower <= x <= upper``.

    Parameters
    ----------
    cost
        Cost per column, shape (n,).
    lower, upper
        Bounds of each column, finite, shape (n,).
    integer
        Whether each column must take an integer value, shape (n,).
    row_start, column, coefficient
        The matrix A, shape (m, n), in compressed rows: row i has the coefficients
        ``coefficient[row_start[i]:row_start[i + 1]]`` in the columns
        ``column[row_start[i]:row_start[i + 1]]``, which are sorted and distinct.
    row_lower, row_upper
        Bounds of each row, shape (m,); -inf or inf if the row has no such bound.
    offset
        Constant part of the objective. Default 0.

    Raises
    ------
    ModelError
        If shapes do not fit, a lower bound exceeds an upper bound, or a number that must be finite
        is not.
    """

    cost: Floats
    lower: Floats
    upper: Floats
    integer: NDArray[np.bool_]
    row_start: Integers
    column: Integers
    coefficient: Floats
    row_lower: Floats
    row_upper: Floats
    offset: float = 0.0

    def __post_init__(self) -> None:
        n, m = np.shape(self.cost)[0], np.shape(self.row_lower)[0]
        checked = {
            "cost": reals("cost", self.cost, (n,)),
            "lower": reals("lower", self.lower, (n,)),
            "upper": reals("upper", self.upper, (n,)),
            "integer": flags("integer", self.integer, (n,)),
            "row_start": integers("row_start", self.row_start, (m + 1,), low=0),
            "column": integers("column", self.column, (None,), low=0, high=max(n - 1, 0)),
        }
        nonzeros = checked["column"].shape[0]
        checked["coefficient"] = reals("coefficient", self.coefficient, (nonzeros,))
        for field, value in checked.items():
            object.__setattr__(self, field, value)
        require(self.row_upper.shape == (m,), "row_upper", f"shape must be ({m},)")
        require(bool(np.all(self.lower <= self.upper)), "lower", "must not exceed upper")
        require(
            bool(np.all(self.row_lower <= self.row_upper)), "row_lower", "must not exceed row_upper"
        )

    @property
    def columns(self) -> int:
        """Number of columns."""
        return int(self.cost.shape[0])

    @property
    def rows(self) -> int:
        """Number of rows."""
        return int(self.row_lower.shape[0])

    @property
    def nonzeros(self) -> int:
        """Number of entries stored for the matrix."""
        return int(self.column.shape[0])

    @cached_property
    def matrix(self) -> csr_array:
        """The matrix A as a sparse SciPy array, shape (rows, columns)."""
        return csr_array(
            (self.coefficient, self.column, self.row_start), shape=(self.rows, self.columns)
        )

    def objective(self, x: Floats) -> float:
        """Return the value of the objective at a point."""
        return float(self.cost @ x) + self.offset

    def violation(self, x: Floats) -> float:
        """Return the largest violation of a bound, a row or integrality at a point; 0 if none."""
        activity = np.asarray(self.matrix @ x)
        broken = [
            self.lower - x,
            x - self.upper,
            self.row_lower - activity,
            activity - self.row_upper,
            np.abs(x - np.rint(x))[self.integer],
        ]
        return max(0.0, *(float(part.max(initial=0.0)) for part in broken))


class ProgramBuilder:
    """Collects blocks of columns and rows and assembles them into a program."""

    def __init__(self) -> None:
        self._columns = 0
        self._rows = 0
        self._cost: list[Floats] = []
        self._lower: list[Floats] = []
        self._upper: list[Floats] = []
        self._integer: list[NDArray[np.bool_]] = []
        self._row_lower: list[Floats] = []
        self._row_upper: list[Floats] = []
        self._entries: list[tuple[Integers, Integers, Floats]] = []

    def columns(
        self,
        shape: int | tuple[int, ...],
        *,
        cost: ArrayLike = 0.0,
        lower: ArrayLike = 0.0,
        upper: ArrayLike = 1.0,
        integer: bool = True,
    ) -> Integers:
        """Add a block of columns.

        Parameters
        ----------
        shape
            Shape of the block.
        cost, lower, upper
            Cost and bounds of the columns, broadcast to `shape`. Defaults: 0, 0 and 1.
        integer
            Whether the columns must take integer values. Default: yes (with the default bounds, the
            columns are then binary).

        Returns
        -------
        The index of each new column, in the given shape.
        """
        block = np.zeros(shape, dtype=np.int64)
        new = np.arange(self._columns, self._columns + block.size, dtype=np.int64)
        for store, value in ((self._cost, cost), (self._lower, lower), (self._upper, upper)):
            store.append(np.broadcast_to(np.asarray(value, dtype=np.float64), block.shape).ravel())
        self._integer.append(np.full(block.size, integer))
        self._columns += block.size
        return new.reshape(block.shape)

    def rows(
        self,
        count: int,
        *entries: tuple[ArrayLike, ArrayLike, ArrayLike],
        lower: ArrayLike = -np.inf,
        upper: ArrayLike = np.inf,
    ) -> None:
        """Add a block of rows.

        Parameters
        ----------
        count
            Number of rows in the block.
        entries
            Triples of arrays (row within the block, column, coefficient); the three arrays of a
            triple are broadcast to one shape. Entries with the same row and column add up.
        lower, upper
            Bounds of the rows: one value per row, or one for all rows. Defaults: -inf and inf.
        """
        for row, column, value in entries:
            r, c, v = np.broadcast_arrays(
                np.asarray(row, dtype=np.int64) + self._rows,
                np.asarray(column, dtype=np.int64),
                np.asarray(value, dtype=np.float64),
            )
            self._entries.append((r.ravel(), c.ravel(), v.ravel()))
        self._row_lower.append(np.broadcast_to(np.asarray(lower, dtype=np.float64), (count,)))
        self._row_upper.append(np.broadcast_to(np.asarray(upper, dtype=np.float64), (count,)))
        self._rows += count

    def build(self, offset: float = 0.0) -> LinearProgram:
        """Assemble the blocks into a program.

        Parameters
        ----------
        offset
            Constant part of the objective. Default 0.

        Returns
        -------
        The program; the entries of a row are sorted by column, and entries with the same row and
        column are added up.
        """
        row = _joined([entry[0] for entry in self._entries], np.int64)
        column = _joined([entry[1] for entry in self._entries], np.int64)
        value = _joined([entry[2] for entry in self._entries], np.float64)
        matrix = csr_array((value, (row, column)), shape=(self._rows, self._columns))
        matrix.sum_duplicates()
        return LinearProgram(
            cost=_joined(self._cost, np.float64),
            lower=_joined(self._lower, np.float64),
            upper=_joined(self._upper, np.float64),
            integer=_joined(self._integer, np.bool_),
            row_start=matrix.indptr.astype(np.int64),
            column=matrix.indices.astype(np.int64),
            coefficient=matrix.data,
            row_lower=_joined(self._row_lower, np.float64),
            row_upper=_joined(self._row_upper, np.float64),
            offset=offset,
        )


def _joined(parts: list[NDArray[Kind]], kind: type[Kind]) -> NDArray[Kind]:
    """Concatenate arrays; an empty list gives an empty array."""
    return np.concatenate(parts) if parts else np.zeros(0, dtype=kind)

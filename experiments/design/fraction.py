"""Fractional designs: a choice of arms from which main effects can be estimated precisely.

Command: `python -m rmfs.experiments.design.fraction`.

If the factors are the rules of several decision problems, the grid of all combinations has
thousands of arms. For screening, far fewer arms suffice to estimate the main effects, provided that
the levels of the factors are well balanced among these arms. The arms are chosen such that the
determinant of the information matrix of the main effects is large (D-optimality). The search starts
from a random choice. In each step, it exchanges one chosen arm for another one, such that the
determinant increases most; it ends when no exchange increases the determinant (Fedorov 1972). The
result is written to a file, so that the arms of a study do not depend on the machine.
"""

from __future__ import annotations

import argparse
import csv
import io
import sys
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from rmfs.errors import InputError
from rmfs.experiments.design import file as design_file
from rmfs.experiments.design.arms import arms, factor_names, shown_value
from rmfs.files import write_text

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from rmfs.experiments.design.arms import Arm

EXCHANGES = 10_000
"""Maximum number of exchanges; in practice, the search ends earlier, at a local optimum."""

IMPROVEMENT = 1e-9


def main_effects(levels: Sequence[Sequence[object]]) -> NDArray[np.float64]:
    """Return the model matrix of the main effects, with one row per arm.

    Parameters
    ----------
    levels
        For each arm, the level of each factor.

    Returns
    -------
    A column of ones and, for each factor, one column for every level but the last: 1 for arms with
    this level, -1 for arms with the factor's last level, and 0 otherwise (effect coding).
    """
    columns = [np.ones(len(levels))]
    for factor in zip(*levels, strict=True):
        named = list(dict.fromkeys(factor))
        last = np.array([level == named[-1] for level in factor])
        for level in named[:-1]:
            columns.append(np.array([one == level for one in factor]) - 1.0 * last)
    return np.stack(columns, axis=1)


def d_optimal(rows: NDArray[np.float64], count: int, seed: int = 0) -> list[int]:
    """Choose informative rows of a model matrix.

    Rows are exchanged as long as this increases the determinant of the information matrix.

    Parameters
    ----------
    rows
        Candidate rows, shape (N, p).
    count
        Number of rows to choose, without repetition; at least p.
    seed
        Seed of the initial choice.

    Returns
    -------
    Indices of the chosen rows, ascending.

    Raises
    ------
    InputError
        If `count` is too small or too large.
    """
    total, parameters = rows.shape
    if not parameters <= count <= total:
        raise InputError(
            f"{count} arms: must be from {parameters} to {total} to estimate the effects"
        )
    rng = np.random.default_rng(seed)
    chosen = rng.permutation(total)[:count]
    # a little of the identity, should the first choice miss a level
    information = rows[chosen].T @ rows[chosen] + 1e-6 * np.eye(parameters)
    for _ in range(EXCHANGES):
        inside = np.zeros(total, dtype=bool)
        inside[chosen] = True
        inverse = np.linalg.inv(information)
        variance = np.einsum("ij,jk,ik->i", rows, inverse, rows)
        covariance = rows[chosen] @ inverse @ rows.T
        own = variance[chosen][:, None]
        # relative change of the determinant if i (chosen) gives way to j
        gain = variance - own - own * variance + covariance**2
        gain[:, inside] = -np.inf
        out, new = np.unravel_index(int(np.argmax(gain)), gain.shape)
        if gain[out, new] <= IMPROVEMENT:
            break
        information += np.outer(rows[new], rows[new])
        information -= np.outer(rows[chosen[out]], rows[chosen[out]])
        chosen[out] = new
    return sorted(int(number) for number in chosen)


def efficiency(rows: NDArray[np.float64], chosen: Sequence[int]) -> float:
    """Return the D-efficiency: information per chosen row, relative to all rows."""
    part, whole = rows[list(chosen)], rows
    parameters = rows.shape[1]
    share = np.linalg.slogdet(part.T @ part)[1] - np.linalg.slogdet(whole.T @ whole)[1]
    return float(np.exp(share / parameters) * len(whole) / len(part))


def fraction(made: Sequence[Arm], count: int, seed: int = 0) -> tuple[list[Arm], float]:
    """Choose `count` of the given arms; return them, and the D-efficiency of the choice."""
    rows = main_effects([list(arm.levels.values()) for arm in made])
    chosen = d_optimal(rows, count, seed)
    return [made[number] for number in chosen], efficiency(rows, chosen)


def to_csv(made: Sequence[Arm]) -> str:
    """Return arms as CSV text for a design's `only_file`: a row per arm, a column per factor."""
    short = factor_names(made[0].levels)
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(short.values())
    for arm in made:
        writer.writerow(["" if v is None else shown_value(v) for v in arm.levels.values()])
    return text.getvalue()


def main(arguments: list[str] | None = None) -> int:
    """Choose arms of a design, regardless of its `only_file`; write them to a file."""
    parser = argparse.ArgumentParser(prog="python -m rmfs.experiments.design.fraction")
    parser.add_argument("design", help="a design file or the name of a shipped one")
    parser.add_argument("count", type=int, help="how many arms")
    parser.add_argument("file", type=Path, help="the .csv file to write")
    parser.add_argument("--seed", type=int, default=0)
    given = parser.parse_args(arguments)
    try:
        path = design_file.locate(given.design)
        design, _ = design_file.read(path)
        made, problems = arms(design.model_copy(update={"only_file": None}), path.parent)
        if problems:
            raise InputError(f"{path}: {'; '.join(problems)}")
        chosen, reached = fraction(made, given.count, given.seed)
        write_text(given.file, to_csv(chosen))
    except InputError as error:
        print(f"fraction: {error}", file=sys.stderr)
        return 2
    print(f"{given.file}: {len(chosen)} of {len(made)} arms, D-efficiency {reached:.3f}")
    return 0


if __name__ == "__main__":
    sys.exit(main())

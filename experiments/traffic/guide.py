"""Optimisation of guidance for a layout, by CMA-ES over simulated runs.

A vector of weights, one per feature of the edges, defines the extra cost of every edge. The value
of a vector is the mean objective of runs with several seeds, which are the same for all vectors
(common random numbers).
"""

from __future__ import annotations

import tempfile
import warnings
from concurrent.futures import ProcessPoolExecutor
from contextlib import nullcontext
from dataclasses import asdict, dataclass
from functools import partial
from multiprocessing import get_context
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pandas as pd

from rmfs.errors import InputError
from rmfs.experiments.traffic.guide_features import FEATURES, features
from rmfs.random import Stream, generator
from rmfs.traffic.guidance import MOST_EXTRA_S, write_guidance

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from numpy.typing import NDArray

    from rmfs.experiments.traffic.guide_tasks import Task
    from rmfs.layout.model import Layout

LARGEST = {
    "against": 3.0,
    "across": 1.5,
    "storage": 1.5,
    "entrance": 3.0,
    "flow": 1.5,
    "waiting": 4.0,
}
"""Largest weight of each feature that the search tries, in s."""

FINALISTS = 3
"""Number of vectors, besides the mean of the last distribution, that are tried on other seeds."""


@dataclass(frozen=True)
class Found:
    """Guidance that was found.

    Attributes
    ----------
    weights
        Weight of each feature, in s.
    extra_s
        Extra cost of each edge in s, aligned with `layout.edge_target`.
    value, base_value
        Mean objective with and without this guidance, over the seeds `Task.other_seeds`.
    history
        One row per generation: its number (`generation`), and the best and the mean value of its
        vectors (`best`, `mean`) over the seeds of the task.
    """

    weights: dict[str, float]
    extra_s: NDArray[np.float64]
    value: float
    base_value: float
    history: pd.DataFrame

    def write(self, path: Path, task: Task, **more: Any) -> None:
        """Write the guidance to a file, with the task and the result as its origin."""
        told = ", ".join(f"{name} {weight:.3g}" for name, weight in self.weights.items() if weight)
        write_guidance(
            path,
            task.load(),
            self.extra_s,
            description=f"Weights of features in s: {told or 'none'}.",
            origin={
                "task": {"kind": type(task).__name__, **asdict(task)},
                "weights": self.weights,
                "value": self.value,
                "base_value": self.base_value,
                **more,
            },
        )


def optimise(
    task: Task,
    *,
    start: Mapping[str, float] | None = None,
    generations: int = 10,
    population: int = 8,
    seed: int = 1,
    jobs: int = 1,
    told: Callable[[str], None] | None = None,
) -> Found:
    """Optimise the weights of the features of a layout's edges.

    Parameters
    ----------
    start
        Weights from which the search starts, in s; weights not named are 0. Default: 1/25 of the
        largest weights that the search tries (`LARGEST`). If `generations` is 0, these weights are
        the result.
    generations, population
        Number of generations, and number of vectors of weights per generation; each vector is
        simulated with all seeds of the task.
    seed
        Seed of the search; the result does not depend on the number of processes.
    jobs
        Number of processes.
    told
        Function called with a line of text after each generation.

    Raises
    ------
    InputError
        If a number is out of range, a weight is unknown, the package `cma` is not installed, or an
        input of the task is invalid.
    """
    if generations < 0 or population < 4 or jobs < 1:
        raise InputError(
            "guidance needs generations of 0 or more, a population of 4 or more and jobs of 1 or "
            f"more (given: {generations}, {population}, {jobs})"
        )
    first = _first(start)
    layout = task.load()
    edges, heat = zip(*map(task.counted, task.seeds), strict=True)
    table = features(layout, pd.concat(edges), pd.concat(heat))
    columns = np.stack([table[name] for name in FEATURES])
    pool = nullcontext() if jobs == 1 else ProcessPoolExecutor(jobs, get_context("spawn"))
    with pool as executor, tempfile.TemporaryDirectory() as folder:
        each = map if executor is None else executor.map
        judge = partial(_values, task, layout, columns, Path(folder), each)
        best = first
        rows: list[tuple[int, float, float]] = []
        others = task.other_seeds()
        if generations:
            finalists, rows = _search(judge, first, generations, population, seed, told)
            values = judge([np.zeros(len(FEATURES)), *finalists], others)
            base_value = values[0]
            top = int(np.argmax(values))
            best, value = [np.zeros(len(FEATURES)), *finalists][top], values[top]
        else:
            base_value, value = judge([np.zeros(len(FEATURES)), best], others)
    weights = {name: float(weight) for name, weight in zip(FEATURES, best, strict=True)}
    history = pd.DataFrame(rows, columns=["generation", "best", "mean"])
    return Found(weights, _extra_s(columns, best), value, base_value, history)


def _first(start: Mapping[str, float] | None) -> NDArray[np.float64]:
    """Return the weights with which the search starts."""
    if start is None:
        return np.array([LARGEST[name] / 25 for name in FEATURES])
    for name, weight in start.items():
        if name not in FEATURES:
            raise InputError(f"weight {name}: unknown feature; valid: {', '.join(FEATURES)}")
        if not 0 <= weight <= MOST_EXTRA_S:
            raise InputError(f"weight {name}: must be between 0 and {MOST_EXTRA_S:g}")
    return np.array([float(start.get(name, 0.0)) for name in FEATURES])


def _search(
    judge: Callable[[Sequence[NDArray[np.float64]]], list[float]],
    first: NDArray[np.float64],
    generations: int,
    population: int,
    seed: int,
    told: Callable[[str], None] | None,
) -> tuple[list[NDArray[np.float64]], list[tuple[int, float, float]]]:
    """Return the best weights found, and the history of the search.

    The coordinates of the search are the square roots of the weights, relative to the largest
    weights. Small weights, which may already decide between two paths of equal length, are then
    searched more finely than large ones.
    """
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # about optional packages of cma
            import cma
    except ImportError as error:
        raise InputError("guidance needs the package cma: pip install rmfs[learning]") from error
    largest = np.array([LARGEST[name] for name in FEATURES])

    def weights(point: NDArray[np.float64]) -> NDArray[np.float64]:
        found: NDArray[np.float64] = np.square(np.clip(point, 0.0, 1.0)) * largest
        return found

    drawn = int(generator(seed, Stream.TRAINING).integers(1, 2**31))
    options = {"popsize": population, "seed": drawn, "verbose": -9, "bounds": [0.0, 1.0]}
    search = cma.CMAEvolutionStrategy(np.sqrt(np.minimum(first / largest, 1.0)), 0.25, options)
    rows: list[tuple[int, float, float]] = []
    known: list[tuple[float, int, NDArray[np.float64]]] = []
    for number in range(generations):
        asked = [np.asarray(one) for one in search.ask()]
        values = judge([weights(one) for one in asked])
        search.tell(asked, [-value for value in values])
        known += [(-value, len(known) + at, asked[at]) for at, value in enumerate(values)]
        rows.append((number + 1, max(values), float(np.mean(values))))
        if told is not None:
            told(f"generation {number + 1}: best {max(values):.4g}, mean {np.mean(values):.4g}")
    top = [point for _, _, point in sorted(known, key=lambda one: one[:2])[:FINALISTS]]
    return [weights(point) for point in [np.asarray(search.result.xfavorite), *top]], rows


def _extra_s(columns: NDArray[np.float64], weights: NDArray[np.float64]) -> NDArray[np.float64]:
    extra_s: NDArray[np.float64] = np.minimum(weights @ columns, MOST_EXTRA_S)
    return extra_s


def _values(
    task: Task,
    layout: Layout,
    columns: NDArray[np.float64],
    folder: Path,
    each: Callable[..., Any],
    vectors: Sequence[NDArray[np.float64]],
    seeds: Sequence[int] | None = None,
) -> list[float]:
    """Return the mean objective of vectors of weights over seeds."""
    seeds = task.seeds if seeds is None else seeds
    files = [folder / f"{number}.json" for number in range(len(vectors))]
    for file, weights in zip(files, vectors, strict=True):
        write_guidance(file, layout, _extra_s(columns, weights))
    calls = [(file, seed) for file in files for seed in seeds]
    values = list(each(_one, [task] * len(calls), *zip(*calls, strict=True)))
    return [float(one) for one in np.reshape(values, (len(vectors), -1)).mean(axis=1)]


def _one(task: Task, guidance: Path, seed: int) -> float:
    return task.value(guidance, seed)

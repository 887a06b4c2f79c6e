"""Training of linear rules by CMA-ES, an evolution strategy without gradients.

Every vector of weights defines a set of controllers. The value of a vector is the mean objective of
runs with several seeds. The seeds are the same for all vectors (common random numbers).
"""

from __future__ import annotations

import warnings
from concurrent.futures import Executor, ProcessPoolExecutor
from dataclasses import dataclass, field, replace
from multiprocessing import get_context
from time import perf_counter
from typing import TYPE_CHECKING, Any

import numpy as np
import pandas as pd

from rmfs import control
from rmfs.control.choices import check_together, choose
from rmfs.control.linear import default_weights
from rmfs.control.problems import Problem
from rmfs.control.settings import ControllerSettings
from rmfs.errors import InputError
from rmfs.measure.objective import check_objective, objective_of, require_objective
from rmfs.random import Stream, generator
from rmfs.simulation.idle_rules import IdleRuleWarning
from rmfs.simulation.run import simulate

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from numpy.typing import NDArray

TRAINED: dict[Problem, dict[str, str]] = {
    Problem.POA: {"weights": "poa"},
    Problem.PPS: {"pick_pod": "pick pod", "replenishment_pod": "replenishment pod"},
    Problem.PSA: {"weights": "place"},
    Problem.TA: {"weights": "ta"},
}
"""For each problem, the trained parameters of its linear rule, each with the kind of question for
which its weights are used."""


@dataclass(frozen=True)
class Task:
    """A training task: what is simulated, which rules are trained, and the objective.

    Attributes
    ----------
    layout, scenario, controllers
        Inputs of the simulation; the controllers decide all problems that are not trained.
    problems
        Problems whose linear or network rules are trained; keys of `TRAINED`.
    objective
        Weights by column of the footprint; the weighted sum of the columns is maximised.
    seeds
        Seeds of the runs by which rules are evaluated.
    set
        Further parameters by dotted key, as for `rmfs.simulate`.

    Raises
    ------
    InputError
        If a problem cannot be trained, a column does not exist, or `problems`, `objective` or
        `seeds` is empty.
    """

    layout: str
    scenario: str
    controllers: str = "default"
    problems: Sequence[str] = ("poa", "pps")
    objective: Mapping[str, float] = field(default_factory=lambda: {"units_picked": 1.0})
    seeds: Sequence[int] = (1, 2, 3)
    set: Mapping[str, Any] = field(default_factory=dict)

    def __post_init__(self) -> None:
        valid = [str(problem) for problem in TRAINED]
        for problem in self.problems:
            if problem not in valid:
                raise InputError(f"problem {problem}: must be one of {', '.join(valid)}")
        check_objective(self.objective)
        if not self.problems or not self.objective or not self.seeds:
            raise InputError("training needs at least one problem, one objective and one seed")

    def start(self) -> NDArray[np.float64]:
        """Return the default weights of the linear rules as one vector.

        The weights for each kind of question (see `rmfs.control.questions`) are scaled so that the
        largest absolute value is 1.
        """
        found = [list(default_weights(kind).values()) for kind in self._kinds()]
        return np.concatenate([np.array(one) / max(map(abs, one)) for one in found])

    def base(self) -> ControllerSettings:
        """Return the task's set of controllers before training, with the parameters in `set`."""
        overrides = [
            (key.split(".")[1:], value)
            for key, value in self.set.items()
            if key.startswith("controllers.")
        ]
        return control.load(self.controllers, overrides)

    def settings(self, weights: NDArray[np.float64]) -> ControllerSettings:
        """Return the set of controllers whose trained linear rules have the given weights."""
        base = self.base()
        choices, rest = dict(base.choices), weights.tolist()
        for name in self.problems:
            problem = Problem(name)
            table: dict[str, Any] = {"name": "linear"}
            for parameter, kind in TRAINED[problem].items():
                columns = list(default_weights(kind))
                table[parameter] = dict(zip(columns, rest, strict=False))
                rest = rest[len(columns) :]
            choices[problem] = choose(problem, table, "training")
        check_together(choices, "training")
        told = f"Linear rules for {', '.join(self.problems)}, the rest as {base.name}."
        return ControllerSettings("linear", told, choices)

    def worth(self, weights: NDArray[np.float64], seed: int) -> float:
        """Simulate one run with linear rules of the given weights, and return its objective."""
        return self.value_of(self.settings(weights), seed)

    def value_of(self, settings: ControllerSettings, seed: int) -> float:
        """Simulate one run and return its objective; -inf if a column has no finite value.

        Raises
        ------
        InputError
            If a column contains text.
        """
        given = {k: v for k, v in self.set.items() if not k.startswith("controllers.")}
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", IdleRuleWarning)  # some weight vectors are bad
            run = simulate(self.layout, self.scenario, settings, seed=seed, set=given)
        return objective_of(run.footprint, self.objective)

    def require_value(self, value: float) -> None:
        """Check that the objective had a value in every run with the initial rules.

        Parameters
        ----------
        value
            The mean objective of these runs.

        Raises
        ------
        InputError
            If the objective had no value in at least one of these runs.
        """
        require_objective(value, self.objective, "with the rules before training")

    def _kinds(self) -> list[str]:
        return [kind for one in self.problems for kind in TRAINED[Problem(one)].values()]


@dataclass(frozen=True)
class Trained:
    """The result of training.

    Attributes
    ----------
    settings
        The trained controllers, which `rmfs.control.toml.to_toml` converts to a file.
    value, start_value
        Mean objective over the task's seeds, after and before training.
    history
        The course of training. `train` adds one row per generation: its number (`generation`), the
        best and the mean value of its vectors (`best`, `mean`), the number of runs in all
        generations so far (`runs`), and the wall time in s since the start (`wall_s`).
        `rmfs.learning.ppo.train_network` adds one row per check: the number of decisions so far
        (`steps`), the mean objective (`value`), and the wall and processor times in s since the
        start (`wall_s`, `cpu_s`).
    """

    settings: ControllerSettings
    value: float
    start_value: float
    history: pd.DataFrame


def train(
    task: Task,
    *,
    generations: int = 20,
    population: int = 10,
    spread: float = 0.3,
    seed: int = 1,
    jobs: int = 1,
    told: Callable[[str], None] | None = None,
) -> Trained:
    """Train the weights of linear rules, and return the best weights found.

    Parameters
    ----------
    generations, population
        Number of generations, and number of vectors of weights per generation. Each vector is
        simulated with all seeds of the task.
    spread
        Initial standard deviation of the weights. For each kind of question (see
        `rmfs.control.questions`), the largest absolute value of the initial weights is 1.
    seed
        Seed of the evolution strategy.
    jobs
        Number of processes; the result does not depend on it.
    told
        Function called with a line of text after each generation.

    Raises
    ------
    InputError
        If a number is out of range, the package `cma` is not installed, or the objective has no
        value with the default weights.
    """
    if min(generations, population - 3, jobs) < 1 or not spread > 0:
        raise InputError(
            "training needs generations of 1 or more, a population of 4 or more, jobs of 1 or "
            f"more and a spread above 0 (given: {generations}, {population}, {jobs}, {spread})"
        )
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # about optional packages of cma
            import cma
    except ImportError as error:
        raise InputError("training needs the package cma: pip install rmfs[learning]") from error
    began, start = perf_counter(), task.start()
    drawn = int(generator(seed, Stream.TRAINING).integers(1, 2**31))
    options = {"popsize": population, "seed": drawn, "verbose": -9}
    search = cma.CMAEvolutionStrategy(start, spread, options)
    best, runs, rows = start, 0, []
    with _executor(jobs) as executor:
        first = best_value = _worth(executor, task, [start])[0]
        task.require_value(first)
        for number in range(generations):
            asked = [np.asarray(one) for one in search.ask()]
            values = _worth(executor, task, asked)
            search.tell(asked, [-value for value in values])
            runs += population * len(task.seeds)
            top = int(np.argmax(values))
            if values[top] > best_value:
                best, best_value = asked[top], values[top]
            mean, wall_s = float(np.mean(values)), perf_counter() - began
            rows.append((number + 1, max(values), mean, runs, wall_s))
            if told is not None:
                told(f"generation {number + 1}: best {max(values):.4g}, mean {mean:.4g}")
        middle = np.asarray(search.result.xfavorite)
        value = _worth(executor, task, [middle])[0]
    if value >= best_value:  # the mean is less noisy than single samples
        best, best_value = middle, value
    columns = ["generation", "best", "mean", "runs", "wall_s"]
    history = pd.DataFrame(rows, columns=columns)
    scaled = best / np.abs(best).max()
    return Trained(task.settings(scaled), best_value, first, history)


def named(trained: Trained, name: str, description: str) -> ControllerSettings:
    """Return the trained controllers with the given name and description."""
    return replace(trained.settings, name=name, description=description)


def _worth(
    executor: Executor | None, task: Task, sets: Sequence[NDArray[np.float64]]
) -> list[float]:
    """Return the value of each vector of weights: the mean objective over all seeds."""
    calls = [(weights, seed) for weights in sets for seed in task.seeds]
    each = map if executor is None else executor.map
    values = list(each(_one, [task] * len(calls), *zip(*calls, strict=True)))
    return [float(one) for one in np.reshape(values, (len(sets), -1)).mean(axis=1)]


def _one(task: Task, weights: NDArray[np.float64], seed: int) -> float:
    return task.worth(weights, seed)


class _Here:
    """A substitute for an executor if there is only one process."""

    def __enter__(self) -> None:
        return None

    def __exit__(self, *_: object) -> None:
        return None


def _executor(jobs: int) -> Any:
    return _Here() if jobs == 1 else ProcessPoolExecutor(jobs, get_context("spawn"))

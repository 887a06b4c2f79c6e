"""Sets of controllers with network rules, for training."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from rmfs.control.choices import check_together, choose
from rmfs.control.network import CANDIDATES, Network, start
from rmfs.control.problems import Problem
from rmfs.control.settings import ControllerSettings

if TYPE_CHECKING:
    from collections.abc import Mapping

    from rmfs.learning.training import Task

KINDS: dict[Problem, dict[str, str]] = {
    Problem.POA: {"network": "poa"},
    Problem.PPS: {
        "pick_pod": "pick pod",
        "replenishment_pod": "replenishment pod",
        "next_station": "next station",
    },
    Problem.PSA: {"network": "place"},
    Problem.TA: {"network": "ta"},
}
"""For each problem that a `Task` may train, the parameters of its network rule that are networks,
each with the kind of question for which the network is used."""


def network_rules(
    task: Task, networks: Mapping[str, Network], candidates: int = CANDIDATES
) -> ControllerSettings:
    """Return the task's set of controllers, with network rules for the problems that are trained.

    Parameters
    ----------
    networks
        The networks of these rules, by kind of question.
    candidates
        Maximum number of candidates that the rules score.
    """
    base = task.base()
    choices = dict(base.choices)
    for name in task.problems:
        problem = Problem(name)
        table: dict[str, Any] = {"name": "network", "candidates": candidates}
        for parameter, kind in KINDS[problem].items():
            table[parameter] = networks[kind].model_dump(mode="json", exclude_none=True)
        choices[problem] = choose(problem, table, "training")
    check_together(choices, "training")
    told = f"Network rules for {', '.join(task.problems)}, the rest as {base.name}."
    return ControllerSettings("network", told, choices)


def first_networks(task: Task) -> dict[str, Network]:
    """Return the networks from which training starts, by kind of question."""
    choices = task.base().choices
    found = {}
    for name in task.problems:
        parameters = choices[Problem(name)].parameters
        for parameter, kind in KINDS[Problem(name)].items():
            given = getattr(parameters, parameter, None)
            found[kind] = given if isinstance(given, Network) else start(kind)
    return found


def mean_value(task: Task, settings: ControllerSettings) -> float:
    """Return the mean objective of a set of controllers over the seeds of a task."""
    return float(np.mean([task.value_of(settings, seed) for seed in task.seeds]))

"""What a policy sees: global features, and the k best candidates of a question."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from rmfs.control.features import (
    COLUMNS,
    KINDS,
    LIMIT,
    RANKINGS,
    Feature,
    best_rows,
    features_of,
    matrix,
    numbers,
)
from rmfs.control.problems import Problem
from rmfs.errors import InputError

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from numpy.typing import NDArray

    from rmfs.control.view import View
    from rmfs.simulation.decision import Decision

GLOBAL_FEATURES: tuple[Feature, ...] = (
    Feature("time_left", "share", 1.0, "of the run, what is still to come"),
    Feature("backlog_orders", "orders", 100.0, "orders that wait for a station"),
    Feature("waiting_bundles", "bundles", 100.0, "bundles without station or pod"),
    Feature("free_slots", "share", 1.0, "slots of active pick stations without an order"),
    Feature("open_units", "units per station", 20.0, "units for which no pod is under way"),
    Feature("asking_robots", "share", 1.0, "robots that need a task"),
    Feature("resting_robots", "share", 1.0, "robots at rest"),
    Feature("loaded_robots", "share", 1.0, "robots with a pod"),
    Feature("stored_share", "share", 1.0, "space of all pods in use"),
)
"""What is told of the whole warehouse; after these, 1 for the kind of the question."""

_MOVE = 2


@dataclass(frozen=True)
class Options:
    """The answers a policy is offered.

    Attributes
    ----------
    decision
        The question.
    rows
        Rows of `decision.candidates`, the best first; at most k.
    features
        Scaled features, shape (k, F); rows beyond the candidates are zero.
    mask
        Which actions are possible, shape (k + 1,); the last one declines.
    """

    decision: Decision
    rows: NDArray[np.intp]
    features: NDArray[np.float32]
    mask: NDArray[np.int8]

    @property
    def is_forced(self) -> bool:
        """Whether there is one action only."""
        return int(self.mask.sum()) < 2


class Observing:
    """Makes observations for a set of decision problems.

    Parameters
    ----------
    problems
        Whose questions come.
    candidates
        How many are offered (k).
    rankings
        Weights of columns by kind of question, in place of `RANKINGS`.

    Attributes
    ----------
    kinds
        Kinds of question that may come.
    features
        Of each candidate, in order.
    global_features
        Of the warehouse and the question, in order.

    Raises
    ------
    InputError
        If a problem, a kind or a column does not exist.
    """

    def __init__(
        self,
        problems: Sequence[str],
        candidates: int,
        rankings: Mapping[str, Mapping[str, float]] | None = None,
    ) -> None:
        if candidates < 1:
            raise InputError(f"candidates {candidates}: must be 1 or more")
        known = [str(problem) for problem in KINDS]
        for problem in problems:
            if problem not in known:
                raise InputError(f"problem {problem}: valid: {', '.join(known)}")
        self.k = candidates
        self.kinds = tuple(kind for one in problems for kind in KINDS[Problem(one)])
        self.features = features_of(self.kinds)
        self.global_features = (
            *GLOBAL_FEATURES,
            *(
                Feature(f"is {kind}", "", 1.0, "the question is of this kind")
                for kind in self.kinds
            ),
        )
        self._names = [feature.name for feature in self.features]
        self._scales = np.array([feature.scale for feature in GLOBAL_FEATURES])
        self._rankings = {**RANKINGS, **_checked(rankings or {})}

    def options(self, decision: Decision, *, may_move: bool) -> Options:
        """Find the best candidates of a question.

        Parameters
        ----------
        may_move
            Whether robots may move idle pods.
        """
        kind = decision.problem.value if decision.kind == "turn" else decision.kind
        found = np.zeros((self.k, len(self._names)), np.float32)
        mask = np.zeros(self.k + 1, np.int8)
        mask[self.k] = decision.kind != "next station"
        candidates = decision.candidates
        rows = np.empty(0, np.intp)
        if len(candidates):
            columns = numbers(candidates, kind, decision.view)
            if kind == "ta" and not may_move:
                rows = np.flatnonzero(candidates.columns["kind"] != _MOVE)
                columns = {name: values[rows] for name, values in columns.items()}
            best = best_rows(columns, self._rankings[kind], self.k)
            chosen = {name: values[best] for name, values in columns.items()}
            rows = rows[best] if len(rows) else best
            found[: len(best)] = matrix(chosen, self._names)
            mask[: len(best)] = 1
        return Options(decision, rows, found, mask)

    def globals_of(self, view: View, decision: Decision | None) -> NDArray[np.float32]:
        """Return the global features, shape (G,)."""
        robots = len(view.robots)
        active = [station for station in view.pick_stations if station.active]
        slots = sum(station.slots for station in active)
        taken = sum(len(station.orders) for station in active)
        units = sum(station.requests.units for station in view.pick_stations)
        inventory = view.inventory
        plain = np.array(
            [
                1.0 - view.now_s / view.end_s,
                len(view.orders),
                len(view.bundles),
                1.0 - taken / slots if slots else 0.0,
                units / max(len(view.pick_stations), 1),
                len(view.asking) / robots,
                len(view.resting) / robots,
                sum(robot.pod >= 0 for robot in view.robots) / robots,
                inventory.stored_space / inventory.total_capacity,
            ]
        )
        all_of_them = np.zeros(len(self.global_features), np.float32)
        all_of_them[: len(plain)] = np.clip(plain / self._scales, -LIMIT, LIMIT)
        if decision is not None:
            kind = decision.problem.value if decision.kind == "turn" else decision.kind
            all_of_them[len(plain) + self.kinds.index(kind)] = 1.0
        return all_of_them


def _checked(rankings: Mapping[str, Mapping[str, float]]) -> dict[str, dict[str, float]]:
    for kind, weights in rankings.items():
        if kind not in COLUMNS:
            raise InputError(f"rankings.{kind}: valid: {', '.join(COLUMNS)}")
        for name in weights:
            if name not in COLUMNS[kind]:
                raise InputError(f"rankings.{kind}.{name}: valid: {', '.join(COLUMNS[kind])}")
    return {kind: dict(weights) for kind, weights in rankings.items()}


def is_same(answer: Any, other: Any) -> bool:
    """Whether two answers say the same."""
    return type(answer) is type(other) and bool(answer == other)

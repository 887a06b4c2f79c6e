"""Features of candidates, for learning agents and linear rules, and a ranking of the candidates.

`rmfs.control.candidates` lists the candidates, that is, the possible answers to a question, with
their attributes. Here, the attributes that rate an answer become features: they are divided by a
scale, so that 1 is a typical value, and clipped at `LIMIT`. Attributes that only identify the
answer (the number of an order, bundle, robot, pod, station or place) are left out.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from rmfs.control.candidates import MEANINGS
from rmfs.control.problems import Problem
from rmfs.control.task_candidates import FEATURES, TaskCandidates
from rmfs.traffic import _core as compiled  # the package has one compiled library

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence

    from numpy.typing import NDArray

    from rmfs.control.candidates import Candidates
    from rmfs.control.view import View

    Weights = list[tuple[int, float]]
    """Weights of features: pairs of a feature's place in `COLUMNS` and its weight."""

LIMIT = 10.0
"""Maximum absolute value of a feature; larger values are clipped."""

KINDS: dict[Problem, tuple[str, ...]] = {
    Problem.POA: ("poa",),
    Problem.ROA: ("roa",),
    Problem.RPS: ("rps",),
    Problem.SA: ("sa",),
    Problem.MM: ("mm",),
    Problem.TA: ("ta",),
    Problem.PPS: ("pick pod", "replenishment pod", "next station"),
    Problem.PSA: ("place",),
    Problem.REPOSITIONING: ("move",),
    Problem.CA: ("ca",),
}
"""The kinds of question of each problem.

PPS, PSA and repositioning answer questions of TA; each other problem has one kind, named after it.
"""

COLUMNS: dict[str, tuple[str, ...]] = {
    "poa": (
        *("lines", "units", "inbound_units", "in_stock", "age_s", "due_in_s", "free_slots"),
        "orders_at_station",
    ),
    "roa": ("space", "free_space", "bundles", "age_s"),
    "rps": ("space", "free_space"),
    "sa": ("active", "robots"),
    "mm": (),
    "ta": FEATURES,
    "ca": ("level_share", "away_s", "robots"),
    "pick pod": ("units", "orders", "reach_s", "bring_s"),
    "replenishment pod": ("bundles", "reach_s", "bring_s"),
    "next station": ("away_s", "units", "robots"),
    "place": ("away_s", "back_s"),
    "move": ("distance_m", "reach_s"),
}
"""The features of each kind of question: columns of its candidates, or keys of `OWN_MEANINGS`."""

SCALES: dict[str, float] = {
    "lines": 5.0,
    "units": 10.0,
    "inbound_units": 5.0,
    "in_stock": 1.0,
    "age_s": 1800.0,
    "due_in_s": 1800.0,
    "free_slots": 5.0,
    "orders_at_station": 10.0,
    "space": 20.0,
    "free_space": 100.0,
    "bundles": 5.0,
    "active": 1.0,
    "robots": 5.0,
    "work": 1.0,
    "pick": 1.0,
    "store": 1.0,
    "move": 1.0,
    "rest": 1.0,
    "away_s": 30.0,
    "back_s": 30.0,
    "reach_s": 30.0,
    "bring_s": 30.0,
    "orders": 3.0,
    "distance_m": 30.0,
    "level_share": 1.0,
}
"""The scale by which each column is divided, in the unit of the column."""

OWN_MEANINGS: dict[str, tuple[str, str]] = {
    "orders_at_station": ("orders", "open orders at the station"),
    "work": ("", "1 if the robot would work for the station"),
    "store": ("", "1 if the robot would store its pod"),
    "move": ("", "1 if the robot would move an idle pod"),
    "rest": ("", "1 if the robot would rest"),
}
"""Unit and meaning of features that are not columns of candidates."""

RANKINGS: dict[str, dict[str, float]] = {
    "poa": {"in_stock": 1000.0, "inbound_units": 30.0, "age_s": 0.01, "due_in_s": -0.01},
    "roa": {"age_s": 1.0, "bundles": -1.0},
    "rps": {"free_space": 1.0},
    "sa": {"active": -1.0},
    "mm": {},
    "ta": {"work": 1000.0, "store": 500.0, "rest": -1000.0, "away_s": -1.0},
    "ca": {"level_share": -300.0, "away_s": -1.0, "robots": -10.0},
    "pick pod": {"orders": 60.0, "units": 15.0, "reach_s": -1.0, "bring_s": -1.0},
    "replenishment pod": {"bundles": 15.0, "reach_s": -1.0, "bring_s": -1.0},
    "next station": {"units": 5.0, "away_s": -1.0},
    "place": {"away_s": -1.0, "back_s": -1.0},
    "move": {"distance_m": -1.0, "reach_s": -1.0},
}
"""Weights for the ranking of candidates, for each kind of question.

The best candidates are those with the greatest weighted sums of unscaled features.
"""


class Feature(NamedTuple):
    """Name, unit, scale and meaning of a feature, whose values are divided by the scale."""

    name: str
    unit: str
    scale: float
    meaning: str


def features_of(kinds: Iterable[str]) -> tuple[Feature, ...]:
    """Return the features of some kinds of question, without repetition, in order of appearance."""
    names = dict.fromkeys(name for kind in kinds for name in COLUMNS[kind])
    told = {**{name: tuple(one) for name, one in MEANINGS.items()}, **OWN_MEANINGS}
    return tuple(Feature(name, told[name][0], SCALES[name], told[name][1]) for name in names)


def numbers(candidates: Candidates, kind: str, view: View) -> dict[str, NDArray[np.float64]]:
    """Return the unscaled features of C candidates by name, each as an array of shape (C,)."""
    return dict(zip(COLUMNS[kind], unscaled(candidates, kind, view), strict=True))


def unscaled(candidates: Candidates, kind: str, view: View) -> NDArray[np.float64]:
    """Return the F unscaled features of the C candidates, in order of `COLUMNS`, shape (F, C)."""
    if isinstance(candidates, TaskCandidates):
        return candidates.features()
    columns = candidates.columns
    found = np.empty((len(COLUMNS[kind]), len(candidates)))
    for values, name in zip(found, COLUMNS[kind], strict=True):
        if name in columns:
            values[:] = columns[name]
        else:  # of the features that are no columns, only this one is not of tasks
            orders = np.array([len(station.orders) for station in view.pick_stations], np.float64)
            values[:] = orders[columns["station"]]
    return found


def matrix(columns: Mapping[str, NDArray[np.float64]], names: Sequence[str]) -> NDArray[np.float64]:
    """Return the F features in `names` of C candidates, scaled and clipped, shape (C, F).

    `columns` contains the unscaled features by name; a feature that is missing there is 0.
    """
    count = len(next(iter(columns.values()))) if columns else 0
    found = np.zeros((count, len(names)))
    for place, name in enumerate(names):
        if name in columns:
            found[:, place] = columns[name] / SCALES[name]
    clipped: NDArray[np.float64] = found.clip(-LIMIT, LIMIT)
    return clipped


def weights_of(kind: str, rankings: Mapping[str, Mapping[str, float]] = RANKINGS) -> Weights:
    """Return the weights by which the candidates of a kind of question are ranked.

    Each entry is a pair of a feature's index in `COLUMNS[kind]` and its weight.
    """
    return [(COLUMNS[kind].index(name), weight) for name, weight in rankings[kind].items()]


def best_rows(values: NDArray[np.float64], weights: Weights, k: int) -> NDArray[np.int64]:
    """Return the rows of the k candidates whose weighted sums of features are greatest, best first.

    Features above 1e9 count as 1e9. If there are at most k candidates, all rows are returned. Ties
    go to the earlier row.

    Parameters
    ----------
    values
        The F unscaled features of the C candidates, shape (F, C).
    weights
        Pairs of a feature (row of `values`) and its weight. The terms are added in this order.
    """
    return compiled.best_rows(values, weights, k)

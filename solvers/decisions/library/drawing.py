"""The questions of the library, drawn from runs by a seeded procedure.

For each family, size of site, kind of demand and seed, a run is simulated with a set of controllers
that asks questions of the family; if there are two such sets, the runs alternate between them. The
simulated time is divided into thirds: early, middle, late. For each third, the largest tenth of its
answered questions (by number of array entries) is determined, and one of these questions is drawn
uniformly at random. Only large questions are used because many of the others concern only one robot
or one slot. `derived` makes the questions of families for which no controller asks any.
"""

from __future__ import annotations

import math
from functools import lru_cache
from typing import TYPE_CHECKING, Any

import numpy as np

from rmfs.simulation.run import simulate
from rmfs.solvers.decisions.files import Decision
from rmfs.solvers.decisions.library.derived import derived
from rmfs.solvers.decisions.library.sites import LOADS, SITES, TWICE
from rmfs.solvers.decisions.recording import QuestionListener
from rmfs.solvers.decisions.schema import SCHEMAS

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

MOMENTS = ("early", "middle", "late")
_STREAM = 20171
"""Stream name that separates these draws from others with the same seed."""


CONTROLLERS: Mapping[str, tuple[str, ...]] = {
    "pile_on": ("pile-on", "pile-on-split"),
    "planning": ("planning",),
    "placement": ("psa-placement",),
    "zones": ("psa-prices",),
    "stays": ("psa-stays",),
    "matching": ("ta-matching",),
    "balance": ("ta-balance",),
    "sequence": ("ta-routes",),
    "replenishment": ("stocking",),
    "charging": ("ca-schedule",),
}
"""Shipped sets of controllers that ask questions of each family. Runs alternate between them."""

_PARAMETERS: Mapping[str, Mapping[str, Any]] = {
    "psa-prices": {"controllers.psa.period_s": 60.0},
    "stocking": {
        "scenario.replenishment.resume_below_share": 0.8,
        "scenario.replenishment.pause_above_share": 0.9,
    },
    "ca-schedule": {
        "layout.other_stations.charger.kind": "charger",
        "layout.other_stations.charger.parameters.power_w": 1000.0,
        "scenario.energy.robot_kg": 100.0,
        "scenario.energy.battery.capacity_wh": 200.0,
        "scenario.energy.battery.initial_least_share": 0.3,
        "scenario.energy.battery.initial_most_share": 0.8,
    },
}
"""Parameters changed so that a set of controllers asks often enough during the run."""

_AS_NEEDED = frozenset({"poisson"})
"""Scenarios that order bundles when SKUs run low, so that no stock levels need to be set."""

_EASIER: Mapping[tuple[str, str], Mapping[str, Any]] = {
    ("planning", "small"): {
        "layout.robots": 3,
        "layout.pick_stations.east": 1,
        "controllers.ta.visits": 2,
    },
    ("sequence", "small"): {"layout.robots": 3, "controllers.ta.pods_per_station": 1},
    ("replenishment", "small"): {"controllers.rps.bundles": 8},
}
"""Parameters changed so that small questions can be solved to proven optimality."""

_PLACES: Mapping[tuple[str, str], Mapping[str, Any]] = {
    ("charging", "small"): {
        "layout.other_stations.charger.north": 1,
        "layout.other_stations.charger.south": 1,
    },
    ("charging", "medium"): {
        "layout.other_stations.charger.north": 3,
        "layout.other_stations.charger.south": 2,
    },
    ("charging", "real"): {
        "layout.pick_stations.north": 1,
        "layout.pick_stations.south": 1,
        "layout.other_stations.charger.north": 3,
        "layout.other_stations.charger.south": 3,
    },
    ("charging", "double"): {
        "layout.pick_stations.north": 0,
        "layout.pick_stations.south": 0,
        "layout.other_stations.charger.north": 4,
        "layout.other_stations.charger.south": 4,
    },
}
"""Plug-in places at the sides of a site; at large sites they replace pick stations."""

_FEW: Mapping[str, Mapping[str, Any]] = {
    "backlog": {"scenario.demand.orders": 10},
    "arrivals": {"scenario.demand.orders_per_h": 100, "scenario.demand.initial_orders": 10},
}


class _Kept(QuestionListener):
    """Keeps the answered questions of one family, each with its simulated time and its size."""

    def __init__(self, family: str, run: Mapping[str, Any]) -> None:
        super().__init__(run)
        self._family = family
        self.kept: list[tuple[float, int, Decision]] = []

    def take(self, decision: Decision) -> None:
        if decision.family == self._family and decision.recorded is not None:
            size = sum(np.size(value) for value in decision.data.values() if value is not None)
            self.kept.append((float(decision.provenance["time_s"]), size, decision))


def draw(family: str, size: str) -> Iterator[Decision]:
    """Draw the questions of a family and size.

    Parameters
    ----------
    family
        Name of the family, a key of `SCHEMAS`.
    size
        A key of `SITES`.

    Yields
    ------
    The questions; `provenance["drawn"]` states size, kind of demand, third of the run, and seed.
    """
    assert family in SCHEMAS
    seen: set[str] = set()
    for one in _pile_on_drawn(size) if family == "pile_on" else _drawn(family, size):
        if one.hash not in seen:
            seen.add(one.hash)
            yield one


@lru_cache(maxsize=1)
def _pile_on_drawn(size: str) -> tuple[Decision, ...]:
    """Draw the pile-on questions of a size, from which those of other families are derived."""
    return tuple(_drawn("pile_on", size))


def _drawn(family: str, size: str) -> Iterator[Decision]:
    if family not in CONTROLLERS:
        asked = () if family == "run_bound" else _pile_on_drawn(size)
        yield from derived(family, size, asked)
        return
    sets = CONTROLLERS[family]
    for load in LOADS:
        for number, seed in enumerate(SITES[size].seeds):
            # at sizes with one seed the kinds of demand take turns instead
            turn = number if len(SITES[size].seeds) > 1 else LOADS.index(load)
            yield from _of_run(family, size, load, seed, sets[turn % len(sets)])


def _of_run(family: str, size: str, load: str, seed: int, controllers: str) -> Iterator[Decision]:
    """Simulate, and draw one question of each third."""
    site = SITES[size]
    changes: dict[str, Any] = {"scenario.duration_s": site.duration_s, "scenario.warmup_s": 0.0}
    changes |= {**site.set, **(TWICE[load] if size == "double" else {})}
    if controllers != "stocking" or site.scenarios[load] not in _AS_NEEDED:
        changes |= _PARAMETERS.get(controllers, {})
    changes |= _PLACES.get((family, size), {})
    if (family, size) in _EASIER:
        changes |= {**_EASIER[family, size], **(_FEW[load] if family == "planning" else {})}
    run = {
        "layout": site.layout,
        "scenario": site.scenarios[load],
        "controllers": controllers,
        "seed": seed,
        "set": [f"{key}={value}" for key, value in changes.items()],
    }
    kept = _Kept(family, run)
    simulate(
        site.layout, site.scenarios[load], controllers, seed=seed, set=changes, observers=[kept]
    )
    rng = np.random.default_rng([_STREAM, seed, list(SITES).index(size), LOADS.index(load)])
    for third, moment in enumerate(MOMENTS):
        begin, end = (site.duration_s * (third + step) / 3 for step in (0, 1))
        some = [one for one in kept.kept if begin <= one[0] < end]
        if some:
            largest = sorted(some, key=lambda one: (-one[1], one[0]))
            most = math.ceil(len(largest) / 10)
            chosen = largest[int(rng.integers(most))][2]
            told = {"size": size, "load": load, "moment": moment, "seed": seed}
            provenance = {**chosen.provenance, "drawn": told}
            yield Decision(chosen.family, chosen.data, provenance, chosen.asked, chosen.recorded)

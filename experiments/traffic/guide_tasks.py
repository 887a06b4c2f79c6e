"""Tasks for which guidance is optimised: runs with orders, or random trips without orders."""

from __future__ import annotations

import warnings
from abc import ABC, abstractmethod
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pandas as pd

from rmfs import layout as layouts
from rmfs.errors import InputError
from rmfs.measure.objective import check_objective, objective_of, require_objective
from rmfs.simulation.idle_rules import IdleRuleWarning
from rmfs.simulation.run import simulate
from rmfs.traffic import TIME_WINDOWS
from rmfs.traffic.guidance import read_guidance
from rmfs.trips import drive, random_trips

if TYPE_CHECKING:
    from rmfs.layout.model import Layout
    from rmfs.simulation.result import Run
    from rmfs.trips import TripRun

SEEDS = (1001, 1002, 1003)
"""Default seeds; those of designs are usually small."""

KEY = "controllers.pp.guidance"


@dataclass(frozen=True)
class Task(ABC):
    """What is simulated to evaluate guidance, and the objective to maximise.

    Attributes
    ----------
    layout
        Name of a shipped layout, or a file.
    seeds
        Seeds of the runs with which guidance is evaluated.
    set
        Further parameters by dotted key, as for `rmfs.simulate`.

    Raises
    ------
    InputError
        If there is no seed, or a parameter cannot be set.
    """

    layout: str
    seeds: Sequence[int] = SEEDS
    set: Mapping[str, Any] = field(default_factory=dict)

    def __post_init__(self) -> None:
        if not self.seeds:
            raise InputError("guidance needs at least one seed")
        if KEY in self.set:
            raise InputError(f"{KEY}: is what is searched for")

    def load(self) -> Layout:
        """Return the layout."""
        own = [(key.split(".")[1:], v) for key, v in self.set.items() if key.startswith("layout.")]
        return layouts.load(self.layout, own)

    def other_seeds(self) -> list[int]:
        """Return twice as many new seeds as `seeds` has: the integers after its largest."""
        return [max(self.seeds) + 1 + number for number in range(2 * len(self.seeds))]

    @abstractmethod
    def counted(self, seed: int) -> tuple[pd.DataFrame, pd.DataFrame]:
        """Return the tables `edges` and `heat` of a run without guidance."""

    @abstractmethod
    def value(self, guidance: Path, seed: int) -> float:
        """Return the objective of a run with guidance read from a file."""


@dataclass(frozen=True)
class Orders(Task):
    """Task in which runs with orders are simulated.

    Attributes
    ----------
    scenario, controllers
        Further inputs of the simulation.
    objective
        Weights by column of the footprint; the objective is the weighted sum of the columns.

    Raises
    ------
    InputError
        As for `Task`; also if `objective` is empty or names a column that does not exist.
    """

    scenario: str = "default"
    controllers: str = "default"
    objective: Mapping[str, float] = field(default_factory=lambda: {"trip_delay_mean_s": -1.0})

    def __post_init__(self) -> None:
        super().__post_init__()
        check_objective(self.objective)
        if not self.objective:
            raise InputError("guidance needs at least one objective")

    def counted(self, seed: int) -> tuple[pd.DataFrame, pd.DataFrame]:
        """Return the tables `edges` and `heat` of a run without guidance.

        Raises
        ------
        InputError
            If the objective has no value in this run, or a column of it contains text.
        """
        run = self._run(seed, {})
        value = objective_of(run.footprint, self.objective)
        require_objective(value, self.objective, "without guidance")
        return run.table("edges"), run.table("heat")

    def value(self, guidance: Path, seed: int) -> float:
        """Return the objective of a run; -inf if a column has no finite value."""
        footprint = self._run(seed, {KEY: str(guidance)}).footprint
        return objective_of(footprint, self.objective)

    def _run(self, seed: int, more: dict[str, Any]) -> Run:
        given = {**self.set, **more}
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", IdleRuleWarning)
            return simulate(self.layout, self.scenario, self.controllers, seed=seed, set=given)


@dataclass(frozen=True)
class Trips(Task):
    """Task in which random trips without orders are simulated; the objective is trips per hour.

    Every robot always has a trip.

    Attributes
    ----------
    warmup_s, duration_s
        Length of the warm-up and length of the measured time, in s.

    Raises
    ------
    InputError
        As for `Task`; also if `set` contains a parameter that does not belong to the layout.
    """

    warmup_s: float = 300.0
    duration_s: float = 900.0

    def __post_init__(self) -> None:
        super().__post_init__()
        for key in self.set:
            if not key.startswith("layout."):
                raise InputError(f"{key}: random trips have only parameters layout.KEY")

    def counted(self, seed: int) -> tuple[pd.DataFrame, pd.DataFrame]:
        """Return the tables `edges` and `heat` of a run without guidance."""
        traffic = self.run(seed).traffic
        edges = pd.DataFrame(traffic.edges()).rename(
            columns={"from_wp": "from_waypoint", "to_wp": "to_waypoint"}
        )
        heat = traffic.heat()
        table = {name: heat[name] for name in ("visits", "waiting_s")}
        return edges, pd.DataFrame({"waypoint": np.arange(len(heat["visits"])), **table})

    def value(self, guidance: Path, seed: int) -> float:
        """Return the trips per hour of a run."""
        return self.run(seed, guidance).trips_per_h

    def run(self, seed: int, guidance: Path | None = None) -> TripRun:
        """Drive random trips, with guidance read from a file or without guidance."""
        layout = self.load()
        planner = TIME_WINDOWS._replace(
            seed=seed, guidance=() if guidance is None else read_guidance(guidance, layout)
        )
        return drive(
            layout,
            random_trips(layout, seed),
            planner,
            duration_s=self.duration_s,
            warmup_s=self.warmup_s,
        )

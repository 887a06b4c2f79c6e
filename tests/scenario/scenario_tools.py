"""A stand-in for a run, and scenarios in one line, for the tests of what comes when."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np

from rmfs.config import validate
from rmfs.scenario import Intake, Scenario, Site
from rmfs.scenario.clock import US_PER_H, US_PER_S

SITE = Site(pick_stations=4, replenishment_stations=2, capacity=1000.0, largest_pod=500.0)
DAY_US = 24 * US_PER_H

SIGNIFICANT = 0.01
"""Seeds are fixed: a test that once passes this level always does."""


def scenario(duration_s: float = 3600.0, **tables: Any) -> Scenario:
    table = {"format": "rmfs-scenario/1", "name": "test", "duration_s": duration_s, "warmup_s": 0}
    return validate(Scenario, table | tables, "test")


@dataclass
class FakeState:
    """What an intake may look at; the tests change it."""

    skus: int = 1000
    waiting_orders: int = 0
    waiting_bundles: int = 0
    stored_space: float = 700.0
    load: float = 700.0
    active_pick_share: float = 1.0
    active_replenishment_share: float = 1.0
    uncommitted: np.ndarray = field(default_factory=lambda: np.zeros(0, np.int64))
    incoming: np.ndarray = field(default_factory=lambda: np.zeros(0, np.int64))

    def __post_init__(self) -> None:
        if not len(self.uncommitted):
            self.uncommitted = np.full(self.skus, 10**6)
        if not len(self.incoming):
            self.incoming = np.zeros(self.skus, np.int64)


def drive(intake: Intake[Any], state: FakeState, until_us: int) -> list[Any]:
    """Ask an intake at time zero and whenever it wants to be asked; nothing is ever served."""
    come: list[Any] = []
    now_us = 0
    while now_us <= until_us:
        for thing in intake.due(now_us, state):
            assert thing.time_us == now_us
            come.append(thing)
            if hasattr(thing, "skus"):
                state.waiting_orders += 1
                np.subtract.at(state.uncommitted, list(thing.skus), thing.units)
            else:
                state.waiting_bundles += 1
                state.load += thing.space
                state.incoming[thing.sku] += thing.units
        assert intake.next_us > now_us
        now_us = intake.next_us
    return come


def times_s(come: list[Any]) -> np.ndarray:
    return np.array([thing.time_us for thing in come]) / US_PER_S

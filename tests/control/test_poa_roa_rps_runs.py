"""Every rule of POA, ROA and RPS in a short whole run: nothing is lost, and work gets done."""

from __future__ import annotations

from typing import Any

import pytest
from doubles import rules
from ledger import Ledger

from rmfs import layout, scenario
from rmfs.control import registry
from rmfs.control.poa.fast_lane import FastLane
from rmfs.control.problems import Problem
from rmfs.simulation.kernel import Kernel

WAITING_FOR_ROA = ("nearest", "reactive")
SHORT = {"rollout": {"candidates": 2, "samples": 2, "horizon_s": 20.0}}
"""With its defaults, trials would take most of the time of this file."""
NOT_BY_DEFAULT: list[tuple[str, dict[str, Any]]] = [
    ("poa", {"name": "first-come", "station": "least-busy", "fast_lane": True}),
    ("poa", {"name": "slack", "station": "least-busy"}),
    ("poa", {"name": "critical-ratio", "line_s": 30.0, "unit_s": 5.0}),
    ("poa", {"name": "tardiness-cost", "ahead": 0.5, "fast_lane": True}),
    ("poa", {"name": "queue", "queue_criteria": ["weight", {"criterion": "wave", "wave_s": 60.0}]}),
    ("poa", {"name": "due-time", "station": "most-busy", "stick_to_station": True}),
    ("poa", {"name": "foresight", "score": "surplus", "tie_breaker": "depletion"}),
    ("poa", {"name": "lines-in-common", "fast_lane": True, "tie_breaker": "random"}),
    ("poa", {"name": "wave", "wave_s": 600.0, "missed_last": True}),
    ("poa", {"name": "queue", "queue_criteria": ["related", "random"], "fast_lane": False}),
    ("roa", {"name": "same-pod", "break_batches": True, "station": "random"}),
    ("roa", {"name": "same-pod", "station": "emptiest", "first_come_first_served": False}),
    ("rps", {"name": "turnover", "emptiest": False, "reallocation_orders": 20}),
    ("rps", {"name": "reactive", "among_equals": "emptiest"}),
]


def cases() -> list[tuple[str, dict[str, Any]]]:
    """All rules with their defaults, but for `SHORT`, then some with other parameters."""
    names = [
        (str(problem), {"name": name} | SHORT.get(name, {}))
        for problem in (Problem.POA, Problem.ROA, Problem.RPS)
        for name in registry.built_in(problem)
        if not registry.find(problem, name).is_dummy
    ]
    return names + NOT_BY_DEFAULT


@pytest.fixture(scope="module")
def warehouse() -> layout.Layout:
    return layout.load("default", [(["robots"], 12)])


@pytest.mark.parametrize(
    ("problem", "table"), cases(), ids=[f"{p}-{'-'.join(map(str, t.values()))}" for p, t in cases()]
)
def test_stock_and_requests_are_conserved(warehouse, problem, table) -> None:
    """300 s from the start: orders get slots, units are picked, and bundles find pods.

    Pods are released at a third of their capacity, so that bundles are stored within the time.
    """
    tables: dict[str, Any] = {"rps": {"name": "emptiest", "buffer_threshold": 0.3}}
    if problem == "rps":
        release = "buffer_thresholds" if table["name"] == "turnover" else "buffer_threshold"
        tables = {"rps": {release: [0.3] * 3 if release.endswith("s") else 0.3}}
        if table["name"] in WAITING_FOR_ROA:
            tables["roa"] = {"name": "random"}
    tables[problem] = tables.get(problem, {}) | table
    work = scenario.load("default", [(["duration_s"], 300.0), (["warmup_s"], 0.0)])
    ledger = Ledger()
    simulation = Kernel(warehouse, work, rules(**tables), observers=[ledger])
    simulation.run()
    ledger.check()
    world = simulation.world
    assert world.units_picked > 20
    assert world.bundles_stored > 0


def test_the_fast_lane_misses_no_order(warehouse, monkeypatch) -> None:
    """Whenever it is asked, it names each station whose pod can complete an order."""
    promising = FastLane.promising
    found: set[tuple[int, int]] = set()

    def checked(lane: FastLane) -> list[int]:
        named, view = promising(lane), lane._view
        for station in view.pick_stations:
            if station.robot < 0 or not station.active or not station.free_slots:
                assert station.index not in named
                continue
            stock = view.inventory.available[:, view.robots[station.robot].pod]
            for order in view.orders.orders.values():
                if all(stock[line.sku] >= line.units for line in order.lines):
                    assert station.index in named
                    found.add((station.index, order.index))
        return named

    monkeypatch.setattr(FastLane, "promising", checked)
    work = scenario.load("default", [(["duration_s"], 600.0), (["warmup_s"], 0.0)])
    Kernel(warehouse, work, rules(poa={"name": "pod-match"})).run()
    assert len({order for _, order in found}) > 20

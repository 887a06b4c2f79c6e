"""Any controller of any problem can be exchanged at any time: nothing promised is lost.

A method manager draws problems, rules and times at random, hundreds of exchanges in all, joint
controllers with their dummies included. The ledger, which knows nothing of controllers, and
`verify` must agree with the world throughout; and once the exchanges are over, everything that was
on a station or promised to a pod by then gets done.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from hand_made import HandMade

from rmfs.control import registry
from rmfs.control.base import NoParameters
from rmfs.control.choices import DEFAULTS, Choice, check_together, choose
from rmfs.control.decisions import Exchange
from rmfs.control.mm import MethodManagement
from rmfs.control.problems import Problem
from rmfs.errors import InputError
from rmfs.observer import Observer
from rmfs.world import verify

if TYPE_CHECKING:
    from collections.abc import Iterator

    from ledger import Ledger

    from rmfs.world import Bundle

EXCHANGED_UNTIL_S = 1500.0
DURATION_S = 5400.0
GAP_S = 40.0
JOINT = {Problem.POA: "joint:Joint", Problem.ROA: "joint:JointSupply"}
FAST_RELEASE = {"buffer_threshold": 0.6, "buffer_timeout_s": 100.0}
PARAMETERS: dict[tuple[Problem, str], dict[str, Any]] = {
    (Problem.RPS, name): FAST_RELEASE
    for name in ("emptiest", "least-demand", "correlative", "nearest", "reactive", "random")
} | {
    (Problem.POA, "queue"): {"queue_length": 3},
    (Problem.POA, "near-best-pod"): {"metric": "manhattan"},
    (Problem.SA, "backlog-threshold"): {"pause_s": 30.0, "orders_on": 4, "bundles_on": 4},
    (Problem.SA, "work-shifts"): {
        "shifts": [{"at_s": 0.0, "on": True}, {"at_s": 60.0, "on": False}],
        "loop_s": 120.0,
    },
}


def choice(problem: Problem, name: str) -> Choice:
    return choose(problem, {"name": name, **PARAMETERS.get((problem, name), {})}, "test")


def all_choices() -> list[Choice]:
    """Every built-in rule, and joint ones; dummies come with these.

    Not those of MM, nor those that look ahead: they need traffic that can be copied.
    """
    made = [
        choice(problem, name)
        for problem in Problem
        for name in registry.built_in(problem)
        if problem is not Problem.MM and name != "rollout"
        if not registry.find(problem, name).is_dummy
    ]
    return [*made, *(choice(problem, name) for problem, name in JOINT.items())]


def start() -> dict[Problem, Choice]:
    return {problem: choice(problem, name) for problem, name in DEFAULTS.items()}


class Whim(MethodManagement[NoParameters]):
    """Installs rules drawn at random, with partners that go with them, every 40 s on average."""

    seed = 0
    installed: list[Choice]

    def __init__(self, *given: Any) -> None:
        super().__init__(*given)
        self._random = np.random.default_rng(Whim.seed)
        self._now = start()
        self._next_s = 0.0
        self._over = False
        Whim.installed = []

    def next_event_s(self) -> float:
        return np.inf if self._over else self._next_s

    def decide(self) -> Iterator[Exchange]:
        if self._over or self.view.now_s < self._next_s:
            return
        self._over = self.view.now_s >= EXCHANGED_UNTIL_S
        wanted = start() if self._over else self._draw()
        for problem, new in wanted.items():
            if problem is not Problem.MM and (self._over or new != self._now[problem]):
                Whim.installed.append(new)
                yield Exchange(new)
        self._now = wanted
        self._next_s = self.view.now_s + float(self._random.exponential(GAP_S))

    def _draw(self) -> dict[Problem, Choice]:
        """Exchange up to three rules, drawing again until all go together."""
        everything = all_choices()
        while True:
            wanted = dict(self._now)
            for number in self._random.choice(len(everything), 1 + self._random.integers(3)):
                wanted[everything[number].problem] = everything[number]
            taken = {p for c in wanted.values() for p in c.controller.decides}
            for problem, found in wanted.items():
                if problem in taken:
                    wanted[problem] = choice(problem, "dummy")
                elif found.controller.is_dummy:
                    wanted[problem] = choice(problem, DEFAULTS[problem])
            try:
                check_together(wanted, "test")
            except InputError:
                continue
            return wanted


def small(seed: int, *observers: Observer) -> HandMade:
    """Five robots, unhindered, and always work."""
    Whim.seed = seed
    return HandMade(
        {"robots": 5, "places": 16, "pods": 11, "pick_stations": 2, "replenishment_stations": 2},
        {
            "duration_s": DURATION_S,
            "stock": {"initial_share": 0.5},
            "demand": {"mode": "backlog", "orders": 12},
            "replenishment": {"mode": "backlog", "bundles": 12},
        },
        observers,
        mm={"name": f"{__name__}:Whim"},
        rps={"name": "emptiest", **FAST_RELEASE},
    )


class Bundles(Observer):
    """Remembers bundles whose pod and station were decided; recounts the world at each exchange."""

    def __init__(self) -> None:
        self.assigned: list[Bundle] = []

    def run_started(self, simulation):
        self.world = simulation.world

    def controller_exchanged(self, time_s, problem, name):
        verify(self.world)
        if (problem, name) == ("rps", "dummy"):
            assert not self.world.bundles.unreleased, "nobody would release these"

    def bundle_assigned(self, bundle):
        self.assigned.append(bundle)


def check_nothing_was_lost(ledger: Ledger, bundles: Bundles) -> None:
    """Whatever had a slot, or a pod and a station, when the exchanges ended has been done."""
    ledger.check()
    orders = [o for o in ledger.orders.values() if o.assigned_s <= EXCHANGED_UNTIL_S]
    assigned = [b for b in bundles.assigned if b.assigned_s <= EXCHANGED_UNTIL_S]
    assert len(orders) > 20
    assert len(assigned) > 5
    assert [order.index for order in orders if not order.completed_s > 0] == []
    assert [bundle.index for bundle in assigned if not bundle.stored_s > 0] == []
    held_back = [b for held in ledger.world.bundles.unreleased.values() for b in held]
    assert [b.index for b in held_back if b.created_s <= EXCHANGED_UNTIL_S] == []


@pytest.mark.parametrize(
    "seed", [*range(8), *(pytest.param(s, marks=pytest.mark.slow) for s in range(8, 200))]
)
def test_promises_outlive_whoever_made_them(seed) -> None:
    bundles = Bundles()
    made = small(seed, bundles)
    made.run()
    problems = {new.problem for new in Whim.installed}
    assert len(Whim.installed) > 30
    assert len(problems) > 6
    check_nothing_was_lost(made.ledger, bundles)

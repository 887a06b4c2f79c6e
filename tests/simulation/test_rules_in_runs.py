"""Every rule for tasks, pods and places in a short whole run, and exchanges in the middle of one.

Real traffic, the default layout with few robots; stock and requests are conserved.
"""

from __future__ import annotations

from typing import Any

import pytest
from ledger import Ledger

from rmfs import layout, scenario
from rmfs.control import registry
from rmfs.control.problems import Problem
from rmfs.control.settings import DEFAULTS, settings
from rmfs.observer import Observer
from rmfs.simulation.kernel import Kernel

DUMMY = {"name": "dummy"}
ANY_QUEUED = {"consider": "assigned-and-queued", "reserve": "assigned-and-queued"}


def named(**rules: Any) -> dict[str, Any]:
    """Let a plain name stand for a rule with its defaults."""
    return {key: {"name": rule} if isinstance(rule, str) else rule for key, rule in rules.items()}


class Exchanges(Observer):
    """What was installed when."""

    def __init__(self) -> None:
        self.told: list[tuple[float, str, str]] = []

    def controller_exchanged(self, time_s, problem, name):
        self.told.append((time_s, problem, name))


def run(
    robots: int = 12, duration_s: float = 300.0, observers: tuple[Observer, ...] = (), **rules: Any
) -> tuple[Kernel, Ledger]:
    plan = layout.load("default", [(["robots"], robots)])
    work = scenario.load("basic", [(["duration_s"], duration_s), (["warmup_s"], 0.0)])
    table = {"format": "rmfs-controllers/1", "name": "test", **named(**rules)}
    ledger = Ledger()
    simulation = Kernel(plan, work, settings(table), observers=[ledger, *observers])
    simulation.run()
    ledger.check()
    return simulation, ledger


def kinds(ledger: Ledger) -> set[str]:
    return {entry[1] for entry in ledger.log}


RUNS: dict[str, dict[str, Any]] = {
    "psa random": {"psa": "random"},
    "psa nearest path": {"psa": {"name": "nearest", "metric": "path"}},
    "psa nearest manhattan": {"psa": {"name": "nearest", "metric": "manhattan"}},
    "psa fixed": {"psa": "fixed"},
    "psa station-based": {"psa": "station-based"},
    "psa turnover": {"psa": "turnover"},
    "psa cache": {"psa": "cache"},
    "psa utility": {"psa": "utility"},
    "pps random": {"pps": "random"},
    "pps all criteria": {
        "pps": {
            "pick_pod": [
                "fill",
                "demand",
                "age",
                "lateness",
                "completeable",
                "pile-on",
                {"criterion": "nearest", "metric": "path"},
                "random",
            ],
            "replenishment_pod": [{"criterion": "work-amount", "age": True}, "demand", "random"],
            "next_station": ["age", "nearest", "random"],
        },
        "ta": {"other_stations": True, "search_radius_m": 30.0},
    },
    "pps waves": {"pps": {"pick_pod": [{"criterion": "wave", "wave_s": 300.0}, "pile-on"]}},
    "pps exact times": {
        "pps": {"pick_pod": [{"criterion": "work-amount", "estimate_to_pod": False}]}
    },
    "pps without late binding": {"pps": {"late_picks": False, "late_bundles": False}},
    "pps queued orders": {"poa": "queue"},
    "pps all queued orders": {"poa": "queue", "pps": ANY_QUEUED},
    "ta search all": {"ta": {"search_all": True}},
    "ta constant-ratio": {"ta": "constant-ratio"},
    "ta random": {"ta": "random", "pps": DUMMY},
    "ta brute-force": {"ta": "brute-force", "pps": DUMMY, "psa": DUMMY},
    "ta swarm": {"ta": "swarm"},
    "sa constant-ratio": {"sa": "constant-ratio"},
    "sa backlog-threshold": {"sa": {"name": "backlog-threshold", "pause_s": 30.0}},
    "sa staffed": {"sa": "staffed"},
    "sa work-shifts": {
        "sa": {
            "name": "work-shifts",
            "shifts": [{"at_s": 0.0, "on": True}, {"at_s": 60.0, "on": False}],
            "loop_s": 120.0,
        }
    },
    "mm random": {"mm": {"name": "random", "period_s": 40.0}},
    "linear": {"poa": "linear", "pps": "linear", "psa": "linear", "ta": "linear"},
    "joint controller": {"poa": "joint:Joint", "pps": DUMMY, "psa": DUMMY},
}


@pytest.mark.parametrize("name", RUNS)
def test_every_rule_works_in_a_run(name) -> None:
    simulation, _ = run(**RUNS[name])
    assert simulation.world.orders_completed > 15
    assert simulation.world.bundles_stored > 0 or name == "ta brute-force"


@pytest.mark.parametrize(
    "rules",
    [
        {"repositioning": "cache"},
        {"repositioning": "utility"},
        {
            "repositioning": {"name": "cache-drop-off", "drop_off_places": 4},
            "psa": {"name": "cache", "drop_off_places": 4},
        },
        {
            "repositioning": "utility",
            "ta": {"reposition_weight": 1.0, "reposition_before_rest": False},
        },
        {
            "repositioning": "cache",
            "ta": {"name": "random", "reposition_probability": 0.5},
            "pps": DUMMY,
        },
    ],
    ids=["cache", "utility", "cache-drop-off", "robots set aside", "ta random"],
)
def test_idle_pods_are_moved(rules) -> None:
    """40 robots, more than find work; pods are moved and others are still brought."""
    simulation, ledger = run(robots=40, **rules)
    assert {"reposition", "pick", "replenish", "park"} <= kinds(ledger)
    assert simulation.world.orders_completed > 30


def test_fixed_places_stay_fixed() -> None:
    simulation, _ = run(psa="fixed", duration_s=600.0)
    storage = simulation.world.storage
    own = simulation.layout.pod_waypoint.tolist()
    moved = [pod for pod, place in enumerate(storage.place_of) if place not in (-1, own[pod])]
    assert moved == []


def test_no_rule_is_left_out() -> None:
    """Every built-in rule of these problems is the default or stands above."""
    tested = {rule for rules in RUNS.values() for rule in _pairs(rules)}
    tested |= {("repositioning", name) for name in ("none", "cache", "cache-drop-off", "utility")}
    tested |= {("mm", "none"), ("mm", "scheduled")}
    tested |= {("ta", "rollout")}  # in test_lookahead.py
    tested |= {(problem, "network") for problem in ("pps", "psa", "ta")}  # test_network_rules.py
    for problem in (Problem.PPS, Problem.PSA, Problem.TA, Problem.SA, Problem.MM):
        for name in registry.built_in(problem):
            default = DEFAULTS[problem] == name
            assert default or name == "dummy" or (str(problem), name) in tested


def _pairs(rules: dict[str, Any]) -> list[tuple[str, str]]:
    return [
        (problem, rule.get("name", DEFAULTS[Problem(problem)]))
        for problem, rule in named(**rules).items()
    ]


EXCHANGES: dict[str, list[dict[str, Any]]] = {
    "poa": [{"poa": "queue"}, {"poa": "random"}],
    "roa": [{"roa": "random"}, {"roa": "same-pod"}],
    "rps": [{"rps": "random"}, {"rps": {"name": "emptiest", "buffer_threshold": 0.5}}],
    "pps": [{"pps": "random"}, {"pps": {"name": "lexicographic", "late_picks": False}}],
    "psa": [{"psa": "random"}, {"psa": "cache"}],
    "repositioning": [{"repositioning": "utility"}, {"repositioning": "none"}],
    "ta": [{"ta": "swarm"}, {"ta": "constant-ratio"}],
    "sa": [{"sa": "constant-ratio"}, {"sa": "all"}],
    "pp": [{"pp": "time-windows"}, {"pp": "time-windows"}],
    "mm": [
        {"psa": "random"},
        {"mm": {"name": "random", "period_s": 10.0, "alternatives": [{"psa": "nearest"}]}},
    ],
    "several at once": [
        {"ta": "brute-force", "pps": "dummy", "psa": "dummy"},
        {"ta": "balanced", "pps": "lexicographic", "psa": "utility"},
    ],
    "ta random and back": [{"ta": "random", "pps": "dummy"}, {"ta": "balanced", "pps": "random"}],
}


@pytest.mark.parametrize("name", EXCHANGES)
def test_every_controller_can_be_exchanged_twice_in_mid_run(name) -> None:
    """At 120 and 240 of 360 s; what was promised is carried on with or given back, nothing is lost.

    Picks and stores go on after each exchange.
    """
    exchanges = [
        {"at_share": share, **entry}
        for share, entry in zip((1 / 3, 2 / 3), EXCHANGES[name], strict=True)
    ]
    told = Exchanges()
    simulation, ledger = run(
        robots=32,
        duration_s=360.0,
        observers=(told,),
        mm={"name": "scheduled", "exchanges": exchanges},
    )
    for share, entry in zip((1 / 3, 2 / 3), EXCHANGES[name], strict=True):
        for problem in entry:
            assert any(t == share * 360 and p == problem for t, p, _ in told.told)
    for begin_s, end_s in ((0, 120), (120, 240), (240, 360)):
        during = [entry for entry in ledger.log if begin_s <= entry[0] < end_s]
        assert sum(entry[1] == "pick" for entry in during) > 40
    assert simulation.world.bundles_stored > 20
    last = {problem: rule for entry in EXCHANGES[name] for problem, rule in named(**entry).items()}
    for problem, rule in last.items():
        if problem != "pp" and name != "mm":
            assert simulation.deciding.statistics[Problem(problem)].name == rule["name"]


def test_pools_are_emptied_when_poa_queue_goes() -> None:
    simulation, _ = run(
        robots=32,
        poa="queue",
        pps=ANY_QUEUED,
        mm={"name": "scheduled", "exchanges": [{"at_s": 150.0, "poa": "pod-match"}]},
    )
    assert all(not station.queued for station in simulation.world.pick_stations)
    assert simulation.world.orders_completed > 40


def test_bundles_held_back_are_released_by_the_next_rule() -> None:
    """RPS holds everything back (no time-out within the run); the next releases what it finds."""
    rps = {"name": "random", "buffer_threshold": 1.0, "buffer_timeout_s": 1e6}
    exchange = {"at_s": 100.0, "rps": {"name": "random", "buffer_timeout_s": 0.0}}
    held, _ = run(rps=rps)
    freed, _ = run(rps=rps, mm={"name": "scheduled", "exchanges": [exchange]})
    assert held.world.bundles_stored < freed.world.bundles_stored
    assert len(freed.world.bundles.unreleased) < len(held.world.bundles.unreleased)


def test_the_same_seed_gives_the_same_run_with_exchanges() -> None:
    def log():
        return run(mm={"name": "random", "period_s": 30.0}, repositioning="cache")[1].log

    assert log() == log()

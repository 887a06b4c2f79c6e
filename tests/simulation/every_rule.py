"""Every built-in rule, with the partners it needs, in a small warehouse that always has work."""

from __future__ import annotations

from typing import Any

from hand_made import HandMade

from rmfs.control import registry
from rmfs.control.problems import Problem

EARLY = {"buffer_threshold": 0.6, "buffer_timeout_s": 100.0}
PARTNERS: dict[tuple[str, str], dict[str, Any]] = {
    ("rps", "nearest"): {"roa": "random"},
    ("rps", "reactive"): {"roa": "random"},
    ("ta", "random"): {"pps": "dummy"},
    ("ta", "brute-force"): {"pps": "dummy", "psa": "dummy"},
    ("repositioning", "cache-drop-off"): {"psa": {"name": "cache", "drop_off_places": 1}},
}
PARAMETERS: dict[tuple[str, str], dict[str, Any]] = {
    ("poa", "near-best-pod"): {"metric": "manhattan"},
    ("sa", "backlog-threshold"): {"pause_s": 60.0, "orders_on": 5, "bundles_on": 5},
    ("sa", "work-shifts"): {
        "shifts": [{"at_s": 0.0, "on": True}, {"at_s": 200.5, "on": False}],
        "loop_s": 250.0,
    },
    ("mm", "scheduled"): {
        "exchanges": [{"at_s": 100.0, "poa": "random"}, {"at_s": 300.0, "psa": "random"}]
    },
    ("mm", "random"): {
        "period_s": 70.0,
        "alternatives": [{"psa": "nearest"}, {"poa": "first-come"}],
    },
    ("repositioning", "cache-drop-off"): {"drop_off_places": 1},
}


def rules_of(*problems: Problem) -> list[tuple[Problem, str]]:
    """List the rules of some problems, dummies apart, and those that copy the run they are in."""
    return [
        (problem, name)
        for problem in problems
        for name in registry.built_in(problem)
        if not (rule := registry.find(problem, name)).is_dummy and not rule.looks_ahead
    ]


def tables_of(problem: Problem, name: str) -> dict[str, dict[str, Any]]:
    """Return the controllers file in which a rule works, and pods are released early."""
    key = (str(problem), name)
    partners = {
        k: {"name": t} if isinstance(t, str) else t for k, t in PARTNERS.get(key, {}).items()
    }
    fields = registry.find(problem, name).parameters_model.model_fields
    own = {k: v for k, v in EARLY.items() if k in fields and problem is Problem.RPS}
    own |= {"name": name, **PARAMETERS.get(key, {})}
    return {"rps": {"name": "emptiest", **EARLY}, **partners, str(problem): own}


def always_busy(duration_s: float, *observers: Any, **tables: Any) -> HandMade:
    """Set up four unhindered robots, eight orders and eight bundles that always wait."""
    return HandMade(
        {"robots": 4, "places": 14, "pods": 9, "pick_stations": 2, "replenishment_stations": 2},
        {
            "duration_s": duration_s,
            "stock": {"initial_share": 0.5},
            "demand": {"mode": "backlog", "orders": 8},
            "replenishment": {"mode": "backlog", "bundles": 8},
        },
        observers,
        **tables,
    )

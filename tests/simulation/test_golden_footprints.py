"""What must not change by accident: footprints and motion of many runs, as hashes.

`python tests/simulation/test_golden_footprints.py` writes them again; the change log then says
which changed and why.
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

import rmfs
from rmfs.simulation.kernel import Kernel

GOLDEN = Path(__file__).with_name("golden_footprints.json")

SHORT = {"scenario.warmup_s": 120, "scenario.duration_s": 900}
DISTURBED = {
    "scenario.disturbances.breakdowns": {"every_s": 120, "lasting_s": 30},
    "scenario.disturbances.slow": {"every_s": 200, "lasting_s": 60, "speed_share": 0.5},
    "scenario.disturbances.closures": {"every_s": 300, "lasting_s": 60},
}
EXCHANGES = {
    "controllers.mm": {
        "name": "scheduled",
        "exchanges": [
            {"at_s": 200.0, "psa": "random"},
            {"at_s": 400.0, "poa": "queue"},
            {"at_s": 500.0, "ta": "constant-ratio"},
            {"at_s": 700.0, "poa": "related"},
        ],
    }
}


def case(
    layout: str,
    scenario: str,
    controllers: str = "default",
    seed: int = 1,
    pacing: str = "instant",
    **given: Any,
) -> dict[str, Any]:
    keys = {key.replace("__", "."): value for key, value in given.items()}
    return {
        "layout": layout,
        "scenario": scenario,
        "controllers": controllers,
        "seed": seed,
        "pacing": pacing,
        "overrides": [(key.split("."), value) for key, value in (SHORT | keys).items()],
    }


RULES = {
    "default": case("default", "default", layout__robots=16),
    "default, other seed": case("default", "default", seed=7, layout__robots=24),
    "random rules": case("default", "default", "random", layout__robots=16),
    "small": case("small", "small"),
    "arrivals": case("small", "small-arrivals", seed=3),
    "sequ": case("small", "small-arrivals", "sequ"),
    "elevators": case("study-tiers", "pp-minimal", scenario__duration_s=300),
    "basic": case("basic", "basic"),
    "shifts": case("default", "shifts", layout__robots=8),
    "poisson": case("default", "poisson", layout__robots=12),
    "letters": case("default", "letters", layout__robots=8),
    "disturbed": case("default", "default", layout__robots=16, **DISTURBED),
    "exchanged": case("default", "default", layout__robots=12, **EXCHANGES),
    "cache": case(
        "default",
        "default",
        layout__robots=12,
        controllers__psa="cache",
        controllers__repositioning="cache",
    ),
    "swarm": case("default", "default", layout__robots=12, controllers__ta="swarm"),
    "queue": case("default", "default", layout__robots=12, controllers__poa="queue"),
    "far": case("default", "default", layout__robots=12, controllers__pp="far"),
    "whca": case("small", "small", controllers__pp="whca-n"),
    "pibt": case("small", "small", controllers__pp="pibt"),
}
"""Decided by rules: equal on all machines of an architecture."""

OPTIMISERS = {
    name: case("small", scenario, name, pacing=pacing, scenario__duration_s=600)
    for name, scenario, pacing in [
        ("pile-on", "small", "instant"),
        ("pile-on-split", "small-arrivals", "work"),
        ("pile-on-dispatch", "small", "work"),
        ("hadgs", "small-arrivals", "instant"),
        ("m1g", "small", "work"),
        ("solver", "small", "work"),
        ("psa-prices", "small", "fixed=2"),
        ("psa-stays", "small", "work"),
        ("ta-routes", "small", "work"),
        ("ta-balance", "small-arrivals", "instant"),
        ("stocking", "small", "work"),
    ]
}
"""Decided by solvers: equal on one machine, not promised across processors."""


def hashes(
    given: dict[str, Any], columns: list[str], driver: Callable[..., None] = Kernel.run
) -> dict[str, str]:
    """Run a case; hash what it measured and how its robots moved."""
    run = rmfs.simulate(**given, trace=True, driver=driver)
    footprint = run.footprint[columns].to_json(double_precision=15)
    motion = hashlib.sha256()
    for name, values in sorted(run.trace.items()):
        if name == "top_speed_m_s":
            continue  # follows from when who was slow, and came after the hashes
        motion.update(name.encode())
        motion.update(values.tobytes())
    return {
        "footprint": hashlib.sha256(footprint.encode()).hexdigest()[:24],
        "motion": motion.hexdigest()[:24],
    }


def written() -> dict[str, Any]:
    golden: dict[str, Any] = json.loads(GOLDEN.read_text("utf-8"))
    return golden


@pytest.mark.parametrize("name", RULES)
def test_a_run_with_rules_is_as_it_was(name: str) -> None:
    golden = written()
    assert hashes(RULES[name], golden["columns"]) == golden["runs"][name]


@pytest.mark.slow
@pytest.mark.parametrize("name", OPTIMISERS)
def test_a_run_with_optimisers_is_as_it_was(name: str) -> None:
    golden = written()
    assert hashes(OPTIMISERS[name], golden["columns"]) == golden["runs"][name]


def main() -> None:
    from rmfs.measure.dictionary import reproducible

    columns = reproducible("footprint") if not GOLDEN.exists() else written()["columns"]
    runs = {name: hashes(given, columns) for name, given in (RULES | OPTIMISERS).items()}
    GOLDEN.write_text(json.dumps({"columns": columns, "runs": runs}, indent=1) + "\n", "utf-8")


if __name__ == "__main__":
    main()

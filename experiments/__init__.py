"""Experiments: designs, runners, tables and statistics.

plan = experiments.plan("fleet-size")
experiments.run(plan, "results/fleet-size")
frame = experiments.load("results/fleet-size")
"""

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from experiments.design.planning import Plan as Plan
    from experiments.design.planning import plan as plan
    from experiments.results import failures as failures
    from experiments.results import load as load
    from experiments.results import reproducible_table as reproducible_table
    from experiments.running import run as run

_PLACES = {
    "Plan": "experiments.design.planning",
    "plan": "experiments.design.planning",
    "failures": "experiments.results",
    "load": "experiments.results",
    "reproducible_table": "experiments.results",
    "run": "experiments.running",
}


def __getattr__(name: str) -> Any:
    """Import what is asked for: the command line shall answer at once."""
    if name in _PLACES:
        import importlib

        return getattr(importlib.import_module(_PLACES[name]), name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")

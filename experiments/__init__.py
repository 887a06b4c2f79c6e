"""Experiments: designs, runners, tables and statistics.

Example::

    plan = experiments.plan("fleet-size")
    experiments.run(plan, "results/fleet-size")
    frame = experiments.load("results/fleet-size")
"""

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from rmfs.experiments.design.planning import Plan as Plan
    from rmfs.experiments.design.planning import plan as plan
    from rmfs.experiments.results import failures as failures
    from rmfs.experiments.results import load as load
    from rmfs.experiments.results import reproducible_table as reproducible_table
    from rmfs.experiments.running import run as run

_PLACES = {
    "Plan": "rmfs.experiments.design.planning",
    "plan": "rmfs.experiments.design.planning",
    "failures": "rmfs.experiments.results",
    "load": "rmfs.experiments.results",
    "reproducible_table": "rmfs.experiments.results",
    "run": "rmfs.experiments.running",
}


def __getattr__(name: str) -> Any:
    """Import an exported name on first use, so that the command line responds at once."""
    if name in _PLACES:
        import importlib

        return getattr(importlib.import_module(_PLACES[name]), name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")

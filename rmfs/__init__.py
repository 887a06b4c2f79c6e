"""Simulation of Robotic Mobile Fulfillment Systems."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from rmfs.experiments.study import Study as Study
    from rmfs.experiments.study import experiment as experiment
    from rmfs.measure.base import Measure as Measure
    from rmfs.measure.columns import Column as Column
    from rmfs.measure.folder import RunFolder as RunFolder
    from rmfs.measure.folder import load_run as load_run
    from rmfs.simulation.result import Run as Run
    from rmfs.simulation.run import Simulation as Simulation
    from rmfs.simulation.run import simulate as simulate

_PLACES = {
    "Column": "rmfs.measure.columns",
    "Measure": "rmfs.measure.base",
    "RunFolder": "rmfs.measure.folder",
    "Study": "rmfs.experiments.study",
    "experiment": "rmfs.experiments.study",
    "load_run": "rmfs.measure.folder",
    "Run": "rmfs.simulation.result",
    "Simulation": "rmfs.simulation.run",
    "simulate": "rmfs.simulation.run",
}

__all__ = [
    "Column",
    "Measure",
    "Run",
    "RunFolder",
    "Simulation",
    "Study",
    "experiment",
    "load_run",
    "simulate",
]


def __getattr__(name: str) -> Any:
    """Import an exported name when it is first used, so that unused parts are never loaded."""
    if name == "__version__":
        from importlib.metadata import version

        return version("rmfs")
    if name in _PLACES:
        import importlib

        return getattr(importlib.import_module(_PLACES[name]), name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")

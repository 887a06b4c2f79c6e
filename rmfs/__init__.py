"""Simulation of Robotic Mobile Fulfillment Systems."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from rmfs.simulation.run import Run as Run
    from rmfs.simulation.run import simulate as simulate

__all__ = ["Run", "simulate"]


def __getattr__(name: str) -> Any:
    """Load what is exported when it is first used: parts of the package need less than all."""
    if name in __all__:
        from rmfs.simulation import run

        return getattr(run, name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")

"""What can go wrong with an optimiser in the loop so that a run has to stop."""

from __future__ import annotations


class OptimiserError(RuntimeError):
    """An optimiser failed where a run must repeat: going on by the rule would hide it."""


class ReplayError(RuntimeError):
    """A run that is replayed has come to another state than the one that was recorded."""

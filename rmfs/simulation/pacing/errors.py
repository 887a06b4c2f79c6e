"""Errors of optimisers that stop a run."""

from __future__ import annotations

from rmfs.errors import ReplayError as ReplayError


class OptimiserError(RuntimeError):
    """An optimiser failed in a reproducible run, where falling back to the rule would hide it."""

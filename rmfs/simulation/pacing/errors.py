"""Errors of optimisers that stop a run."""

from __future__ import annotations

from rmfs.errors import ReplayError as ReplayError


class OptimiserError(RuntimeError):
    """An optimiser failed in a reproducible run, or its worker process could not start.

    In a reproducible run, falling back to the rule would hide the failure.
    """

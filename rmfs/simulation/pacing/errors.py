"""Errors of optimisers that stop a run."""

from __future__ import annotations


class OptimiserError(RuntimeError):
    """An optimiser failed in a reproducible run, where falling back to the rule would hide it."""


class ReplayError(RuntimeError):
    """A replayed run deviates from the recorded one."""

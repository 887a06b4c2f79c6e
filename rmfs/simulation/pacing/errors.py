"""Errors that stop a run in which controllers ask optimisers."""

from __future__ import annotations

from rmfs.errors import ReplayError as ReplayError


class OptimiserError(RuntimeError):
    """An optimiser failed with a pacing other than `wall`, or a worker process could not start.

    With a pacing other than `wall`, results are reproducible. Therefore, the controller's own rule
    does not take over after a failure, as this would hide the failure.
    """

"""Fewer garbage collections during a run."""

from __future__ import annotations

import gc
from contextlib import contextmanager
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterator

ALLOCATIONS = 100_000
"""New objects after which the garbage collector looks for cycles among them."""


@contextmanager
def fewer_collections() -> Iterator[None]:
    """Reduce the number of garbage collections within the context.

    A run creates hardly any reference cycles. At the end, the collector's thresholds are restored.
    A threshold of 0 (no collections) is kept.
    """
    before = gc.get_threshold()
    if 0 < before[0] < ALLOCATIONS:
        gc.set_threshold(ALLOCATIONS, *before[1:])
    try:
        yield
    finally:
        gc.set_threshold(*before)

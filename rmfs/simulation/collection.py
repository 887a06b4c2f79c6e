"""Fewer garbage collections while a run goes on."""

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
    """Let the garbage collector look for cycles less often, as a run makes hardly any.

    The collector's thresholds are restored at the end. A threshold of 0 (no collections) is kept.
    """
    before = gc.get_threshold()
    if 0 < before[0] < ALLOCATIONS:
        gc.set_threshold(ALLOCATIONS, *before[1:])
    try:
        yield
    finally:
        gc.set_threshold(*before)

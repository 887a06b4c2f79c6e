"""Checks in advance whether a run, or a layout to be generated, fits into memory."""

from __future__ import annotations

import re
import resource
from contextlib import contextmanager
from contextvars import ContextVar
from pathlib import Path
from typing import TYPE_CHECKING

from rmfs.errors import InputError

if TYPE_CHECKING:
    from collections.abc import Iterator

TILE_BYTES = 1600
"""Bytes of a layout per tile of its area, measured for 10,000 to 100,000 tiles."""
WAYPOINT_BYTES = 3200
"""Bytes of a run per waypoint, for tables of travel times and the planner's timetables."""
STOCK_BYTES = 24
"""Bytes of a run per pair of SKU and pod: units contained, units available, and initial units."""
SKU_BYTES = 400
ORDER_BYTES = 1000
"""Bytes of a run per order waiting at time zero."""
ROBOT_BYTES = 20_000

_force: ContextVar[bool] = ContextVar("force", default=False)


@contextmanager
def forced(force: bool = True) -> Iterator[None]:
    """Return a context in which `require` accepts work that may not fit into memory.

    Parameters
    ----------
    force
        If false, `require` refuses such work, as it does by default.
    """
    token = _force.set(force)
    try:
        yield
    finally:
        _force.reset(token)


def require(needed: float, what: str) -> None:
    """Raise an error if more memory is needed than is free.

    Parameters
    ----------
    needed
        Approximate number of bytes.
    what
        Description of the work that needs the memory, for the message.

    Raises
    ------
    InputError
        If more than the free memory is needed, except in the context `forced`.
    """
    free = available()
    if needed > free and not _force.get():
        raise InputError(
            f"{what}: would need about {spoken(needed)} of memory, but only {spoken(free)} are "
            "free; `rmfs run --force` starts it anyway"
        )


def spoken(size: float) -> str:
    """Return a number of bytes as text, in GB (10^9 bytes)."""
    return f"{size / 1e9:.0f} GB" if size >= 1e10 else f"{size / 1e9:.1f} GB"


def available() -> float:
    """Return how many bytes this process may still allocate; infinite if that is unknown.

    The result is the smaller of two numbers: the available memory of the machine, and the unused
    part of the process's own limit.
    """
    limits = [float("inf")]
    try:
        told = Path("/proc/meminfo").read_text("utf-8")
        found = re.search(r"^MemAvailable:\s+(\d+) kB", told, re.MULTILINE)
        if found:
            limits.append(int(found[1]) * 1024.0)
        soft, _ = resource.getrlimit(resource.RLIMIT_AS)
        if soft != resource.RLIM_INFINITY:
            pages = int(Path("/proc/self/statm").read_text("utf-8").split()[0])
            limits.append(float(soft - pages * resource.getpagesize()))
    except OSError:  # another system: nothing is known, so nothing is refused
        pass
    return min(limits)

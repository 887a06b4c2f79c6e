"""Peak memory of the process."""

from __future__ import annotations

import sys
from pathlib import Path


def peak_rss_mb() -> float:
    """Return the peak resident memory of this process in MB (10^6 bytes); nan if unknown.

    The value is read from the kernel's high-water mark if available, because `getrusage` may return
    the peak of the process that started this one.
    """
    try:
        status = Path("/proc/self/status").read_text(encoding="ascii")
        line = next(line for line in status.splitlines() if line.startswith("VmHWM"))
        return int(line.split()[1]) * 1024 / 1e6
    except (OSError, StopIteration, ValueError, IndexError):
        return _from_getrusage()


def _from_getrusage() -> float:
    try:
        import resource
    except ImportError:  # not a POSIX system
        return float("nan")
    unit = 1 if sys.platform == "darwin" else 1024
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * unit / 1e6

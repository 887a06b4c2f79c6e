"""A guard that stops the motors when the robot's program dies or hangs.

The base of the robot keeps its last commanded speed even if the program on the robot's computer
fails. Therefore the program runs as a child process of the guard and signals after each step that
it is alive.
"""

from __future__ import annotations

import contextlib
import os
import select
import signal
import sys
import traceback
from collections.abc import Callable

PATIENCE_S = 0.5
"""Maximum time of a step of the program, in s; in this time, the robot drives 10 cm at 0.21 m/s."""


def guarded(
    program: Callable[[Callable[[], None]], None],
    stop: Callable[[], None],
    patience_s: float = PATIENCE_S,
) -> int:
    """Run a program, and stop the robot when the program ends, whatever the reason.

    Parameters
    ----------
    program
        The program; its argument is a function that it must call after each step.
    stop
        Function that stops the robot, called when the program has ended.
    patience_s
        Maximum time in s between two steps; if the next step takes longer, the program is killed.
        The time before the first step is not limited.

    Returns
    -------
    The program's exit code; if a signal ended the program, the negative of the signal's number.
    """
    reads, writes = os.pipe()
    child = os.fork()
    if child == 0:
        os.close(reads)
        code = 1
        try:
            program(lambda: _show(writes))
            code = 0
        except KeyboardInterrupt:
            code = 130
        except Exception:
            traceback.print_exc()
        finally:
            sys.stderr.flush()
            os._exit(code)
    os.close(writes)
    try:
        _watch(reads, patience_s)
    finally:
        with contextlib.suppress(ProcessLookupError):
            os.kill(child, signal.SIGKILL)
        status = os.waitpid(child, 0)[1]
        os.close(reads)
        stop()
    return os.waitstatus_to_exitcode(status)


def _show(writes: int) -> None:
    """Signal that the program is alive; if the guard has ended, the broken pipe raises OSError."""
    os.write(writes, b".")


def _watch(reads: int, patience_s: float) -> None:
    """Return when the program has ended or hangs; the time before its first step is not limited."""
    timeout_s: float | None = None
    while select.select([reads], [], [], timeout_s)[0]:
        if not os.read(reads, 4096):
            return
        timeout_s = patience_s

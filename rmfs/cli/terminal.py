"""Progress of a command: a bar on a terminal, lines elsewhere."""

from __future__ import annotations

import signal
import sys
import threading
from contextlib import contextmanager
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator


def step(text: str) -> None:
    """Print the current step on standard error, unless standard error is a terminal."""
    if not sys.stderr.isatty():
        print(f"rmfs: {text}", file=sys.stderr, flush=True)


@contextmanager
def progress(text: str, *, wordy: bool = True) -> Iterator[Callable[[float, float], None]]:
    """Yield a function of (done, total) that shows progress: a bar on a terminal, otherwise a line.

    The line is printed when the function is called with `done` = 0. If the inputs are wrong, the
    function is never called, and no line is printed.

    Parameters
    ----------
    wordy
        Whether to print the line if standard error is not a terminal. Default True.
    """
    if not sys.stderr.isatty():
        yield lambda done, total: None if done or not wordy else step(text)
        return
    from rich.console import Console
    from rich.progress import (
        BarColumn,
        Progress,
        TaskProgressColumn,
        TextColumn,
        TimeRemainingColumn,
    )

    columns = (TextColumn("{task.description}"), BarColumn(), TaskProgressColumn())
    console = Console(stderr=True)
    with Progress(*columns, TimeRemainingColumn(), console=console, transient=True) as bar:
        task = bar.add_task(text, total=None)
        yield lambda done, total: bar.update(task, completed=done, total=total)


@contextmanager
def terminable() -> Iterator[None]:
    """Return a context in which SIGTERM, sent by batch systems, acts like Ctrl-C.

    A command that is ended by SIGTERM leaves nothing half-written. Only the main thread can handle
    signals; in other threads the context has no effect.
    """
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    before = signal.signal(signal.SIGTERM, signal.default_int_handler)
    try:
        yield
    finally:
        signal.signal(signal.SIGTERM, before)

"""Executes runs on this machine, several in parallel, each in a separate process.

Processes are forked from a server process that has imported all modules but never simulates. A run
therefore starts within milliseconds, in fresh memory, independently of all other runs.
"""

from __future__ import annotations

import multiprocessing
import os
import signal
import sys
import threading
from contextlib import contextmanager, nullcontext, suppress
from dataclasses import dataclass
from multiprocessing import connection, forkserver
from types import FrameType, ModuleType
from typing import TYPE_CHECKING, Any, Protocol

from rmfs.experiments.running.job import Job, Outcome

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator
    from multiprocessing.context import ForkServerProcess

IMPORTED_ONCE = ("rmfs.experiments.running.warm",)

ONE_THREAD = dict.fromkeys(
    (
        "OMP_NUM_THREADS",
        "OPENBLAS_NUM_THREADS",
        "MKL_NUM_THREADS",
        "BLIS_NUM_THREADS",
        "VECLIB_MAXIMUM_THREADS",
        "NUMEXPR_NUM_THREADS",
        "RAYON_NUM_THREADS",
        "POLARS_MAX_THREADS",
    ),
    "1",
)
"""Environment variables that keep libraries from starting threads of their own."""


class Engine(Protocol):
    """Interface of objects that execute jobs."""

    @property
    def slots(self) -> int:
        """Maximum number of jobs that should be submitted but unfinished at any time."""

    def submit(self, job: Job) -> None:
        """Start a job."""

    def wait(self, timeout_s: float) -> list[tuple[Job, Outcome]]:
        """Return ended jobs with their outcomes; if there are none yet, wait up to `timeout_s`."""

    def close(self) -> None:
        """Stop all running jobs."""


@dataclass
class _Running:
    job: Job
    process: ForkServerProcess
    receiver: connection.Connection


class LocalProcesses:
    """Executes jobs in processes on this machine.

    Parameters
    ----------
    processes
        Maximum number of parallel processes.
    work
        Function that executes a job. Default: `running.execute.execute`.
    """

    def __init__(self, processes: int, work: Callable[[Job], Outcome] | None = None) -> None:
        self._processes = processes
        self._work = work
        self._running: dict[int, _Running] = {}
        self._context = multiprocessing.get_context("forkserver")
        self._context.set_forkserver_preload(list(IMPORTED_ONCE))
        with _environment(ONE_THREAD):
            forkserver.ensure_running()

    @property
    def slots(self) -> int:
        """Maximum number of unfinished jobs: the number of processes."""
        return self._processes

    @property
    def pids(self) -> list[int]:
        """Process ids of the workers."""
        return [one.process.pid for one in self._running.values() if one.process.pid is not None]

    def submit(self, job: Job) -> None:
        """Start a job in a new process."""
        with _uninterrupted():
            receiver, sender = self._context.Pipe(duplex=False)
            process = self._context.Process(
                target=_worker, args=(sender, job, self._work), name=str(job), daemon=True
            )
            with _without_main() if self._work is None else nullcontext():
                process.start()
            # only the worker holds the other end now: the pipe ends when the worker does
            sender.close()
            self._running[receiver.fileno()] = _Running(job, process, receiver)

    def wait(self, timeout_s: float) -> list[tuple[Job, Outcome]]:
        """Return ended jobs with their outcomes; if there are none yet, wait up to `timeout_s`."""
        receivers = [one.receiver for one in self._running.values()]
        ended = []
        for receiver in connection.wait(receivers, timeout_s):
            assert isinstance(receiver, connection.Connection)
            one = self._running.pop(receiver.fileno())
            ended.append((one.job, _received(one)))
        return ended

    def close(self) -> None:
        """Stop all running jobs."""
        for one in self._running.values():
            one.process.terminate()
        for one in self._running.values():
            one.process.join()
            one.receiver.close()
        self._running.clear()


def _received(one: _Running) -> Outcome:
    """Return the outcome that the worker sent, or a failure if the worker died."""
    try:
        outcome: Outcome = one.receiver.recv()
    except (EOFError, OSError, ValueError):
        outcome = Outcome()
    one.receiver.close()
    one.process.join()
    if outcome.footprint is None and not outcome.error:
        return Outcome(error=_last_words(one.process.exitcode), died=True)
    return outcome


def _last_words(code: int | None) -> str:
    if code is not None and code < 0:
        with suppress(ValueError):
            return f"the worker was killed by {signal.Signals(-code).name}"
    return f"the worker ended with code {code} and no result"


def _worker(sender: connection.Connection, job: Job, work: Callable[[Job], Outcome] | None) -> None:
    """Execute one job and send its outcome."""
    # the driver decides what an interruption means
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    if work is None:
        from rmfs.experiments.running.execute import execute

        work = execute
    _forget_earlier_memory()
    outcome = work(job)
    # an end of the driver is no news here
    with suppress(BrokenPipeError):
        sender.send(outcome)
    sender.close()


def _forget_earlier_memory() -> None:
    """Begin the high-water mark of memory anew, where the kernel can."""
    with suppress(OSError), open("/proc/self/clear_refs", "w", encoding="ascii") as file:  # noqa: PTH123
        file.write("5")


@contextmanager
def _uninterrupted() -> Iterator[None]:
    """Delay an interruption (Ctrl-C) while a process is being started."""
    if threading.current_thread() is not threading.main_thread():
        yield  # nothing is interrupted here
        return
    heard: list[tuple[int, FrameType | None]] = []
    before = signal.signal(signal.SIGINT, lambda *given: heard.append(given))
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, before)
    if heard and callable(before):
        before(*heard[0])


@contextmanager
def _without_main() -> Iterator[None]:
    """Hide the user's script from a process that is started.

    Otherwise, the process would import the script again. This takes time, and leads to an endless
    loop if the script does not contain `if __name__ == "__main__"`.
    """
    script = sys.modules["__main__"]
    sys.modules["__main__"] = ModuleType("__main__")
    try:
        yield
    finally:
        sys.modules["__main__"] = script


@contextmanager
def _environment(values: dict[str, str]) -> Iterator[None]:
    """Set environment variables for processes that are started within this context."""
    before: dict[str, Any] = {name: os.environ.get(name) for name in values}
    os.environ.update(values)
    try:
        yield
    finally:
        for name, value in before.items():
            if value is None:
                os.environ.pop(name, None)
            else:
                os.environ[name] = value

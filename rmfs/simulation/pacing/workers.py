"""Worker processes as seen by the simulation, which starts, asks and replaces them."""

from __future__ import annotations

import json
import os
import pickle
import subprocess
import sys
import time
from dataclasses import dataclass, field
from multiprocessing import Pipe
from multiprocessing.connection import Connection, wait
from typing import TYPE_CHECKING, Any

from rmfs.simulation.pacing.errors import OptimiserError
from rmfs.simulation.pacing.worker import READY, STAMP

if TYPE_CHECKING:
    from collections.abc import Iterable

_ONE_THREAD = (
    "OMP_NUM_THREADS",
    "OPENBLAS_NUM_THREADS",
    "MKL_NUM_THREADS",
    "VECLIB_MAXIMUM_THREADS",
    "NUMEXPR_NUM_THREADS",
    "RAYON_NUM_THREADS",
)

_START = """
import json, sys
sys.path[:] = json.loads(sys.argv[2])
from rmfs.simulation.pacing.worker import main
main(int(sys.argv[1]), json.loads(sys.argv[3]))
"""


@dataclass(frozen=True)
class Reply:
    """The answer to a question, or the reason why there is none.

    Attributes
    ----------
    at_s
        Time at which the answer was ready or the failure was noticed, on the monotonic clock, in s.
    failure
        Reason why there is no answer, in one line; empty if there is an answer.
    """

    at_s: float
    answer: Any
    failure: str


class DeadWorkerError(Exception):
    """A worker has ended, or its reply cannot be read."""


@dataclass(eq=False)
class Worker:
    """One worker process.

    Attributes
    ----------
    connection
        Connection for questions and replies.
    number
        Number of the question on which the worker is working; -1 if it is idle.
    is_ready
        Whether the worker has imported its modules.
    """

    modules: list[str]
    connection: Connection = field(init=False)
    number: int = -1
    is_ready: bool = False

    def __post_init__(self) -> None:
        self.connection, other = Pipe()
        handle = other.fileno()
        arguments = [str(handle), json.dumps(sys.path), json.dumps(self.modules)]
        self._process = subprocess.Popen(
            [sys.executable, "-c", _START, *arguments],
            pass_fds=[handle],
            stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL,
            env=os.environ | dict.fromkeys(_ONE_THREAD, "1"),
        )
        other.close()

    def await_ready(self) -> None:
        """Wait until the worker has imported its modules.

        Raises
        ------
        OptimiserError
            If importing fails.
        """
        if not self.is_ready:
            try:
                _, failure = self._read(READY)[1:]
            except DeadWorkerError:
                failure = "its process ended"
            if failure:
                self.stop()
                raise OptimiserError(f"a worker cannot start: {failure}")
            self.is_ready = True

    def ask(self, number: int, load: bytes) -> None:
        """Send a question; `load` is the pickled pair of the solving function and its argument."""
        self.number = number
        # a worker that has just died is found out when its reply is awaited
        try:
            self.connection.send_bytes(pickle.dumps((number, load)))
        except OSError:
            return

    def reply(self) -> Reply | None:
        """Return the worker's reply to its present question; None if none has arrived.

        Raises
        ------
        DeadWorkerError
            If the worker has ended, or its reply cannot be read.
        """
        if not self.connection.poll():
            return None
        reply = Reply(*self._read(self.number))
        self.number = -1
        return reply

    def stop(self) -> None:
        """End the process, whatever it is doing."""
        self.connection.close()
        self._process.kill()
        self._process.wait()

    def _read(self, expected: int) -> tuple[float, Any, str]:
        try:
            message = self.connection.recv_bytes()
            at_s = STAMP.unpack_from(message)[0]
            number, answer, failure = pickle.loads(message[STAMP.size :])
        except (EOFError, OSError):
            raise DeadWorkerError from None
        if number != expected:
            raise DeadWorkerError
        return at_s, answer, failure


class Workers:
    """A fixed number of worker processes, each of which can be replaced.

    Parameters
    ----------
    count
        Number of workers.
    modules
        Modules that each worker imports before it is ready.
    """

    def __init__(self, count: int, modules: Iterable[str]) -> None:
        self._modules = list(modules)
        self._workers = [Worker(self._modules) for _ in range(count)]

    def await_ready(self) -> None:
        """Wait until all workers are ready."""
        for worker in self._workers:
            worker.await_ready()

    def __iter__(self) -> Any:
        return iter(self._workers)

    def idle(self) -> Worker | None:
        """Return an idle worker that is ready; None if all are busy.

        If there are idle workers but none is ready yet, wait until one of them is ready.
        """
        idle = [worker for worker in self._workers if worker.number < 0]
        if not idle:
            return None
        chosen = next((worker for worker in idle if worker.is_ready), idle[0])
        chosen.await_ready()
        return chosen

    def replace(self, worker: Worker) -> None:
        """Stop a worker and start another."""
        worker.stop()
        self._workers[self._workers.index(worker)] = Worker(self._modules)

    def listen(self, seconds: float) -> None:
        """Sleep until a busy worker replies or ends, at most for `seconds` of wall time."""
        busy = [worker.connection for worker in self._workers if worker.number >= 0]
        if busy:
            wait(busy, seconds)
        else:
            time.sleep(seconds)

    def stop(self) -> None:
        """Stop all workers."""
        for worker in self._workers:
            worker.stop()

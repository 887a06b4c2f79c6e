"""Wall pacing: optimisers run beside the simulation; their wall time counts as simulated time."""

from __future__ import annotations

import pickle
import time
from collections import deque
from dataclasses import dataclass
from math import ceil
from typing import TYPE_CHECKING

from rmfs.simulation.agenda import NEVER_US
from rmfs.simulation.pacing.workers import DeadWorkerError, Reply, Worker, Workers

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

    from rmfs.control.asks import Call
    from rmfs.simulation.pacing.settings import WallPacing

STEP_S = 0.005
"""Wall time in s between checks of a simulation that waits."""


@dataclass(eq=False)
class _Open:
    """A submitted question.

    Attributes
    ----------
    since_s
        When it was submitted, on the monotonic clock.
    load
        The serialised question.
    """

    call: Call
    since_s: float
    load: bytes
    worker: Worker | None = None


class Wall:
    """Lets worker processes answer questions, and meanwhile limits the simulated time.

    The wall time of a question begins just before the question is pickled and ends when a worker
    has pickled the answer. It includes the time for which the question is queued because all
    workers are busy, but not the time for which `ask` waits for a worker that is still starting.
    While there is no answer, the simulated time since the question was asked is at most `speed`
    times the question's wall time so far (RAWSim-O paper, section 3.1). The answer takes effect
    when the simulated time since the question was asked reaches `speed` times the question's wall
    time.

    Parameters
    ----------
    settings
        Parameters of the mode `wall`.
    """

    waits = True

    def __init__(self, settings: WallPacing) -> None:
        self._settings = settings
        self._us_per_s = settings.speed * 1e6
        self._open: list[_Open] = []
        self._queue: deque[_Open] = deque()
        self._workers: Workers | None = None
        self._modules: list[str] = []

    def begin(self, modules: Iterable[str], give: Callable[[Call, int], None]) -> None:
        """If any controller uses optimisers, start the workers and wait until they are ready.

        Raises
        ------
        OptimiserError
            If a worker cannot import the modules.
        """
        self._give = give
        self._modules = list(modules)
        if self._modules:
            self._started().await_ready()

    def ask(self, call: Call) -> None:
        """Send a question to an idle worker, or queue it if all workers are busy."""
        worker = self._started().idle()
        since_s = time.monotonic()
        load = pickle.dumps((call.ask.solve, call.ask.question))
        asked = _Open(call, since_s, load)
        self._open.append(asked)
        if worker is None:
            self._queue.append(asked)
        else:
            self._hand_over(asked, worker)

    def limit_us(self, now_us: int) -> int:
        """Sleep until times after `now_us` may be simulated; return the latest such time, in us.

        If no question waits for an answer, there is no limit.
        """
        while self._open:
            self._collect(now_us)
            if not self._open:
                break
            paid_us = self._paid_us()
            missing_us = now_us + STEP_S * self._us_per_s - paid_us
            if missing_us <= 0:
                return paid_us
            self._started().listen(missing_us / self._us_per_s)
        return NEVER_US

    def end(self) -> None:
        """Stop the workers."""
        if self._workers is not None:
            self._workers.stop()
            self._workers = None

    def _started(self) -> Workers:
        if self._workers is None:
            self._workers = Workers(self._settings.workers, self._modules)
        return self._workers

    def _hand_over(self, asked: _Open, worker: Worker) -> None:
        asked.worker = worker
        worker.ask(asked.call.number, asked.load)

    def _paid_us(self) -> int:
        now_s = time.monotonic()
        return min(
            asked.call.requested_us + int((now_s - asked.since_s) * self._us_per_s)
            for asked in self._open
        )

    def _collect(self, now_us: int) -> None:
        """Collect replies, stop what takes too long, and submit queued questions."""
        for asked in list(self._open):
            reply = self._reply(asked)
            if reply is not None:
                self._close(asked, reply, now_us)
        while self._queue:
            worker = self._started().idle()
            if worker is None:
                return
            self._hand_over(self._queue.popleft(), worker)

    def _reply(self, asked: _Open) -> Reply | None:
        """Return the reply to a question; None while it is open."""
        worker, workers = asked.worker, self._started()
        failure = ""
        if worker is not None:
            try:
                reply = worker.reply()
            except DeadWorkerError:
                failure = "its worker died"
            else:
                if reply is not None:
                    return reply
        now_s = time.monotonic()
        if not failure and now_s - asked.since_s > self._settings.patience_s:
            failure = f"no answer within {self._settings.patience_s:g} s"
        if not failure:
            return None
        if worker is None:
            self._queue.remove(asked)
        else:
            workers.replace(worker)
        return Reply(now_s, None, failure)

    def _close(self, asked: _Open, reply: Reply, now_us: int) -> None:
        call = asked.call
        self._open.remove(asked)
        call.answer, call.failure = reply.answer, reply.failure
        elapsed_us = ceil((reply.at_s - asked.since_s) * self._us_per_s)
        # what has been simulated meanwhile cannot be undone
        self._give(call, max(call.requested_us + elapsed_us, now_us + 1))

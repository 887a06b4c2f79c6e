"""The driver, which distributes runs to workers and stores the results."""

from __future__ import annotations

from collections import deque
from contextlib import contextmanager
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Protocol

import numpy as np
import pandas as pd

from rmfs.experiments.design.stages import columns, schedule
from rmfs.experiments.results import assigned, failed_pairs
from rmfs.experiments.running.code import code

if TYPE_CHECKING:
    from collections.abc import Iterator

    from rmfs.experiments.design.arms import Arm
    from rmfs.experiments.design.planning import Plan
    from rmfs.experiments.design.stages import Schedule
    from rmfs.experiments.running.job import Job, Outcome
    from rmfs.experiments.running.local import Engine
    from rmfs.experiments.store import Store

ATTEMPTS = 3
"""Maximum number of attempts at a run whose worker dies without an error."""

PATIENCE_S = 1.0
"""Maximum time to wait for the engine before progress is reported, in s."""

MERGE_EVERY = 1024
"""Number of runs after which the files of single runs are merged."""


class Watcher(Protocol):
    """Interface of objects that are notified of the progress of an experiment."""

    def planned(self, total: int, finished: int) -> None:
        """Receive the total number of runs, and how many of them are finished."""

    def ended(self, job: Job, outcome: Outcome) -> None:
        """Receive the outcome of a run that has ended; it succeeded if `outcome.error` is empty."""

    def remark(self, text: str) -> None:
        """Receive a remark that is worth a line of output."""

    def tick(self) -> None:
        """Update the display; called when runs end, and otherwise every `PATIENCE_S` seconds."""


class Silent:
    """A watcher that does nothing."""

    def planned(self, total: int, finished: int) -> None:
        """Do nothing."""

    def ended(self, job: Job, outcome: Outcome) -> None:
        """Do nothing."""

    def remark(self, text: str) -> None:
        """Do nothing."""

    def tick(self) -> None:
        """Do nothing."""


@dataclass
class Tally:
    """Counts of the runs of an experiment.

    Attributes
    ----------
    wanted, finished
        Number of runs that the experiment needs (as far as known, if the design has stages), and
        number of those that are finished and stored.
    ran
        Number of runs executed by the driver, including failed ones.
    failed
        Failed runs, as pairs of arm and replication.
    """

    wanted: int = 0
    finished: int = 0
    ran: int = 0
    failed: list[tuple[str, int]] = field(default_factory=list)


def drive(plan: Plan, store: Store, engine: Engine, watcher: Watcher | None = None) -> Tally:
    """Execute the runs of a plan that are not finished yet.

    Runs that failed or were interrupted earlier are repeated.

    Raises
    ------
    PlanError
        If the plan has errors.
    InputError
        If the folder cannot be written, or another driver is working on it.
    """
    plan.require_sound()
    return _Driver(plan, store, engine, watcher or Silent()).run()


class _Driver:
    def __init__(self, plan: Plan, store: Store, engine: Engine, watcher: Watcher) -> None:
        self.plan, self.store, self.engine, self.watcher = plan, store, engine, watcher
        self.arms: dict[str, Arm] = {arm.name: arm for arm in plan.arms}
        self.tally = Tally()
        self.attempts: dict[str, int] = {}
        self.finished: set[str] = set()
        self.failed: set[str] = set()
        self.looked_at = columns(plan)
        self.known: list[dict[Any, Any]] = []

    def run(self) -> Tally:
        with self.store.locked(), self._closing():
            self.plan.save(self.store.folder)
            self.store.merge()
            self.finished = self.store.finished(self.plan.design.keep)
            self._remember()
            self._tell_of_strangers()
            while True:
                now = self._schedule()
                todo = self._todo(now)
                if not todo:
                    break
                self._do(todo)
                if now.complete:
                    break
            for text in self._schedule().remarks:
                self.watcher.remark(text)
            self.store.merge()
        return self.tally

    def _schedule(self) -> Schedule:
        """Ask the stages what they want, given the results so far."""
        head = pd.Index(["arm", "replication", *self.looked_at])
        return schedule(self.plan, pd.DataFrame(self.known, columns=head), self.tally.failed)

    def _remember(self) -> None:
        """Read the columns of finished runs on which the stages depend."""
        if not self.plan.design.stages:
            return
        rows = self.store.rows(["arm_digest", "replication", "seed", *self.looked_at])
        arms = {arm.digest: arm for arm in self.plan.arms}
        rows = rows[rows["arm_digest"].isin(list(arms)) & rows["run"].isin(list(self.finished))]
        told = zip(rows["arm_digest"], rows["replication"], rows["seed"], strict=True)
        # with or without common random numbers, the same replication has another seed
        right = [self.plan.seed(arms[arm], int(number)) == seed for arm, number, seed in told]
        rows = rows[np.array(right, dtype=bool)]
        rows = rows.assign(arm=[arms[digest].name for digest in rows["arm_digest"]])
        self.known = rows[["arm", "replication", *self.looked_at]].to_dict("records")

    def _todo(self, now: Schedule) -> list[Job]:
        jobs = [self.plan.job(self.arms[run.arm], run.replication) for run in now.runs]
        self.tally.wanted = len(jobs)
        self.tally.finished = sum(job.key in self.finished for job in jobs)
        self.watcher.planned(self.tally.wanted, self.tally.finished)
        return [job for job in jobs if job.key not in self.finished and job.key not in self.failed]

    def _do(self, jobs: list[Job]) -> None:
        waiting = deque(jobs)
        flying = 0
        while waiting or flying:
            while waiting and flying < self.engine.slots:
                self.engine.submit(waiting.popleft())
                flying += 1
            for job, outcome in self.engine.wait(PATIENCE_S):
                flying -= 1
                if outcome.died and self._once_more(job, outcome):
                    waiting.appendleft(job)
                else:
                    self._store(job, outcome)
            self.watcher.tick()

    def _once_more(self, job: Job, outcome: Outcome) -> bool:
        """Return whether to repeat a run whose worker died; count the attempt."""
        self.attempts[job.key] = self.attempts.get(job.key, 1) + 1
        if self.attempts[job.key] > ATTEMPTS:
            return False
        self.watcher.remark(f"{job}: {outcome.error}; begun again")
        return True

    def _store(self, job: Job, outcome: Outcome) -> None:
        self.store.add(job, outcome, code())
        self.tally.ran += 1
        if outcome.error:
            self.failed.add(job.key)
            self.tally.failed.append((job.arm, job.replication))
        else:
            self.finished.add(job.key)
            self.tally.finished += 1
            if self.plan.design.stages and outcome.footprint is not None:
                row = outcome.footprint.iloc[0][self.looked_at].to_dict()
                self.known.append({"arm": job.arm, "replication": job.replication, **row})
        self.watcher.ended(job, outcome)
        if self.tally.ran % MERGE_EVERY == 0:
            self.store.merge()

    def _tell_of_strangers(self) -> None:
        """Say which stored runs no longer count, and which were made by other code."""
        rows = self.store.rows(["arm_digest", "arm", "replication", "code"])
        if rows.empty:
            return
        digests = {arm.digest for arm in self.plan.arms}
        outdated = rows[~rows["arm_digest"].isin(list(digests)) & rows["arm"].isin(list(self.arms))]
        if len(outdated):
            arms = outdated["arm"].nunique()
            self.watcher.remark(
                f"{len(outdated)} finished runs of {arms} arms were made with other inputs "
                "and are ignored: these runs are repeated"
            )
        others = rows[rows["arm_digest"].isin(list(digests)) & (rows["code"] != code()["code"])]
        if len(others):
            self.watcher.remark(
                f"{len(others)} finished runs were made with another version of the code; "
                "remove the folder to repeat them"
            )

    @contextmanager
    def _closing(self) -> Iterator[None]:
        try:
            yield
        finally:
            self.engine.close()


def progress_of(plan: Plan, store: Store) -> Tally:
    """Return the progress of an experiment."""
    finished = store.finished(plan.design.keep)
    lost = failed_pairs(plan, store)
    wanted = schedule(plan, assigned(plan, store), lost).runs
    arms = {arm.name: arm for arm in plan.arms}
    keys = [plan.job(arms[run.arm], run.replication).key for run in wanted]
    return Tally(len(keys), sum(key in finished for key in keys), failed=sorted(lost))

"""Progress of an experiment: a bar on a terminal, occasional lines elsewhere."""

from __future__ import annotations

import sys
import time
from contextlib import contextmanager
from typing import TYPE_CHECKING, TextIO

if TYPE_CHECKING:
    from collections.abc import Iterator

    from rich.progress import Progress, TaskID

    from rmfs.experiments.running.driver import Watcher
    from rmfs.experiments.running.job import Job, Outcome

LINE_EVERY_S = 10.0


def time_left_s(begun_s: float, now_s: float, ran: int, left: int) -> float:
    """Return the estimated time in s for `left` more runs after `ran` runs; inf if `ran` is 0."""
    return (now_s - begun_s) / ran * left if ran else float("inf")


def spoken(seconds: float) -> str:
    """Return a duration as text, in s, min or h."""
    if seconds < 100:
        return f"{max(seconds, 1):.0f} s"
    if seconds < 6000:
        return f"{seconds / 60:.0f} min"
    return f"{seconds / 3600:.1f} h"


class Lines:
    """Reports progress as lines of text."""

    def __init__(self, stream: TextIO) -> None:
        self.stream = stream
        self.total = self.finished = self.ran = self.failed = 0
        self.begun_s = self.told_s = time.monotonic()

    def planned(self, total: int, finished: int) -> None:
        """Report the number of runs."""
        if total > self.total:
            self.say(f"{total} runs, {finished} of them finished")
        self.total, self.finished = total, finished

    def ended(self, job: Job, outcome: Outcome) -> None:
        """Count a run; report failures at once, progress at most every `LINE_EVERY_S` seconds."""
        self.ran += 1
        if outcome.error:
            self.failed += 1
            self.say(f"{job}: failed: {outcome.error}")
        else:
            self.finished += 1
        left = self.total - self.finished - self.failed
        if time.monotonic() - self.told_s >= LINE_EVERY_S and left:
            rest = time_left_s(self.begun_s, time.monotonic(), self.ran, left)
            self.say(f"{self.finished} of {self.total} runs finished, about {spoken(rest)} left")

    def remark(self, text: str) -> None:
        """Print a remark."""
        self.say(text)

    def tick(self) -> None:
        """Do nothing."""

    def say(self, text: str) -> None:
        """Print a line."""
        print(f"rmfs: {text}", file=self.stream, flush=True)
        self.told_s = time.monotonic()


class Bar:
    """Reports progress as a progress bar."""

    def __init__(self, progress: Progress, task: TaskID) -> None:
        self.progress, self.task = progress, task

    def planned(self, total: int, finished: int) -> None:
        """Set the length of the bar."""
        self.progress.update(self.task, total=total, completed=finished)

    def ended(self, job: Job, outcome: Outcome) -> None:
        """Advance the bar; print failures above it."""
        self.progress.advance(self.task)
        if outcome.error:
            self.progress.console.print(f"{job}: failed: {outcome.error}", markup=False)

    def remark(self, text: str) -> None:
        """Print a remark above the bar."""
        self.progress.console.print(text, markup=False)

    def tick(self) -> None:
        """Redraw the bar, as the remaining time decreases even if no run ends."""
        self.progress.refresh()


@contextmanager
def watching(name: str) -> Iterator[Watcher]:
    """Yield a watcher that suits the output: a progress bar on a terminal, otherwise lines."""
    if not sys.stderr.isatty():
        yield Lines(sys.stderr)
        return
    from rich.console import Console
    from rich.progress import (
        BarColumn,
        MofNCompleteColumn,
        Progress,
        TextColumn,
        TimeElapsedColumn,
        TimeRemainingColumn,
    )

    columns = (
        TextColumn("{task.description}"),
        BarColumn(),
        MofNCompleteColumn(),
        TimeElapsedColumn(),
        TextColumn("left"),
        # over the whole experiment: arms differ in speed
        TimeRemainingColumn(elapsed_when_finished=False),
    )
    with Progress(*columns, console=Console(stderr=True), speed_estimate_period=3600) as progress:
        yield Bar(progress, progress.add_task(name, total=None))

"""How much slower a run is when a page watches it: pairs of runs, with and without, in turn."""

from __future__ import annotations

import os
import subprocess
import sys
import threading
import time
from dataclasses import asdict, dataclass
from typing import TYPE_CHECKING, Any

import pandas as pd

import rmfs
from rmfs.view.answers import live_server
from rmfs.view.live import LiveRun

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

WATCHER = """
import sys, time, urllib.request
from rmfs.view.container import unpack
url, known = sys.argv[1], {"motion": 0, "events": 0}
ask = lambda path: unpack(urllib.request.urlopen(url + path, timeout=60).read())[0]["live"]
try:
    known = ask("runs/0")["known"]
    while True:
        time.sleep(0.25)
        told = ask(f"live?motion={known['motion']}&events={known['events']}&page=1")
        known = told["known"]
        if told["ended"]:
            break
except OSError:
    pass
"""
"""Asks as the page does, in a process of its own as the page is."""

Overrides = list[tuple[list[str], Any]]


@dataclass(frozen=True, slots=True)
class Case:
    """A run whose cost is measured: names of layout, scenario and controllers, and its length."""

    layout: str
    scenario: str
    controllers: str
    simulated_s: float

    @property
    def overrides(self) -> Overrides:
        """The length, as changes of the scenario."""
        return [
            (["scenario", "warmup_s"], 0.0),
            (["scenario", "duration_s"], self.simulated_s),
        ]


CASES = (
    Case("default", "default", "default", 120_000.0),
    Case("study-128", "pp-minimal", "random", 12_000.0),
)
"""Some ten seconds of wall time each: 32 robots with little to plan, 128 with much."""


@dataclass(frozen=True, slots=True)
class Timed:
    """One run.

    Attributes
    ----------
    watched
        Whether a page looked on; without one, nothing is kept that only a page would need.
    processor_s
        Processor time of the simulating process, which no other process's load changes.
    wall_s
        Wall time.
    load
        Mean number of busy processes of the machine within the last minute.
    """

    layout: str
    watched: bool
    processor_s: float
    wall_s: float
    load: float


def runs(case: Case, pairs: int) -> Iterator[Timed]:
    """Time so many pairs of runs; which of the two comes first alternates."""
    for index in range(pairs):
        for watched in (False, True) if index % 2 == 0 else (True, False):
            processor_s, wall_s = _watched(case) if watched else _timed(case)
            yield Timed(case.layout, watched, processor_s, wall_s, os.getloadavg()[0])


def table(pairs: int, cases: Iterable[Case] = CASES) -> pd.DataFrame:
    """Return all runs, one row each."""
    return pd.DataFrame([asdict(run) for case in cases for run in runs(case, pairs)])


def ratios(frame: pd.DataFrame) -> pd.DataFrame:
    """Return what a page costs per layout: medians with one, divided by medians without."""
    medians = frame.groupby(["layout", "watched"])[["processor_s", "wall_s"]].median()
    alone, watched = (medians.xs(key, level="watched") for key in (False, True))
    return (watched / alone).add_suffix("_ratio").join(alone)


def _watched(case: Case) -> tuple[float, float]:
    names = {name: getattr(case, name) for name in ("layout", "scenario", "controllers")}
    live = LiveRun(names, title="cost")
    with live_server(live) as server:
        threading.Thread(target=server.serve_forever, daemon=True).start()
        with subprocess.Popen([sys.executable, "-c", WATCHER, server.url]) as page:
            try:
                return _timed(case, events=live.events, observers=[live])
            finally:
                live.close("over")
                page.wait(60)
                server.shutdown()


def _timed(case: Case, **options: Any) -> tuple[float, float]:
    wall_s, own_s = time.perf_counter(), time.process_time()
    rmfs.simulate(
        case.layout, case.scenario, case.controllers, seed=1, overrides=case.overrides, **options
    )
    return time.process_time() - own_s, time.perf_counter() - wall_s

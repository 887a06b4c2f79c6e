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
    from collections.abc import Iterator

NAMES = {"layout": "default", "scenario": "default", "controllers": "default"}

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


@dataclass(frozen=True, slots=True)
class Pair:
    """One run without and one with a page.

    Attributes
    ----------
    alone_s, watched_s
        Processor time of the simulating process, which no other process's load changes.
    alone_wall_s, watched_wall_s
        Wall time.
    load
        Mean number of busy processes of the machine within the last minute.
    """

    alone_s: float
    watched_s: float
    alone_wall_s: float
    watched_wall_s: float
    load: float


def pairs(number: int, overrides: list[tuple[list[str], Any]]) -> Iterator[Pair]:
    """Time so many pairs of runs; which of the two comes first alternates."""
    for index in range(number):
        times = {}
        for watched in (False, True) if index % 2 == 0 else (True, False):
            times[watched] = _watched(overrides) if watched else _alone(overrides)
        (alone_s, alone_wall_s), (watched_s, watched_wall_s) = times[False], times[True]
        yield Pair(alone_s, watched_s, alone_wall_s, watched_wall_s, os.getloadavg()[0])


def table(number: int, overrides: list[tuple[list[str], Any]]) -> pd.DataFrame:
    """Return the pairs with the ratios of their times, one row each."""
    frame = pd.DataFrame([asdict(pair) for pair in pairs(number, overrides)])
    frame["ratio"] = frame["watched_s"] / frame["alone_s"]
    frame["wall_ratio"] = frame["watched_wall_s"] / frame["alone_wall_s"]
    return frame


def _alone(overrides: list[tuple[list[str], Any]]) -> tuple[float, float]:
    return _timed(overrides)


def _watched(overrides: list[tuple[list[str], Any]]) -> tuple[float, float]:
    live = LiveRun(NAMES, title="cost")
    with live_server(live) as server:
        threading.Thread(target=server.serve_forever, daemon=True).start()
        with subprocess.Popen([sys.executable, "-c", WATCHER, server.url]) as page:
            try:
                return _timed(overrides, events=live.events, observers=[live])
            finally:
                live.close("over")
                page.wait(60)
                server.shutdown()


def _timed(overrides: list[tuple[list[str], Any]], **options: Any) -> tuple[float, float]:
    wall_s, own_s = time.perf_counter(), time.process_time()
    rmfs.simulate(*NAMES.values(), seed=1, overrides=overrides, **options)
    return time.process_time() - own_s, time.perf_counter() - wall_s

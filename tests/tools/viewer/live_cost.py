"""How much slower a run is when a page watches it: runs alone and watched, in turn.

Each run has an interpreter of its own, which has simulated a little before it is timed.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
import time
from contextlib import ExitStack
from dataclasses import asdict, dataclass, replace
from enum import StrEnum
from typing import TYPE_CHECKING, Any

import pandas as pd

import rmfs
from rmfs.view.answers import live_server
from rmfs.view.live import LiveRun
from tests.tools.checkout import ENVIRONMENT
from tests.tools.viewer.chromium import chromium, open_page, served

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Sequence

WATCHER = """
import http.client, sys, time
from urllib.parse import urlsplit
from rmfs.view.container import unpack
server = http.client.HTTPConnection(urlsplit(sys.argv[1]).netloc, timeout=60)
def ask(path):
    server.request("GET", path)
    return unpack(server.getresponse().read())[0]["live"]
try:
    known = ask("/runs/0")["known"]
    while True:
        time.sleep(0.25)
        told = ask(f"/live?motion={known['motion']}&events={known['events']}&page=1")
        known = told["known"]
        if told["ended"]:
            break
except (OSError, http.client.HTTPException):
    pass
"""
"""Asks as the page does, in a process of its own as the page is, but draws nothing."""

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


PATIENCE_S = 5.0
"""Wall time a run waits for its page to come."""

FAREWELL_S = 1.0
"""Wall time the page has to see the end."""

WARM_S = 60.0
"""Simulated time of the run that comes before the timed one: what is needed is loaded then."""


class How(StrEnum):
    """How a run is done."""

    ALONE = "alone"
    """Nothing is kept that only a page would need."""
    KEPT = "kept"
    """Trace and events are kept, but nobody asks for them."""
    ASKED = "asked"
    """A program asks as the page does, and draws nothing."""
    DRAWN = "drawn"
    """The page itself, in Chromium, which draws in software."""


@dataclass(frozen=True, slots=True)
class Timed:
    """One run.

    Attributes
    ----------
    processor_s
        Processor time of the simulating process.
    wall_s
        Wall time.
    load
        Mean number of busy processes of the machine within the last minute.
    """

    layout: str
    round: int
    how: How
    processor_s: float
    wall_s: float
    load: float


def runs(case: Case, rounds: int, hows: Sequence[How]) -> Iterator[Timed]:
    """Time a run of each kind, so many times; the order is reversed every other time."""
    for index in range(rounds):
        for how in hows if index % 2 == 0 else reversed(hows):
            yield Timed(case.layout, index, how, *_timed(case, how), os.getloadavg()[0])


def table(rounds: int, hows: Sequence[How], cases: Iterable[Case] = CASES) -> pd.DataFrame:
    """Return all runs, one row each."""
    return pd.DataFrame([asdict(run) for case in cases for run in runs(case, rounds, hows)])


def ratios(frame: pd.DataFrame) -> pd.DataFrame:
    """Return what each kind of run takes per layout, divided by what a run alone takes.

    Runs of one round are compared with each other, as machines are now faster and now slower; then
    the quartiles over the rounds are taken.
    """
    times = frame.set_index(["layout", "round", "how"])[["processor_s", "wall_s"]]
    alone = times.xs(How.ALONE, level="how")
    each = (times / alone).groupby(["layout", "how"])
    return pd.concat({f"{q:.0%}": each.quantile(q) for q in (0.25, 0.5, 0.75)}, axis=1)


def _timed(case: Case, how: How) -> tuple[float, float]:
    """Return processor and wall time of a run in an interpreter of its own."""
    given = json.dumps({**asdict(case), "how": how})
    code = "import sys; from tests.tools.viewer.live_cost import tell; tell(sys.argv[1])"
    # the order of sets makes more difference than a page
    same = {**ENVIRONMENT, "PYTHONHASHSEED": "0"}
    with subprocess.Popen(
        [sys.executable, "-c", code, given], env=same, text=True, stdout=subprocess.PIPE
    ) as run:
        assert run.stdout is not None
        match how:
            case How.ASKED:
                with subprocess.Popen(
                    [sys.executable, "-c", WATCHER, run.stdout.readline().strip()]
                ):
                    told = run.stdout.readline()
            case How.DRAWN:
                with chromium() as browser:
                    open_page(browser).goto(run.stdout.readline().strip())
                    told = run.stdout.readline()
            case _:
                told = run.stdout.readline()
    processor_s, wall_s = json.loads(told)
    return processor_s, wall_s


def tell(given: str) -> None:
    """Do a run and print its processor and wall time; before that an address, if it is watched."""
    told = json.loads(given)
    how, case = How(told.pop("how")), Case(**told)
    _simulated(replace(case, simulated_s=WARM_S))
    names = {name: told[name] for name in ("layout", "scenario", "controllers")}
    live = LiveRun(names, title="cost")
    kept: dict[str, Any] = {"events": live.events, "driver": live.drive}
    with ExitStack() as stack:
        if how in (How.ASKED, How.DRAWN):
            print(stack.enter_context(served(live_server(live))), flush=True)
            live.await_page(PATIENCE_S)
        print(json.dumps(_simulated(case, **({} if how is How.ALONE else kept))), flush=True)
        live.await_farewell(FAREWELL_S)


def _simulated(case: Case, **options: Any) -> tuple[float, float]:
    wall_s, own_s = time.perf_counter(), time.process_time()
    rmfs.simulate(
        case.layout, case.scenario, case.controllers, seed=1, overrides=case.overrides, **options
    )
    return time.process_time() - own_s, time.perf_counter() - wall_s

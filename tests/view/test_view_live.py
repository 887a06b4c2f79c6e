"""A watched run: the same run, whatever pages do; told completely; its rules exchanged by hand."""

import http.client
import json
import sys
import threading
import time
from collections.abc import Callable
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest

import rmfs
from rmfs.errors import InputError
from rmfs.measure import load_run, write_run
from rmfs.measure.dictionary import TABLES
from rmfs.simulation.result import Run
from rmfs.traffic import Piece
from rmfs.view import scene
from rmfs.view.answers import live_server
from rmfs.view.asking import Known
from rmfs.view.container import unpack
from rmfs.view.live import LiveRun
from rmfs.view.preview import preview
from rmfs.view.starting import Starter

NOTHING = Known()
NAMES = dict.fromkeys(("layout", "scenario", "controllers"), "default")
SETTINGS: list[tuple[list[str], Any]] = [
    (["layout", "robots"], 8),
    (["scenario", "warmup_s"], 30.0),
    (["scenario", "duration_s"], 300.0),
]


class Watched:
    """A run in a thread of its own."""

    def __init__(self, *, speed: float | None = None) -> None:
        self.live = LiveRun(NAMES, title="test", speed=speed)
        self.done: Run | None = None
        self.thread = threading.Thread(target=self._simulate, daemon=True)

    def _simulate(self) -> None:
        self.done = rmfs.simulate(
            "default",
            "default",
            "default",
            seed=4,
            overrides=SETTINGS,
            events=self.live.events,
            driver=self.live.drive,
        )

    def start(self) -> None:
        self.thread.start()

    def result(self) -> Run:
        self.thread.join(60)
        assert self.done is not None
        return self.done

    def told(self, known: Known = NOTHING, page: str = "") -> tuple[dict[str, Any], dict[str, Any]]:
        return unpack(self.live.news(known, page))

    def until(self, holds: Callable[[dict[str, Any]], bool]) -> dict[str, Any]:
        for _ in range(1000):
            header, _ = self.told()
            if holds(header["live"]):
                return header["live"]
            time.sleep(0.01)
        raise AssertionError(header["live"])


def reproducible(run: Run) -> pd.Series:
    names = [column.name for column in TABLES["footprint"] if not column.measured]
    return run.footprint[names]


@pytest.fixture(scope="module")
def unwatched() -> Run:
    return rmfs.simulate("default", "default", "default", seed=4, overrides=SETTINGS, trace=True)


def test_pausing_stepping_and_speeds_change_nothing(unwatched: Run) -> None:
    watched = Watched(speed=200.0)
    watched.start()
    live = watched.live
    live.control({"do": "pause"})
    stood = watched.until(lambda told: told["paused"])["known_s"]
    for _ in range(5):
        live.control({"do": "step"})
        now = watched.until(lambda told: told["known_s"] > stood)["known_s"]  # noqa: B023
        stood = now
    live.control({"do": "step", "by_s": 7.25})
    time.sleep(0.2)
    told = watched.until(lambda told: told["known_s"] > stood + 7)
    assert told["known_s"] == pytest.approx(stood + 7.25, abs=2e-6)
    live.control({"do": "run", "speed": 2000.0})
    live.control({"do": "run"})
    run = watched.result()
    pd.testing.assert_series_equal(reproducible(run), reproducible(unwatched))
    for name, column in unwatched.trace.items():
        np.testing.assert_array_equal(run.trace[name], column)


def test_what_is_told_bit_by_bit_is_the_whole(unwatched: Run) -> None:
    watched = Watched(speed=400.0)
    watched.start()
    parts: list[dict[str, Any]] = []
    known, ended = Known(), ""
    while not ended:
        header, arrays = watched.told(known)
        parts.append(arrays)
        known, ended = Known(**header["live"]["known"]), header["live"]["ended"]
        time.sleep(0.03)
    assert len(parts) > 5
    events = {name: np.concatenate([part[name] for part in parts]) for name in parts[0]}
    assert unwatched.events is not None
    expected = scene.happenings(unwatched.events.columns())
    for name, column in expected.items():
        np.testing.assert_array_equal(events[name], column)
    trace = unwatched.trace
    for robot in range(8):
        rows: list[tuple[float, int, int]] = []
        for part in parts:
            first, last = part["motion.robot_start"][robot : robot + 2]
            names = ("motion.t0_us", "motion.kind", "motion.from_wp")
            news = list(zip(*(part[name][first:last].tolist() for name in names), strict=True))
            rows = [row for row in rows if not news or row[0] < news[0][0]] + news
        # standing is told bit by bit
        told = [b for a, b in pairwise([(0, -1, -1), *rows]) if not b[1] == a[1] == Piece.HOLD]
        own = trace["robot"] == robot
        names = ("t0_us", "kind", "from_wp")
        assert told == list(zip(*(trace[name][own].tolist() for name in names), strict=True))


def test_a_page_that_goes_leaves_the_run_as_it_was(unwatched: Run) -> None:
    watched = Watched()
    watched.live.control({"do": "pause"})
    watched.start()
    watched.told(page="one")
    watched.told(page="two")
    watched.live.leave("one")
    time.sleep(0.2)
    assert watched.thread.is_alive()
    watched.live.leave("two")
    pd.testing.assert_series_equal(reproducible(watched.result()), reproducible(unwatched))


def test_what_comes_late_from_a_closed_page_counts_for_nothing(unwatched: Run) -> None:
    watched = Watched(speed=1000.0)
    watched.start()
    watched.told(page="one")
    watched.live.leave("one")
    # sent before, arrived after
    watched.live.control({"do": "pause", "page": "one"})
    watched.told(page="one")
    pd.testing.assert_series_equal(reproducible(watched.result()), reproducible(unwatched))


def test_a_rule_exchanged_by_hand_is_told(tmp_path: Any) -> None:
    watched = Watched()
    watched.live.control({"do": "pause"})
    watched.start()
    watched.live.control({"do": "step", "by_s": 100.0})
    watched.until(lambda told: told["known_s"] >= 99.99)
    with pytest.raises(InputError, match="did you mean random"):
        watched.live.exchange("psa", {"name": "randm"})
    with pytest.raises(InputError, match="cannot be exchanged"):
        watched.live.exchange("pp", {"name": "far"})
    with pytest.raises(InputError, match="dummy"):
        watched.live.exchange("psa", {"name": "dummy"})
    with pytest.raises(InputError, match="files can be chosen on the command line only"):
        watched.live.exchange("psa", {"name": "nearest", "congestion_from": "heat.csv"})
    watched.live.exchange("psa", {"name": "random"})
    told = watched.until(lambda told: told["controllers"]["psa"]["name"] == "random")
    assert told["paused"]
    watched.live.control({"do": "run"})
    run = watched.result()
    assert run.footprint["controllers"] == "default+psa=random@100.000000s"
    write_run(run, tmp_path / "run")
    parameters = load_run(tmp_path / "run").parameters
    (by_hand,) = parameters["interventions"]
    assert (by_hand["time_s"], by_hand["problem"]) == (100.0, "psa")
    assert by_hand["rule"]["name"] == "random"
    assert parameters["controllers"]["name"] == "default"
    # the same exchange, written down beforehand
    planned = rmfs.simulate(
        "default",
        "default",
        "default",
        seed=4,
        overrides=[
            *SETTINGS,
            (
                ["controllers", "mm"],
                {"name": "scheduled", "exchanges": [{"at_s": 100.0, "psa": {"name": "random"}}]},
            ),
        ],
    )
    names = ["units_picked", "distance_m", "trips", "pick_visits", "order_turnover_mean_s"]
    assert run.footprint[names].tolist() == planned.footprint[names].tolist()


def test_after_the_end_pages_are_told_why() -> None:
    watched = Watched()
    watched.start()
    watched.result()
    header, _ = unpack(watched.live.scene())
    assert header["live"]["ended"] == "the run has ended"
    assert header["live"]["known_s"] == 330.0
    with pytest.raises(InputError, match="has ended"):
        watched.live.exchange("psa", {"name": "random"})


def test_a_run_that_waits_for_its_page_begins_when_that_asks() -> None:
    watched = Watched()
    waits = threading.Thread(target=watched.live.await_page, args=(3600.0,), daemon=True)
    waits.start()
    asks = threading.Thread(target=watched.live.scene, daemon=True)
    asks.start()
    waits.join(60)
    assert not waits.is_alive()
    # the page waits for the run, and is not there yet when it ends
    watched.start()
    watched.result()
    asks.join(60)
    assert not asks.is_alive()
    leaves = threading.Thread(target=watched.live.await_farewell, args=(3600.0,), daemon=True)
    leaves.start()
    watched.told(page="one")
    watched.live.leave("one")
    leaves.join(60)
    assert not leaves.is_alive()


def test_a_run_that_never_began_is_told() -> None:
    live = LiveRun(NAMES, title="test")
    live.close("the run was aborted")
    with pytest.raises(InputError, match="aborted"):
        live.scene()


ASKED = [
    "/live?motion=-1",
    "/live?motion=99999999999999999999",
    "/live?events=-1",
    "/live?motion=x",
]
ASKED += [
    f"/live?page={'x' * 100}",
    "/runs/0?motion=-1",
    "/live?motion=%00",
    "//[",
]
SENT: list[tuple[str, Any]] = [
    *(("/control", {"do": "run", "speed": speed}) for speed in (1e308, 1e-308, 0, -1, "x", [], {})),
    *(("/control", {"do": "step", "by_s": by_s}) for by_s in (1e308, -1, "x", None, [])),
    *(("/control", wish) for wish in (None, 3, [], {}, {"do": "stop"}, {"do": "run", "page": 4})),
    *(("/leave", wish) for wish in (None, {}, {"page": []}, {"page": "x" * 100})),
    *(("/exchange", wish) for wish in (None, {}, {"problem": [], "rule": 3})),
    ("/exchange", {"problem": "psa", "rule": {"name": 3}}),
]


def test_no_request_ends_or_alters_a_run(unwatched: Run) -> None:
    """What is wrong with a request is answered with a reason, and the run goes on as ever."""
    watched = Watched(speed=200.0)
    with live_server(watched.live) as server:
        threading.Thread(target=server.serve_forever, daemon=True).start()
        watched.start()
        line = http.client.HTTPConnection("127.0.0.1", server.server_port, timeout=20)
        head = {"Content-Type": "application/json", "Cookie": f"{server.cookie}={server.token}"}
        for path in ASKED:
            line.request("GET", path, headers=head)
            answer = line.getresponse()
            told = answer.read()
            assert answer.status in (400, 404, 422) or path.startswith("/runs"), path
            assert answer.status == 200 or json.loads(told)["error"]
        for path, wish in SENT:
            line.request("POST", path, json.dumps(wish), headers=head)
            answer = line.getresponse()
            assert answer.status in (400, 422), (path, wish)
            assert json.loads(answer.read())["error"]
        watched.live.control({"do": "run"})
        run = watched.result()
        server.shutdown()
    pd.testing.assert_series_equal(reproducible(run), reproducible(unwatched))


@pytest.mark.parametrize("site", ["cross-site", "same-site"])
def test_pages_elsewhere_do_not_reach_the_run(site: str) -> None:
    """An image on a foreign page sends a GET without an origin; browsers tell its site."""
    watched = Watched()
    watched.live.control({"do": "pause"})
    watched.start()
    with live_server(watched.live) as server:
        threading.Thread(target=server.serve_forever, daemon=True).start()
        line = http.client.HTTPConnection("127.0.0.1", server.server_port, timeout=20)
        head = {"Cookie": f"{server.cookie}={server.token}"}
        for path in ("/live?motion=0&page=other", "/runs/0", "/problems", "/session"):
            line.request("GET", path, headers={**head, "Sec-Fetch-Site": site})
            answer = line.getresponse()
            assert (answer.status, answer.read()[:9]) == (403, b'{"error":')
            line.request("GET", path, headers={**head, "Sec-Fetch-Site": "same-origin"})
            answer = line.getresponse()
            answer.read()
            assert answer.status == 200
        line.request(
            "GET", "/", headers={"Sec-Fetch-Site": site}
        )  # a link to the page may be anywhere
        assert line.getresponse().status == 200
        server.shutdown()
    watched.live.control({"do": "run"})
    watched.result()


def test_a_run_does_not_wait_for_who_may_only_look() -> None:
    watched = Watched()
    watched.live.control({"do": "pause"})
    watched.start()
    with live_server(watched.live) as server:
        threading.Thread(target=server.serve_forever, daemon=True).start()
        line = http.client.HTTPConnection("127.0.0.1", server.server_port, timeout=20)
        line.request("GET", "/live?page=stranger")
        assert line.getresponse().status == 200
        watched.live.news(NOTHING, "one")
        watched.live.leave("one")  # nobody is left who holds it back
        watched.result()
        server.shutdown()


def test_an_exchange_that_is_refused_is_the_page_s_concern(
    unwatched: Run, monkeypatch: Any
) -> None:
    """A rule that cannot be made here, as its constructor says so."""
    from rmfs.control.psa.random import RandomPlace

    def refuse(*_: object) -> None:
        raise InputError("not in this warehouse")

    watched = Watched()
    watched.live.control({"do": "pause"})
    watched.start()
    watched.live.control({"do": "step", "by_s": 100.0})
    watched.until(lambda told: told["known_s"] >= 99.99)
    monkeypatch.setattr(RandomPlace, "__init__", refuse)
    with pytest.raises(InputError, match="not in this warehouse"):
        watched.live.exchange("psa", {"name": "random"})
    watched.live.control({"do": "run"})
    run = watched.result()
    pd.testing.assert_series_equal(reproducible(run), reproducible(unwatched))


NESTED = {"name": "scheduled", "exchanges": [{"at_s": 1.0, "psa": {"name": "imported_by_page:X"}}]}
WISHES = [
    ("psa", {"name": "imported_by_page:X"}),
    ("psa", {"name": "imported_by_page.py:X"}),
    ("mm", NESTED),
]


@pytest.fixture
def module_to_import(tmp_path: Any, monkeypatch: Any) -> None:
    (tmp_path / "imported_by_page.py").write_text("raise SystemExit(3)\n")
    monkeypatch.chdir(tmp_path)


@pytest.mark.usefixtures("module_to_import")
@pytest.mark.parametrize(("problem", "rule"), WISHES)
def test_pages_import_no_code_by_an_exchange(problem: str, rule: Any) -> None:
    watched = Watched()
    with pytest.raises(InputError, match="must be the name of an installed class"):
        watched.live.exchange(problem, rule)
    assert not [name for name in sys.modules if "imported_by_page" in name]


@pytest.mark.usefixtures("module_to_import")
@pytest.mark.parametrize(
    "change",
    [
        *({f"controllers.{problem}": rule} for problem, rule in WISHES),
        {"layout.other_stations.x": {"kind": "imported_by_page:X", "north": 1}},
        {"controllers.psa.name": "imported_by_page.py:X"},
    ],
)
def test_pages_import_no_code_by_starting_a_run(change: Any, tmp_path: Any) -> None:
    with pytest.raises(InputError, match="must be the name of an installed class"):
        Starter(tmp_path / "results").start({"set": change})
    assert not [name for name in sys.modules if "imported_by_page" in name]


@pytest.mark.parametrize(
    ("key", "change", "part"),
    [
        ("scenario.demand", {"mode": "stream", "file": "FILE"}, "scenario"),
        ("controllers.psa", {"name": "nearest", "congestion_from": "FILE"}, "controllers"),
        ("controllers.psa.congestion_from", "FILE", "controllers"),
        ("controllers.pp", {"name": "time-windows", "guidance": "FILE"}, "controllers"),
        ("controllers.pp.guidance", "FILE", "controllers"),
    ],
)
def test_pages_read_no_files(key: str, change: Any, part: str, tmp_path: Path) -> None:
    file = tmp_path / "heat.csv"
    file.write_text("order,sku,units,time_s\n0,0,1,0.0\n")
    given = json.loads(json.dumps(change).replace("FILE", str(file)))
    with pytest.raises(InputError, match=f"{part}: files can be chosen on the command line only"):
        Starter(tmp_path / "results").start({"set": {key: given}})
    assert not (tmp_path / "results").exists()


@pytest.mark.usefixtures("module_to_import")
def test_pages_import_no_code_by_a_preview() -> None:
    kind = {"kind": "imported_by_page:X", "north": 1}
    with pytest.raises(InputError, match="must be the name of an installed class"):
        preview({"set": {"layout.other_stations.x": kind}})
    assert not [name for name in sys.modules if "imported_by_page" in name]

"""Watching a run in Chromium, exchanging a rule in it, and starting one from the form."""

from __future__ import annotations

import json
import re
import signal
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from in_browser import needs_browser, show

from rmfs.measure import load_run

pytestmark = [pytest.mark.slow, needs_browser]

RUN = [
    *("run", "--live", "--no-open", "--seed", "3", "--set", "layout.robots=8"),
    *("--set", "scenario.warmup_s=0", "--set", "scenario.duration_s=1200"),
]


@pytest.fixture
def started(tmp_path: Path) -> Iterator[Any]:
    """Starts `rmfs` in a folder of its own; yields a function that returns process and address."""
    begun: list[subprocess.Popen[str]] = []

    def start(*arguments: str) -> tuple[subprocess.Popen[str], str]:
        made = subprocess.Popen(
            [sys.executable, "-m", "rmfs", *arguments],
            cwd=tmp_path,
            text=True,
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
        )
        begun.append(made)
        assert made.stdout is not None
        return made, made.stdout.readline().strip()

    yield start
    for process in begun:
        if process.poll() is None:
            process.send_signal(signal.SIGINT)
        process.communicate(timeout=60)


def known_s(page: Any) -> float:
    return float(page.evaluate("rmfs.runs[0].live.known_s"))


def test_a_run_is_watched_paused_stepped_and_changed(
    started: Any, page: Any, tmp_path: Path
) -> None:
    process, url = started(*RUN, "--speed", "20", "--out", "run")
    show(page, url)
    page.wait_for_function("rmfs.runs[0].live.known_s > 5")
    page.wait_for_function("rmfs.store.state.time_s > 4")
    page.click("#live-pause")
    page.wait_for_function("rmfs.runs[0].live.paused")
    stood = known_s(page)
    assert "paused" in page.text_content("#live-status")
    page.click("#live-step")
    page.wait_for_function(f"rmfs.runs[0].live.known_s > {stood}")
    stood = known_s(page)
    page.click("#live-step-seconds")
    page.wait_for_function(f"rmfs.runs[0].live.known_s > {stood} + 9.99")
    assert known_s(page) == pytest.approx(stood + 10, abs=1e-5)
    page.evaluate("rmfs.store.set({ time_s: 2 })")
    page.wait_for_timeout(300)
    assert page.evaluate("rmfs.store.state.time_s") == 2
    assert page.evaluate("rmfs.live.following") is False
    page.click("#live-present")
    page.wait_for_function("rmfs.store.state.time_s > 5")
    page.click("#live-exchange")
    page.select_option("#exchange-problem", "psa")
    page.select_option("#exchange .rule select", "random")
    page.click("#exchange-install")
    page.wait_for_function("rmfs.runs[0].live.controllers.psa.name === 'random'")
    page.select_option("#live-pace", "max")
    process.wait(timeout=120)
    page.wait_for_function("rmfs.runs[0].live.ended !== ''")
    assert page.evaluate("rmfs.runs[0].live.ended") == "the run has ended"
    assert known_s(page) == 1200
    (by_hand,) = load_run(tmp_path / "run").parameters["interventions"]
    assert by_hand["rule"]["name"] == "random"
    shown = page.evaluate("rmfs.runs[0].events.all.filter(({ kind }) => kind === 4).length")
    assert shown == load_run(tmp_path / "run").footprint["units_picked"]


def test_closing_the_page_lets_the_run_go_on(started: Any, page: Any, tmp_path: Path) -> None:
    process, url = started(*RUN, "--out", "run", "--speed", "50", "--await-page")
    show(page, url)
    page.click("#live-pause")
    page.goto("about:blank")
    assert process.wait(timeout=120) == 0
    alone, _ = started(*RUN, "--out", "alone")
    assert alone.wait(timeout=120) == 0
    first, second = (load_run(tmp_path / name) for name in ("run", "alone"))
    for table in ("orders", "trips", "robots", "pods"):
        assert first.table(table).equals(second.table(table)), table


def test_the_form_has_words_units_and_a_preview(started: Any, page: Any) -> None:
    _, url = started("view", "--no-open")
    page.goto(url)
    counts = page.locator("#preview .counts:not(:empty)")
    counts.wait_for()
    assert "28 m, 16 robots, 428 pods" in counts.text_content()
    for part in page.query_selector_all("details"):
        part.evaluate("one => { one.open = true; }")
    duration = page.locator("label[title^='duration_s: ']")
    assert duration.locator("span").text_content() == "measured time"
    assert duration.locator("output").text_content() == "s = 4 h"
    duration.locator("input").fill("5400")
    assert duration.locator("output").text_content() == "s = 1 h 30 min"
    assert page.locator("label[title^='top_speed_m_s: '] output").text_content() == "m/s"
    robots = page.locator("label[title^='robots: '] input").first
    before = page.evaluate("document.querySelector('#preview canvas').toDataURL()")
    robots.fill("25")
    page.wait_for_function(
        "document.querySelector('#preview .counts').textContent.includes('25 robots')"
    )
    assert page.evaluate("document.querySelector('#preview canvas').toDataURL()") != before
    button = page.locator("#start-run").bounding_box()
    robots.fill("0")
    page.wait_for_selector("#preview .wrong:not(:empty)")
    assert page.locator("#start-run").bounding_box() == button, "a click may miss it"
    robots.fill("7")
    page.wait_for_selector("#preview .wrong:empty", state="attached")
    page.select_option("#start-layout", "small")
    page.wait_for_function(
        "/^(?!56 ).+ pods/.test(document.querySelector('#preview .counts').textContent)"
    )


def test_the_form_starts_a_run(started: Any, page: Any, tmp_path: Path) -> None:
    _, url = started("view", "--no-open")
    page.goto(url)
    page.wait_for_selector("#start-run")
    for part in page.query_selector_all("details"):
        part.evaluate("one => { one.open = true; }")
    robots = page.locator("label", has=page.locator("span", has_text=re.compile("^robots$")))
    robots.locator("input").fill("0")
    page.click("#start-run")
    refused = page.wait_for_selector(".wrong:not(#preview .wrong):not(:empty)")
    assert "robots" in refused.text_content()
    robots.locator("input").fill("6")
    for name, value in {"warmup_s": "0", "duration_s": "1800"}.items():
        page.locator(f"label[title^='{name}: ']").locator("input").fill(value)
    page.locator("#start-psa select").first.select_option("random")
    page.fill("#start-out", "mine")
    page.fill("#start-speed", "600")
    page.click("#start-run")
    page.wait_for_function("window.rmfs?.runs[0].live !== undefined")
    assert page.evaluate("rmfs.runs[0].layout.robotWaypoint.length") == 6
    page.wait_for_function("rmfs.runs[0].live.ended !== ''")
    written = tmp_path / "results" / "mine" / "run.json"
    for _ in range(600):
        if written.is_file():
            break
        page.wait_for_timeout(100)
    parameters = json.loads(written.read_text())
    assert parameters["controllers"]["parameters"]["psa"]["name"] == "random"
    assert parameters["overrides"]["layout.robots"] == 6
    assert parameters["duration_s"] == 1800

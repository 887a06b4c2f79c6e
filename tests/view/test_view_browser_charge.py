"""What is in batteries in Chromium: robots' colour, the chart, what is said of a robot."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from in_browser import needs_browser, put, show

import rmfs
from rmfs.measure import RunFolder, load_run, write_run
from rmfs.view.answers import replay_server
from rmfs.view.export import export
from tests.tools.viewer.chromium import served

pytestmark = [pytest.mark.slow, needs_browser]

END_S = 900.0
CHARGED = {
    "layout.robots": 10,
    "layout.other_stations.charger": {"kind": "charger", "north": 2},
    "scenario.energy.battery": {"capacity_wh": 100, "initial_least_share": 0.35},
    "scenario.warmup_s": 0,
    "scenario.duration_s": END_S,
}


@pytest.fixture(scope="module")
def charged(tmp_path_factory: pytest.TempPathFactory) -> RunFolder:
    path = tmp_path_factory.mktemp("charged") / "run"
    write_run(rmfs.simulate(seed=1, set=CHARGED, trace=True), path, trace=True)
    return load_run(path)


@pytest.fixture
def shown(page: Any, charged: RunFolder) -> Iterator[Any]:
    with served(replay_server([charged])) as url:
        show(page, url)
        yield page


def check_levels(page: Any, run: RunFolder) -> None:
    """The page shows what the tables say of the end."""
    levels = page.evaluate(f"rmfs.runs[0].robots.levels.map((steps) => steps.at({END_S} * 1e6))")
    expected = (run.table("robots")["level_wh"] / 100).tolist()
    assert levels == pytest.approx(expected, abs=0.03)  # known to the last minute
    assert min(levels) < max(levels)


def test_levels_are_those_of_the_tables(shown: Any, charged: RunFolder) -> None:
    check_levels(shown, charged)
    mean = shown.evaluate("rmfs.runs[0].course().charge")
    series = charged.table("series")["level_mean_wh"]
    assert mean[-1] == pytest.approx(series.iloc[-1], abs=3.0)  # per cent of 100 Wh


def test_robots_have_the_colour_of_their_charge(shown: Any) -> None:
    put(shown, f"time_s: {END_S - 60}, robots: 'task'")
    by_task = shown.evaluate("rmfs.picture()")
    put(shown, "robots: 'charge'")
    assert shown.evaluate("rmfs.picture()") != by_task
    assert "100 % of the battery" in shown.text_content(".legend")
    put(shown, "selection: { run: 0, what: 'robot', index: 0 }")
    assert "battery" in shown.text_content(".details")
    # levels are no news of a robot
    assert "battery:" not in shown.text_content(".details ol")


def test_there_is_a_chart(shown: Any) -> None:
    titles = shown.text_content(".charts")
    assert "Charge" in titles
    assert "% in the mean" in titles


def test_an_exported_page_has_it_too(page: Any, charged: RunFolder, tmp_path: Path) -> None:
    export([charged], tmp_path / "run.html")
    show(page, (tmp_path / "run.html").as_uri())
    check_levels(page, charged)

"""What surrounds the picture in Chromium: where replay begins, hints, panel, folds, charts."""

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from in_browser import needs_browser, put, show, state

from rmfs.measure import RunFolder
from rmfs.view.answers import replay_server
from rmfs.view.export import export
from tests.tools.viewer.chromium import open_page, served

pytestmark = [pytest.mark.slow, needs_browser]

WARMUP_S, END_S = 60.0, 660.0
"""Of the recorded run of conftest.py."""

AT = """([kind, index]) => {
  const [pane] = window.rmfs.panes;
  const { layout } = pane.run;
  const waypoint = {
    station: () => layout.header.stations[index].waypoint,
    pod: () => pane.run.places.of[index].at(window.rmfs.store.state.time_s * 1e6),
    waypoint: () => index,
  }[kind];
  const { x, y } = kind === "robot"
    ? pane.poses[index]
    : { x: layout.x[waypoint()], y: layout.y[waypoint()] };
  const camera = pane.stage.plan;
  const point = camera.position.clone().set(x, y, 0.1).project(camera);
  const frame = pane.stage.canvas.getBoundingClientRect();
  return [
    frame.left + (1 + point.x) / 2 * frame.width,
    frame.top + (1 - point.y) / 2 * frame.height,
  ];
}"""
"""Where something is on the page."""


@pytest.fixture
def opened(page: Any, runs: list[RunFolder]) -> Iterator[Any]:
    with replay_server(runs[:1]) as server, served(server) as url:
        show(page, url)
        put(page, "time_s: 300")
        yield page


def test_replay_opens_at_the_end_of_the_warm_up_and_plays(
    browser: Any, runs: list[RunFolder], tmp_path: Path
) -> None:
    export(runs[:1], tmp_path / "one.html")
    page = open_page(browser, bypass_csp=True)
    page.goto((tmp_path / "one.html").as_uri())
    page.wait_for_function("window.rmfs?.frames > 0")
    assert WARMUP_S <= state(page, "time_s") < WARMUP_S + 120
    page.wait_for_function(f"window.rmfs.store.state.time_s > {WARMUP_S} + 1")
    link = page.evaluate("window.rmfs.link()")
    page.close()
    again = open_page(browser, bypass_csp=True)
    again.goto(link)
    again.wait_for_function("window.rmfs?.frames > 0")
    assert state(again, "playing") is False
    again.close()
    calm = open_page(browser, bypass_csp=True, reduced_motion="reduce")
    calm.goto((tmp_path / "one.html").as_uri())
    calm.wait_for_function("window.rmfs?.frames > 0")
    assert (state(calm, "playing"), state(calm, "time_s")) == (False, WARMUP_S)
    calm.close()


def test_the_mouse_is_told_what_is_under_it(opened: Any) -> None:
    # at the beginning nobody is at a station
    put(opened, "time_s: 0")
    free = opened.evaluate(
        "(() => { const { layout } = rmfs.runs[0];"
        " return layout.isStorage.findIndex((is, v) => !is && !layout.isQueue[v]"
        " && layout.x[v] > 10 && layout.x[v] < 20); })()"
    )
    stored = opened.evaluate("rmfs.runs[0].places.of.findIndex(steps => steps.at(0) >= 0)")
    quiet = opened.evaluate(
        "rmfs.runs[0].header.stations.findIndex(({ waypoint }) => {"
        " const { x, y } = rmfs.runs[0].layout;"
        " return rmfs.panes[0].poses.every(pose =>"
        " Math.hypot(pose.x - x[waypoint], pose.y - y[waypoint]) > 2); })"
    )
    letter = opened.evaluate(f"rmfs.runs[0].header.stations[{quiet}].letter")
    for what, index, words in [
        ("robot", 3, "robot 3: "),
        ("pod", stored, f"pod {stored}: "),
        ("station", quiet, f"{letter}{quiet}, "),
        ("waypoint", free, f"waypoint {free}"),
    ]:
        opened.mouse.move(*opened.evaluate(AT, [what, index]))
        opened.wait_for_function(
            "words => document.querySelector('.hint').textContent.startsWith(words)", arg=words
        )
        assert opened.is_visible(".hint")
    opened.mouse.move(5, 5)
    opened.wait_for_selector(".hint", state="hidden")


def test_the_panel_is_as_wide_as_it_was_dragged(opened: Any) -> None:
    wide = opened.locator("aside").bounding_box()["width"]
    handle = opened.locator(".handle").bounding_box()
    y = handle["y"] + handle["height"] / 2
    opened.mouse.move(handle["x"] + 4, y)
    opened.mouse.down()
    opened.mouse.move(handle["x"] - 96, y, steps=4)
    opened.mouse.up()
    assert opened.locator("aside").bounding_box()["width"] == pytest.approx(wide + 100, abs=6)
    opened.reload()
    opened.wait_for_function("window.rmfs?.frames > 0")
    assert opened.locator("aside").bounding_box()["width"] == pytest.approx(wide + 100, abs=6)
    opened.focus(".handle")
    opened.keyboard.press("ArrowRight")
    assert opened.locator("aside").bounding_box()["width"] == pytest.approx(wide + 80, abs=6)
    opened.dblclick(".handle")
    assert opened.locator("aside").bounding_box()["width"] == wide


def test_charts_and_legend_fold_and_stay_folded(opened: Any) -> None:
    high = opened.locator(".details").bounding_box()["height"]
    opened.click(".charts-part > summary")
    assert opened.locator(".details").bounding_box()["height"] > high + 100
    opened.reload()
    opened.wait_for_function("window.rmfs?.frames > 0")
    assert opened.is_hidden(".charts")
    opened.click(".charts-part > summary")
    opened.wait_for_selector(".charts .u-over >> nth=0")


def test_a_click_in_a_chart_seeks_and_the_mouse_reads_it(opened: Any) -> None:
    plot = opened.locator(".charts .u-over").first.bounding_box()
    middle = (plot["x"] + plot["width"] / 2, plot["y"] + plot["height"] / 2)
    opened.mouse.click(*middle)
    assert state(opened, "time_s") == pytest.approx(END_S / 2, rel=0.02)
    opened.mouse.move(middle[0] + plot["width"] / 4, middle[1])
    opened.wait_for_function("document.querySelector('.charts h3').textContent.includes('at 0:08')")
    bars = opened.evaluate(
        "rmfs.runs[0].course().robots.reduce((sum, counts) => sum + counts.at(-1), 0)"
    )
    assert bars == 12


@pytest.mark.parametrize("what", ["station", "pod"])
def test_what_is_chosen_is_read_without_scrolling(opened: Any, what: str) -> None:
    opened.set_viewport_size({"width": 1280, "height": 720})
    choice = "what: 'station', index: 0" if what == "station" else "what: 'pod', index: 3"
    opened.evaluate(f"window.rmfs.store.set({{ selection: {{ run: 0, {choice} }} }})")
    last = opened.locator(".chosen .orders .order" if what == "station" else ".holds .tile").last
    last.wait_for()
    box, frame = last.bounding_box(), opened.locator(".details").bounding_box()
    assert box["y"] + box["height"] <= frame["y"] + frame["height"]

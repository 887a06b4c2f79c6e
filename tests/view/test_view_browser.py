"""The page in Chromium: what it shows is what the trace says."""

from __future__ import annotations

import re
import threading
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from in_browser import needs_browser, put, show, state

from rmfs.measure import RunFolder
from rmfs.measure.checker import motion
from rmfs.measure.checker.trace import Kinematics, read
from rmfs.view.answers import replay_server
from rmfs.view.export import export
from tests.tools.viewer.chromium import open_page

pytestmark = [pytest.mark.slow, needs_browser]

POSITIONS = """times => times.map(time_s => {
  const { motion } = window.rmfs.runs[0];
  const pose = {};
  return motion.tracks.flatMap((_, robot) => {
    const { x, y } = motion.pose(robot, time_s * 1e6, pose);
    return [x, y];
  });
})"""
"""Positions of all robots at some times: x and y in turn."""


@pytest.fixture
def address(runs: list[RunFolder]) -> Iterator[str]:
    with replay_server(runs[:1]) as server:
        threading.Thread(target=server.serve_forever, daemon=True).start()
        yield server.url
        server.shutdown()


def expected_positions(run: RunFolder, times: np.ndarray) -> np.ndarray:
    """Positions by the trace checker, shape (times, robots, 2); nan in elevators."""
    layout = run.layout
    rows = read(layout, run.trace)
    pieces = motion.cut(layout, rows, Kinematics.of(layout, rows.robot))
    robot = rows.robot[pieces.row]
    found = np.full((len(times), layout.robots, 2), np.nan)
    for number, time_s in enumerate(times):
        now = np.flatnonzero((pieces.t0_s <= time_s) & (time_s < pieces.t1_s))
        x, y = pieces.take(now).at(np.full(len(now), time_s))
        found[number, robot[now]] = np.column_stack([x, y])
    return found


def test_positions_agree_with_the_checker_at_a_thousand_instants(
    address: str, page: Any, runs: list[RunFolder]
) -> None:
    show(page, address)
    times = np.random.default_rng(8).uniform(0, 660, 1000)
    expected = expected_positions(runs[0], times)
    assert np.isfinite(expected).all()
    shown = np.array(page.evaluate(POSITIONS, times.tolist())).reshape(expected.shape)
    assert np.abs(shown - expected).max() < 0.001


def test_pods_are_where_the_run_left_them(address: str, page: Any, runs: list[RunFolder]) -> None:
    show(page, address)
    where = page.evaluate("window.rmfs.runs[0].places.of.map(steps => steps.at(660e6))")
    pods = runs[0].table("pods")
    stored = np.array(where) >= 0
    assert 0 < stored.sum() < len(pods)
    assert (np.array(where)[stored] == pods["waypoint_end"].to_numpy()[stored]).all()
    fill = page.evaluate("Array.from(window.rmfs.runs[0].stock.used, steps => steps.at(660e6))")
    np.testing.assert_allclose(fill, pods["used_end"], atol=1e-6)


def test_the_heat_map_counts_what_the_run_counted(
    address: str, page: Any, runs: list[RunFolder]
) -> None:
    show(page, address)
    visits = page.evaluate("Array.from(window.rmfs.runs[0].passages.count('visits', 60e6, 660e6))")
    counted = runs[0].table("heat").sort_values("waypoint")["visits"]
    assert counted.sum() > 1000
    # a move that is in progress at either end may be counted on the other side of it
    difference = np.abs(np.array(visits) - counted.to_numpy())
    assert difference.sum() < 0.01 * counted.sum()


def test_it_plays_seeks_and_changes_the_view(address: str, page: Any) -> None:
    show(page, address)
    before = state(page, "time_s")
    page.click("#play")
    page.wait_for_function(f"window.rmfs.store.state.time_s > {before} + 1")
    page.click("#play")
    assert state(page, "playing") is False
    page.evaluate("window.rmfs.store.set({ time_s: 300 })")
    assert page.input_value("#seek") == "300"
    assert page.input_value("#time") == "0:05:00"
    for key, value in {
        "mode": "3d",
        "robots": "delay",
        "pods": "fill",
        "heat": "waiting",
    }.items():
        before = page.evaluate("window.rmfs.frames")
        page.select_option(f"#choose-{key}", value)
        assert state(page, key) == value
        page.wait_for_function(f"window.rmfs.frames > {before}")
    page.keyboard.press("Tab")
    page.evaluate("document.activeElement.blur()")
    for key, name, value in [
        ("2", "mode", "2d"),
        ("ArrowRight", "time_s", 310),
        ("w", "paths", True),
        ("d", "theme", "dark"),
    ]:
        if name == "theme":
            page.evaluate("window.rmfs.store.set({ theme: 'light' })")
        page.keyboard.press(key)
        assert state(page, name) == value


def test_a_click_selects_a_robot_and_a_link_restores_the_view(address: str, page: Any) -> None:
    show(page, address)
    put(page, "time_s: 200")
    chosen = None
    canvas = page.locator(".pane canvas").bounding_box()
    for robot in range(12):
        x, y = page.evaluate(
            """robot => {
              const [pane] = window.rmfs.panes;
              const { x, y } = pane.poses[robot];
              const camera = pane.stage.plan;
              const point = camera.position.clone().set(x, y, 0.5).project(camera);
              return [(1 + point.x) / 2, (1 - point.y) / 2];
            }""",
            robot,
        )
        page.mouse.click(canvas["x"] + x * canvas["width"], canvas["y"] + y * canvas["height"])
        chosen = state(page, "selection")
        assert chosen == {"run": 0, "what": "robot", "index": robot}
    page.wait_for_selector(".details h2:text-is('robot 11')")
    page.evaluate("window.rmfs.store.set({ mode: '3d', pods: 'age' })")
    link = page.evaluate("window.rmfs.link()")
    camera = page.evaluate("window.rmfs.panes[0].stage.cameraState")
    page.goto("about:blank")
    show(page, link)
    assert state(page, "selection") == chosen
    assert [state(page, name) for name in ("time_s", "mode", "pods")] == [200, "3d", "age"]
    again = page.evaluate("window.rmfs.panes[0].stage.cameraState")
    np.testing.assert_allclose(again, camera, atol=0.01)


def test_two_runs_share_one_clock_in_one_file(
    page: Any, runs: list[RunFolder], tmp_path: Path
) -> None:
    export(runs, tmp_path / "two.html")
    show(page, (tmp_path / "two.html").as_uri())
    assert page.locator(".pane").count() == 2
    put(page, "time_s: 400")
    rows = page.evaluate("window.rmfs.panes.map(pane => pane.poses.map(pose => [pose.x, pose.y]))")
    times = np.array([400.0])
    for run, shown in zip(runs, rows, strict=True):
        np.testing.assert_allclose(shown, expected_positions(run, times)[0], atol=0.001)
    assert page.evaluate("window.rmfs.picture()").startswith("data:image/png")


def test_a_file_that_is_cut_off_says_so(page: Any, runs: list[RunFolder], tmp_path: Path) -> None:
    export(runs[:1], tmp_path / "one.html")
    text = (tmp_path / "one.html").read_text("utf-8")
    shorter = re.sub(r"(data-scene>[^<]{2000})[^<]*<", r"\1<", text)
    (tmp_path / "cut.html").write_text(shorter, "utf-8")
    page.goto((tmp_path / "cut.html").as_uri())
    page.wait_for_selector(".failure")
    assert "cut off" in page.text_content(".failure")


def test_the_policy_lets_the_page_work(browser: Any, address: str) -> None:
    page = open_page(browser)
    complaints: list[str] = []
    page.on("console", lambda m: complaints.append(m.text) if m.type == "error" else None)
    page.goto(address)
    page.wait_for_selector(".pane canvas")
    page.wait_for_selector(".details table")
    page.close()
    assert complaints == []


def test_a_damaged_run_gives_a_message(browser: Any, runs: list[RunFolder], tmp_path: Path) -> None:
    with replay_server([RunFolder(tmp_path, runs[0].parameters)]) as server:
        threading.Thread(target=server.serve_forever, daemon=True).start()
        page = open_page(browser)
        page.goto(server.url)
        page.wait_for_selector(".failure")
        assert "run with --trace" in page.text_content(".failure")
        page.close()
        server.shutdown()


def test_an_overlay_shows_the_difference_of_two_heat_maps(
    page: Any, runs: list[RunFolder], tmp_path: Path
) -> None:
    export(runs, tmp_path / "two.html")
    show(page, (tmp_path / "two.html").as_uri())
    page.evaluate("window.rmfs.store.set({ time_s: 600, from_s: 60, to_s: 660 })")
    page.check("#tick-overlay")
    page.wait_for_function("window.rmfs.panes[1].root.hidden")
    assert state(page, "heat") == "visits"
    counted = [
        np.array(page.evaluate(f"Array.from(rmfs.runs[{n}].passages.count('visits', 60e6, 660e6))"))
        for n in (0, 1)
    ]
    shown = np.array(page.evaluate("Array.from(rmfs.panes[0].counts)"))
    assert (shown == counted[1] - counted[0]).all()
    assert (shown != 0).sum() > 100
    # the scale follows as soon as the figures beside the picture are due again
    page.wait_for_function(
        "words => document.querySelector('.legend').textContent.includes(words)",
        arg=f"{np.abs(shown).max():.0f} visits more in A",
    )
    assert page.locator(".charts h3").first.text_content().count("B ") == 1
    assert "overlay=1" in page.evaluate("window.rmfs.link()")
    page.uncheck("#tick-overlay")
    page.wait_for_function("!window.rmfs.panes[1].root.hidden")
    assert (np.array(page.evaluate("Array.from(rmfs.panes[0].counts)")) == counted[0]).all()

"""Several tiers in Chromium, and every view and panel of the page."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest
from in_browser import needs_browser, put, show, state

import rmfs
from rmfs.measure import RunFolder, load_run, write_run
from rmfs.view.answers import replay_server
from rmfs.view.themes import THEMES
from tests.tools.viewer.chromium import served

pytestmark = [pytest.mark.slow, needs_browser]

END_S = 900.0


@pytest.fixture(scope="module")
def tiers(tmp_path_factory: pytest.TempPathFactory) -> RunFolder:
    path = tmp_path_factory.mktemp("tiers") / "run"
    overrides: list[tuple[list[str], Any]] = [
        (["layout", "robots"], 16),
        (["scenario", "warmup_s"], 0.0),
        (["scenario", "duration_s"], END_S),
    ]
    run = rmfs.simulate(
        "study-tiers", "pp-minimal", "default", seed=1, overrides=overrides, trace=True
    )
    write_run(run, path, trace=True)
    return load_run(path)


@pytest.fixture
def shown(page: Any, tiers: RunFolder) -> Iterator[Any]:
    with served(replay_server([tiers])) as url:
        show(page, url)
        yield page


def drawn(page: Any) -> str:
    return str(page.evaluate("rmfs.picture()"))


def test_a_robot_in_an_elevator_is_between_the_tiers(shown: Any, tiers: RunFolder) -> None:
    rides = tiers.trace[tiers.trace["kind"] == 3]
    rides = rides[rides["t1_us"] < END_S * 1e6]
    assert len(rides) > 5
    for _, ride in rides.iloc[:5].iterrows():
        middle_s = (ride["t0_us"] + ride["t1_us"]) / 2e6
        pose = shown.evaluate(
            "([robot, s]) => rmfs.runs[0].motion.pose(robot, s * 1e6, {})",
            [int(ride["robot"]), middle_s],
        )
        assert pose["ride"] == pytest.approx(0.5, abs=1e-6)
        assert pose["tier"] == tiers.layout.tier[int(ride["from_wp"])]
        assert pose["tierTo"] == tiers.layout.tier[int(ride["to_wp"])]
        assert pose["tier"] != pose["tierTo"]


def test_one_tier_or_all_in_plan_and_space(shown: Any, tiers: RunFolder) -> None:
    count = len(tiers.layout.tiers)
    assert count > 1
    pictures = set()
    for mode in ("2d", "3d"):
        for tier in range(-1, count):
            put(shown, f"mode: '{mode}', tier: {tier}, time_s: 300")
            visible = shown.evaluate("rmfs.panes[0].placement.shown")
            assert visible == [tier in (-1, number) for number in range(count)]
            pictures.add(drawn(shown))
    assert len(pictures) == 2 * (count + 1)
    shown.evaluate("document.activeElement.blur()")
    put(shown, "tier: -1")
    shown.keyboard.press("t")
    assert state(shown, "tier") == 0


@pytest.mark.parametrize(
    ("key", "values"),
    [
        ("robots", ("task", "state", "load", "delay")),
        ("pods", ("plain", "fill", "popularity", "age")),
        ("heat", ("off", "visits", "waiting")),
        ("theme", ("light", "dark")),
    ],
)
def test_every_choice_looks_different_and_has_a_legend(
    shown: Any, key: str, values: tuple[str, ...]
) -> None:
    put(shown, f"time_s: {END_S - 300}, mode: '2d', tier: 0")
    pictures, legends = set(), set()
    for value in values:
        put(shown, f"{key}: '{value}'")
        pictures.add(drawn(shown))
        legends.add(shown.text_content(".legend") + shown.inner_html(".legend"))
    assert len(pictures) == len(values)
    assert len(legends) == len(values)


@pytest.mark.parametrize("key", ["paths", "zones"])
def test_paths_ahead_and_queue_zones_can_be_hidden(shown: Any, key: str) -> None:
    put(shown, "time_s: 300, tier: 0")
    pictures = []
    for on in ("true", "false"):
        put(shown, f"{key}: {on}")
        pictures.append(drawn(shown))
    assert pictures[0] != pictures[1]


def test_the_heat_map_shows_any_window(shown: Any, tiers: RunFolder) -> None:
    counts = []
    for begin, end in ((0, 300), (300, 600), (0, 600)):
        put(shown, f"heat: 'visits', from_s: {begin}, to_s: {end}")
        counts.append(np.array(shown.evaluate("Array.from(rmfs.panes[0].counts)")))
    assert counts[0].sum() > 100
    np.testing.assert_array_equal(counts[0] + counts[1], counts[2])
    assert "(log.)" in shown.text_content(".legend")


def test_panels_tell_stations_robots_and_pods(shown: Any, tiers: RunFolder) -> None:
    put(shown, f"time_s: {END_S}")
    shown.wait_for_selector(".details table tr:nth-child(2)")
    stations = tiers.table("stations")
    handled = tiers.events["kind"].isin(["unit-picked", "bundle-stored"])
    for station in stations["station"][:3]:
        count = (handled & (tiers.events["station"] == station)).sum()
        told = shown.evaluate(f"rmfs.runs[0].stations.figures({station}, {END_S}e6)")
        assert told["perHour"] == pytest.approx(count * 3600 / END_S)
    for what, words in {
        "station": ("open orders", "idle share", "per h", "queue"),
        "robot": ("task", "state", "carries", "waited", "m,"),
        "pod": ("space used", "picked", "last visit", "Holds"),
    }.items():
        put(shown, f"selection: {{ run: 0, what: '{what}', index: 0 }}")
        shown.wait_for_selector(f".details h2:text-is('{what} 0')")
        text = shown.text_content(".details")
        for word in (*words, "History"):
            assert word in text, (what, word)


def test_next_event_and_following(shown: Any, tiers: RunFolder) -> None:
    put(shown, "time_s: 100, selection: { run: 0, what: 'robot', index: 2 }, follow: true")
    shown.evaluate("document.activeElement.blur()")
    shown.keyboard.press("n")
    own = tiers.events[(tiers.events["robot"] == 2) & (tiers.events["time_us"] > 100_000_001)]
    assert state(shown, "time_s") == own["time_us"].iloc[0] / 1e6
    put(shown, "time_s: 400")
    pose = shown.evaluate("rmfs.panes[0].placement.of(rmfs.panes[0].poses[2])")
    target = shown.evaluate("rmfs.panes[0].stage.cameraState.slice(3, 5)")
    np.testing.assert_allclose(target, [pose["x"], pose["y"]], atol=1e-6)
    shown.keyboard.press("Escape")
    assert state(shown, "selection") is None
    assert state(shown, "follow") is False


def test_the_keys_are_listed_and_work(shown: Any) -> None:
    shown.evaluate("document.activeElement.blur()")
    for key, name, value in [
        (" ", "playing", True),
        ("3", "mode", "3d"),
        ("r", "robots", "state"),
        ("p", "pods", "fill"),
        ("h", "heat", "visits"),
        ("q", "zones", False),
        ("End", "time_s", END_S),
        ("Home", "time_s", 0),
    ]:
        if name == "time_s":
            shown.evaluate("rmfs.store.set({ playing: false })")
        shown.keyboard.press(key)
        assert state(shown, name) == value, key
    speed = state(shown, "speed")
    shown.keyboard.press("+")
    assert state(shown, "speed") > speed
    shown.keyboard.press("?")
    assert "faster" in shown.text_content("dialog[open]")


def test_the_picture_button_saves_a_picture(shown: Any) -> None:
    put(shown, "time_s: 60")
    with shown.expect_download() as saved:
        shown.click("button:text-is('picture')")
    assert saved.value.suggested_filename == "run-60s.png"


@pytest.mark.parametrize("theme", THEMES)
def test_the_legend_has_the_colours_of_the_theme(shown: Any, theme: str) -> None:
    put(shown, f"theme: '{theme}', robots: 'task'")
    colours = THEMES[theme]
    legend = shown.inner_html(".legend")
    for colour in (*colours.stations.values(), *colours.tasks.values(), colours.pod):
        red, green, blue = (int(colour[i : i + 2], 16) for i in (1, 3, 5))
        assert f"rgb({red}, {green}, {blue})" in legend

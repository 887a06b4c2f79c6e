"""The orders view in Chromium: what it lists is what the events of the run say."""

import json
from collections import Counter
from pathlib import Path
from typing import Any

import pandas as pd
import pytest
from in_browser import needs_browser, show, state

import rmfs
from rmfs.measure import RunFolder, load_run, write_run
from rmfs.view.answers import replay_server
from rmfs.view.export import export
from tests.tools.viewer.chromium import served

pytestmark = [pytest.mark.slow, needs_browser]

TIME_S = 300.0

BROUGHT = """time_s => {
  const { orders, header } = window.rmfs.runs[0];
  return header.stations.flatMap((_, station) =>
    [...orders.bringing(station, time_s * 1e6)].flatMap(([pod, list]) =>
      list.map(({ order, sku, units }) => [station, pod, order, sku, units])));
}"""


def brought(events: pd.DataFrame, time_s: float) -> set[tuple[int, ...]]:
    """Station, pod, order, SKU and units of all that is under way, by adding up the events."""
    past = events[events["time_us"] <= time_s * 1e6]
    sign = past["kind"].map({"units-bound": 1, "units-unbound": -1, "unit-picked": -1})
    moves = past[sign.notna()].assign(
        units=lambda rows: sign[rows.index].astype(int) * rows["units"]
    )
    left = moves.groupby(["station", "pod", "order", "sku"])["units"].sum()
    return {(*key, units) for key, units in left.items() if units > 0}


@pytest.fixture
def text(page: Any, runs: list[RunFolder]) -> Any:
    with replay_server(runs[:1]) as server, served(server) as url:
        show(page, url)
        page.evaluate(f"window.rmfs.store.set({{ playing: false, time_s: {TIME_S} }})")
        yield page


@pytest.mark.parametrize("time_s", [0.0, 61.0, TIME_S, 659.0])
def test_pods_under_way_are_those_of_the_events(
    text: Any, runs: list[RunFolder], time_s: float
) -> None:
    expected = brought(runs[0].events, time_s)
    assert {tuple(row) for row in text.evaluate(BROUGHT, time_s)} == expected
    assert len(expected) > 3 or time_s == 0.0


def test_orders_of_a_station_by_order_and_by_pod(text: Any, runs: list[RunFolder]) -> None:
    events = runs[0].events
    past = events[events["time_us"] <= TIME_S * 1e6]
    assigned = past[past["kind"] == "order-assigned"].set_index("order")["station"]
    done = past[past["kind"] == "order-completed"]["order"]
    open_at = Counter(assigned.drop(done).tolist())
    text.click("#tab-orders")
    text.wait_for_selector(".station[data-station='0'] .order")
    pods = {(row[0], row[1]) for row in brought(events, TIME_S)}
    for station, count in open_at.items():
        part = text.locator(f".station[data-station='{station}']")
        under_way = sum(where == station for where, _ in pods)
        words = f"{count} of 12 orders, {under_way} pods under way"
        assert words in part.locator("summary").text_content()
        assert part.locator(".order").count() == count
    order = int(assigned.drop(done).index[0])
    lines = past[(past["kind"] == "order-line") & (past["order"] == order)]
    tiles = text.locator(f".order[data-order='{order}'] .tile")
    assert tiles.count() == len(lines)
    due = text.locator(f".order[data-order='{order}'] .due")
    assert "due" in due.text_content()
    text.select_option("#choose-grouping", "pod")
    text.wait_for_selector(".order[data-pod]")
    shown = text.locator(".board .order[data-pod]").evaluate_all(
        "rows => rows.map(row => [Number(row.closest('.station').dataset.station),"
        " Number(row.dataset.pod)])"
    )
    assert {tuple(pair) for pair in shown} == pods


def test_a_click_on_an_order_marks_its_pods_and_robots(text: Any, runs: list[RunFolder]) -> None:
    _, pod, order, _, _ = min(brought(runs[0].events, TIME_S))
    text.click("#tab-orders")
    text.click(f".order[data-order='{order}'] > button")
    assert state(text, "selection") == {"run": 0, "what": "order", "index": order}
    text.wait_for_selector(f".chosen h2:text-is('order {order}')")
    rings = text.evaluate(
        "window.rmfs.panes[0].rings.group.children.filter(ring => ring.visible).length"
    )
    assert rings >= 3  # the station, a pod and its robot
    text.click(f".chosen [data-chooses='0.pod.{pod}']")
    text.wait_for_selector(f".chosen h2:text-is('pod {pod}')")
    assert f"#{order}" in text.text_content(".chosen")
    link = text.evaluate("window.rmfs.link()")
    assert f"chosen=0.pod.{pod}" in link and "board=orders" in link


@pytest.mark.parametrize(
    ("typed", "time_s"),
    [("0:05:30", 330), ("5:30", 330), ("0:05", 300), ("77", 77), ("9:99:99", 660), ("soon", 300)],
)
def test_a_typed_time_is_gone_to(text: Any, typed: str, time_s: float) -> None:
    text.keyboard.press("g")
    text.fill("#time", typed)
    text.keyboard.press("Enter")
    assert state(text, "time_s") == time_s


def test_an_older_run_is_shown_with_what_it_tells(
    page: Any, runs: list[RunFolder], tmp_path: Path
) -> None:
    folder = runs[0].save(tmp_path / "old").path
    events = pd.read_parquet(folder / "events.parquet")
    new = ("order-line", "order-due", "units-bound", "units-unbound")
    kept = events[~events["kind"].isin(new)]
    from rmfs.measure.trace import _write

    _write(folder / "events.parquet", kept)
    export([load_run(folder)], tmp_path / "old.html")
    show(page, (tmp_path / "old.html").as_uri())
    page.evaluate(f"window.rmfs.store.set({{ time_s: {TIME_S}, board: 'orders', playing: false }})")
    page.wait_for_selector(".board .order")
    assert "recorded before" in page.text_content(".board")


def test_letters_are_tiles_in_their_colours(page: Any, tmp_path: Path) -> None:
    short = {"scenario.warmup_s": 0, "scenario.duration_s": 600, "layout.robots": 8}
    run = rmfs.simulate("small", "letters", "default", seed=1, set=short, trace=True)
    write_run(run, tmp_path / "run", trace=True)
    export([load_run(tmp_path / "run")], tmp_path / "letters.html")
    show(page, (tmp_path / "letters.html").as_uri())
    page.evaluate("window.rmfs.store.set({ time_s: 590, board: 'orders', playing: false })")
    page.wait_for_selector(".board .tile")
    told = page.locator(".board .tile").evaluate_all(
        "tiles => tiles.map(one => [one.firstChild.data, one.style.backgroundColor, one.title])"
    )
    for letter, colour, title in told:
        assert title.split(": ")[1] == f"{letter.lower()} {colour}", json.dumps(told)
    assert len({colour for _, colour, _ in told}) == 3

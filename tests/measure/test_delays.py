"""Where the time of orders goes; that it adds up is checked in every run (`check_delays`)."""

from __future__ import annotations

from typing import Any

import numpy as np
import pandas as pd
import pytest
from ledger import check_delays
from matplotlib.figure import Figure

import rmfs
from rmfs.measure.events import Happening
from rmfs.measure.plots.delays import BINS, LABELS, delays
from rmfs.measure.recorder import TASKS
from rmfs.measure.tables.delays import PARTS, by_order

SCENARIOS: dict[str, tuple[str, str, str, dict[str, Any]]] = {
    "backlog": ("small", "small", "default", {}),
    "arrivals": ("small", "small-arrivals", "default", {}),
    "warm-up": ("small", "small", "default", {"scenario.warmup_s": 400}),
    "queued": ("small", "small", "default", {"controllers.poa": "queue"}),
    "crowded": ("default", "default", "default", {"layout.robots": 48, "scenario.warmup_s": 0}),
    "two tiers": ("study-tiers", "pp-minimal", "default", {"scenario.warmup_s": 0}),
}


@pytest.fixture(scope="module", params=SCENARIOS)
def run(request: pytest.FixtureRequest) -> Any:
    layout, scenario, controllers, given = SCENARIOS[request.param]
    keys = {"scenario.duration_s": 800, **given}
    return rmfs.simulate(layout, scenario, controllers, seed=3, set=keys)


def test_the_parts_add_up(run: Any) -> None:
    check_delays(run)
    assert len(run.table("delays")) > 10
    shares = [run.footprint[f"{part}_share"] for part in PARTS]
    assert sum(shares) == pytest.approx(1.0, abs=1e-12)
    mean_s = by_order(run.table("delays"))["turnover_s"].mean()
    assert mean_s == pytest.approx(run.footprint["order_turnover_mean_s"])


def test_hindered_is_what_the_planner_says(run: Any) -> None:
    """Looked up trip by trip, in another way than the table does it.

    To the planner's delays comes what a robot waits before it sets off, until another one has left
    the pod's place.
    """
    trips, lines = run.table("trips"), run.table("delays")
    picks = run.table("picks").groupby(["order", "sku"])["time_s"].max()
    assigned = run.table("orders").set_index("order")["assigned_s"]
    tasks = run.recorder.tasks.columns()
    planned, told = [], []
    for line in lines.itertuples():
        if (line.order, line.sku) not in picks:
            continue  # before the measured time
        picked_s, assigned_s = picks[line.order, line.sku], assigned[line.order]
        own = trips[(trips["robot"] == line.robot) & (trips["end_s"] <= picked_s)]
        if len(own) < 2 or own.iloc[-2]["start_s"] < assigned_s:
            continue  # the order came later than the robot set off, or the pod was carried before
        to_pod, to_station = own.iloc[-2], own.iloc[-1]
        if (to_pod["kind"], to_station["kind"]) != ("to_pod", "to_station"):
            continue
        if line.drive_free_s == 0:
            continue  # at the station already, when the order came
        ours = (tasks["robot"] == line.robot) & (tasks["kind"] == TASKS.index("pick"))
        begun_s = tasks["begin_s"][ours & (tasks["begin_s"] <= picked_s)].max()
        waited_s = to_pod["start_s"] - max(begun_s, assigned_s)
        planned.append(waited_s + to_pod["hindered_s"] + max(to_station["hindered_s"], 0.0))
        told.append(line.drive_hindered_s)
    more_s = np.array(told) - np.array(planned)
    assert len(more_s) > 5
    assert more_s.min() > -1e-6
    # a way there in two trips, or more: the earlier ones are not looked up here
    assert (more_s < 1e-6).mean() > 0.85
    assert sum(told) <= 1.15 * sum(planned)


def test_the_picture_stacks_the_parts_up_to_the_turnover(run: Any) -> None:
    figure = Figure()
    ax = figure.subplots()
    delays(run.table("delays"), ax)
    assert [bars.get_label() for bars in ax.containers] == [LABELS[part][0] for part in PARTS]
    heights = np.array([[bar.get_height() for bar in bars] for bars in ax.containers])
    bottoms = np.array([[bar.get_y() for bar in bars] for bars in ax.containers])
    np.testing.assert_allclose(bottoms, np.cumsum(heights, axis=0) - heights, atol=1e-9)
    each = run.table("delays").groupby("order")[["completed_s", "turnover_s"]].first()
    edges = np.linspace(each["completed_s"].min(), each["completed_s"].max(), BINS + 1)
    which = np.searchsorted(edges, each["completed_s"], side="right").clip(1, BINS) - 1
    means = each["turnover_s"].groupby(which).mean() / 60.0
    total = heights.sum(axis=0)
    np.testing.assert_allclose(total[means.index], means)
    assert total.sum() == pytest.approx(means.sum())  # no bar where no order was completed


def test_more_robots_hinder_each_other_more() -> None:
    shares = []
    for robots in (8, 64):
        keys = {"layout.robots": robots, "scenario.duration_s": 900, "scenario.warmup_s": 0}
        run = rmfs.simulate("default", "default", seed=1, set=keys)
        total = by_order(run.table("delays")).sum()
        driving = total["drive_free_s"] + total["drive_hindered_s"]
        shares.append(total["drive_hindered_s"] / driving)
    assert shares[0] < shares[1]


def test_a_run_in_which_nothing_was_completed() -> None:
    run = rmfs.simulate("small", "small", seed=1, set={"scenario.duration_s": 5})
    assert not len(run.table("delays"))
    assert np.isnan(run.footprint["queue_share"])
    run.plot("delays")


@pytest.mark.parametrize("duration_s", [120.0, 300.0])
def test_an_order_of_which_a_part_is_open_is_not_complete(duration_s: float) -> None:
    """At the end of the run some split orders have been served at one of their stations only."""
    keys = {
        "layout.robots": 10,
        "scenario.warmup_s": 0,
        "scenario.duration_s": duration_s,
    }
    run = rmfs.simulate("small", "small", "pile-on-split", seed=2, set=keys)
    check_delays(run)
    orders = run.table("orders").set_index("order")
    completed = orders[orders["completed_s"].notna()]
    picked = run.table("picks").groupby("order").size()
    assert len(completed) == run.footprint["orders_completed"]
    assert (picked.loc[completed.index] == completed["units"]).all()


def test_each_line_of_a_split_order_waits_until_it_is_assigned_itself() -> None:
    """Not until another part of the order, or the part that it joins, was: from the events."""
    keys = {
        "scenario.warmup_s": 300,
        "scenario.duration_s": 900,
        "controllers.poa.split_orders": 10**6,
    }
    run = rmfs.simulate("small", "small", "pile-on-split", seed=3, set=keys, trace=True)
    check_delays(run)
    assert run.events is not None
    told = pd.DataFrame(run.events.columns())
    came = told[told["kind"] == Happening.ORDER_ASSIGNED].groupby(["order", "station"])["time_us"]
    own = told[(told["kind"] == Happening.ORDER_LINE) & (told["station"] >= 0)]
    of_part = own.groupby(["order", "sku", "station"])["time_us"].min()
    created = run.table("orders").set_index("order")["created_s"]
    lines = run.table("delays")
    for line in lines.itertuples():
        where = line.order, line.sku, line.station
        # the lines that stay when parts are split off are assigned together
        at_us = of_part[where] if where in of_part else came.max()[line.order, line.station]
        waited_s = at_us / 1e6 - created[line.order]
        assert line.wait_assignment_s == pytest.approx(waited_s, abs=2e-6)
    at = lines["completed_s"] - lines["turnover_s"] + lines["wait_assignment_s"]
    assert (at.groupby(lines["order"]).agg(np.ptp) > 1).sum() >= 5

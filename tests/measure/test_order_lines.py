"""Results of a run on a file of orders join with the file."""

from __future__ import annotations

from pathlib import Path

import pandas as pd
import pytest

import rmfs

SKUS = "sku,popularity\n" + "".join(f"S-{k},{k + 1}\n" for k in range(20))


@pytest.fixture(scope="module")
def run(tmp_path_factory: pytest.TempPathFactory):
    folder = tmp_path_factory.mktemp("own")
    (folder / "skus.csv").write_text(SKUS)
    rows = [
        f"2026-03-01T08:{k // 2:02d}:00,A{k},S-{sku},{1 + k % 2},c{k % 3}"
        for k in range(24)
        for sku in (k % 20, (k + 7) % 20)
    ]
    (folder / "orders.csv").write_text("\n".join(["time,order,sku,quantity,customer", *rows, ""]))
    (folder / "own.toml").write_text(
        """format = "rmfs-scenario/1"
duration_s = 1200
warmup_s = 0
start = 2026-03-01T08:00:00
[skus]
file = "skus.csv"
[demand]
mode = "stream"
file = "orders.csv"
"""
    )
    done = rmfs.simulate("small", folder / "own.toml", "default", seed=1)
    return folder, done


def test_the_table_of_lines_is_the_file_with_what_became_of_it(run):
    folder, done = run
    lines, given = done.table("order_lines"), pd.read_csv(folder / "orders.csv")
    assert len(lines) == len(given) == 48
    joined = given.assign(file_line=range(2, 50)).merge(lines, on="file_line")
    assert (joined["order_x"] == joined["file_order"]).all()
    assert (joined["sku_x"] == joined["file_sku"]).all()
    assert (joined["quantity"] == joined["units"]).all()
    assert (joined["customer"] == joined["file_customer"]).all()
    ends_s = pd.Series(done.recorder.lines.columns()["end_s"])
    assert lines["picked_s"].notna().sum() == (ends_s <= 1200.0).sum() > 10


def test_a_line_that_is_being_picked_at_the_end_is_not_picked_yet(run):
    folder, done = run
    log = done.recorder.lines.columns()
    begins_s, ends_s = log["time_s"][9], log["end_s"][9]
    end_s = (begins_s + ends_s) / 2
    short = rmfs.simulate(
        "small", folder / "own.toml", "default", seed=1, set={"scenario.duration_s": end_s}
    )
    assert short.recorder.lines.columns()["end_s"][9] == ends_s > end_s
    lines = short.table("order_lines")
    assert lines["picked_s"].max() <= end_s
    own = (lines["order"] == log["order"][9]) & (lines["sku"] == log["sku"][9])
    assert own.sum() == 1
    assert lines.loc[own, "picked_s"].isna().all()


def test_lines_agree_with_the_tables_of_orders_and_skus(run):
    _, done = run
    lines, orders, skus = (done.table(name) for name in ("order_lines", "orders", "skus"))
    named = lines.merge(orders[["order", "name", "completed_s"]], on="order")
    assert (named["file_order"] == named["name"]).all()
    assert (skus["name"].to_numpy()[lines["sku"]] == lines["file_sku"]).all()
    last = named.groupby("order").agg({"picked_s": "max", "completed_s": "first"})
    done_orders = last["completed_s"].notna()
    assert done_orders.any()
    assert last["picked_s"][done_orders].equals(last["completed_s"][done_orders].rename("picked_s"))


def test_the_table_survives_a_folder_and_a_fork(run, tmp_path: Path):
    folder, done = run
    saved = done.save(tmp_path / "run")
    pd.testing.assert_frame_equal(saved.table("order_lines"), done.table("order_lines"))
    simulation = rmfs.Simulation("small", folder / "own.toml", "default", seed=1)
    simulation.run_until(300.0)
    twin = simulation.fork()
    assert twin.arrivals.order_stream is simulation.arrivals.order_stream
    twin.run_until(1200.0)
    forked = twin.result().table("order_lines")
    pd.testing.assert_frame_equal(forked, done.table("order_lines"))


def test_orders_that_are_drawn_have_no_lines_in_a_file():
    drawn = rmfs.simulate("small", "small", "default", seed=1, set={"scenario.duration_s": 300})
    assert drawn.table("order_lines").empty
    assert set(drawn.table("orders")["name"]) == {""}
    assert drawn.table("skus")["name"].tolist()[:3] == ["0", "1", "2"]

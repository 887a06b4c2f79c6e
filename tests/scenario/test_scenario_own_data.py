"""Orders and bundles as users have them: dates, names of SKUs, columns of their own."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from scenario_tools import DAY_US, SITE, FakeState, drive, scenario

from rmfs.errors import InputError
from rmfs.scenario import SkuSet, load, order_intake
from rmfs.scenario.sources import bundle_stream, order_stream, time_zero
from rmfs.scenario.streams import digest, read_orders
from rmfs.scenario.toml import to_toml

HEAD = "time,order,sku,quantity,due\n"
DATED = HEAD + (
    "2026-03-01T08:00:00,A,0,1,2026-03-01T09:00\n"
    "2026-03-01T08:00:00,A,3,2,2026-03-01T09:00\n"
    "2026-03-01 08:00:12.5,B,1,1,\n"
)


def written(folder: Path, text: str, name: str = "orders.csv") -> Path:
    path = folder / name
    path.write_text(text)
    return path


def on_file(path: Path, **more: object) -> dict[str, object]:
    return {"mode": "stream", "file": str(path), **more}


def test_dates_count_from_the_midnight_before_the_first_row(tmp_path: Path, few_skus: SkuSet):
    orders = read_orders(written(tmp_path, DATED), few_skus)
    assert orders.time_us.tolist() == [28_800_000_000, 28_812_500_000]
    assert orders.due_us.tolist() == [32_400_000_000, -1]
    seconds = HEAD + "28800,A,0,1,32400\n28800,A,3,2,32400\n28812.5,B,1,1,\n"
    same = read_orders(written(tmp_path, seconds, "seconds.csv"), few_skus)
    assert digest(orders, few_skus) == digest(same, few_skus)


def test_a_zone_counts_over_a_change_of_the_clock(tmp_path: Path, few_skus: SkuSet):
    """In Berlin the clock went from 2 to 3 on 29 March 2026."""
    text = HEAD + "2026-03-29T01:30:00+01:00,A,0,1,\n2026-03-29T03:30:00+02:00,B,0,1,\n"
    orders = read_orders(written(tmp_path, text), few_skus)
    assert orders.time_us.tolist() == [5_400_000_000, 9_000_000_000]


def test_dates_in_parquet(tmp_path: Path, few_skus: SkuSet):
    table = pd.read_csv(written(tmp_path, DATED))
    table["time"] = pd.to_datetime(table["time"], format="ISO8601")
    table.to_parquet(tmp_path / "orders.parquet")
    found = read_orders(tmp_path / "orders.parquet", few_skus)
    assert found.time_us.tolist() == [28_800_000_000, 28_812_500_000]


@pytest.mark.parametrize(
    "start", ["2026-03-01T08:00:00", "2026-03-01 08:00", "2026-03-01T08:00:00.000000"]
)
def test_the_start_of_a_scenario_is_time_zero(tmp_path: Path, few_skus: SkuSet, start: str):
    given = scenario(start=start, demand=on_file(written(tmp_path, DATED)))
    assert given.time_of_day_s == 28_800
    come = drive(order_intake(given, few_skus, SITE, 1), FakeState(5), DAY_US)
    assert [order.time_us for order in come] == [0, 12_500_000]
    assert [order.in_file for order in come] == [0, 1]


def test_a_start_is_a_date_of_toml_too_and_survives_being_written(tmp_path: Path):
    text = 'format = "rmfs-scenario/1"\nduration_s = 60\nstart = 2026-03-01T08:30:00\n'
    given = load(written(tmp_path, text, "s.toml"))
    assert (given.start, given.time_of_day_s) == ("2026-03-01T08:30:00", 30_600)
    again = load(written(tmp_path, to_toml(given), "again.toml"))
    assert (again.start, again.time_of_day_s) == (given.start, given.time_of_day_s)
    only_day = load(tmp_path / "s.toml", [(["start"], "2026-03-01")])
    assert (only_day.start, only_day.time_of_day_s) == ("2026-03-01T00:00:00", 0)


@pytest.mark.parametrize(
    ("tables", "problem"),
    [
        ({"start": "yesterday"}, "start: must be a time such as 2026-03-01T08:00:00"),
        (
            {"start": "2026-03-01T08:00:00", "time_of_day_s": 60.0},
            "time_of_day_s must be 28800 to match start, or be left out",
        ),
    ],
)
def test_a_wrong_start(tables: dict[str, object], problem: str):
    with pytest.raises(InputError, match=problem):
        scenario(**tables)


def test_orders_and_bundles_have_one_time_zero(tmp_path: Path, few_skus: SkuSet):
    """The day is that of the first row of both, the time of day that of the scenario."""
    orders = written(tmp_path, DATED)
    text = "time,sku,quantity,supplier\n2026-02-28T22:00:00,2,3,x\n2026-03-01T00:00:00,2,3,y\n"
    bundles = written(tmp_path, text, "bundles.csv")
    given = scenario(
        duration_s=86400.0,
        time_of_day_s=72000.0,
        demand=on_file(orders),
        replenishment=on_file(bundles),
    )
    zero = time_zero(given)
    assert zero is not None and zero.isoformat() == "2026-02-28T20:00:00"
    assert bundle_stream(given, few_skus, 100.0).time_us.tolist() == [7_200_000_000, 14_400_000_000]
    assert order_stream(given, few_skus).time_us[0] == 12 * 3600 * 10**6
    bundles.write_text("time,sku,quantity\n2026-03-01T00:00:00Z,2,3\n")
    with pytest.raises(InputError, match="of both files or of neither must have"):
        time_zero(given)


def test_a_run_that_ends_before_the_first_order_is_refused(tmp_path: Path, few_skus: SkuSet):
    given = scenario(demand=on_file(written(tmp_path, DATED)))
    told = (
        r"orders.csv: the first order arrives at 2026-03-01T08:00:00, but the run lasts from "
        r"2026-03-01T00:00:00 to 2026-03-01T01:00:00; set scenario.start"
    )
    with pytest.raises(InputError, match=told):
        order_stream(given, few_skus)


WRONG = {
    "2026-13-01,A,0,1,\n": "line 2: time must be a number of s, or a time such as "
    "2026-03-01T08:00:00 (given: '2026-13-01')",
    "2026-03-01T08:00,A,0,1,\n5,B,0,1,\n": "line 3: time must be a time such as "
    "2026-03-01T08:00:00, as in earlier lines (given: '5')",
    "5,A,0,1,\n2026-03-01T08:00,B,0,1,\n": "line 3: time must be a number of s, as in earlier",
    "2026-03-01T08:00,A,0,1,90\n": "line 2: due must be a time such as",
    "2026-03-01T08:00Z,A,0,1,\n2026-03-01T09:00,B,0,1,\n": "line 3: time must have a time zone, as "
    "2026-03-01T00:00:00+00:00 has (given: 2026-03-01T09:00)",
    "2026-03-02T08:00,A,0,1,\n2026-03-01T09:00,B,0,1,\n": "line 3: time must be from "
    "2026-03-02T00:00:00, which is time zero (scenario.start), to 1e+09 s later (given",
}


@pytest.mark.parametrize(("rows", "problem"), WRONG.items())
def test_wrong_dates(tmp_path: Path, few_skus: SkuSet, rows: str, problem: str):
    path = written(tmp_path, HEAD + rows)
    with pytest.raises(InputError) as caught:
        read_orders(path, few_skus)
    assert str(caught.value).startswith(f"{path}: {problem}")


def test_columns_of_the_user_are_kept(tmp_path: Path, few_skus: SkuSet):
    text = (
        ",customer,time,order,sku,quantity,order_id\n"
        "0,Ann,0,A,0,1,x1\n1,Ann,0,A,3,2,x2\n2,Bob,5,B,1,1,x3\n"
    )
    orders = read_orders(written(tmp_path, text), few_skus)
    assert orders.file is not None
    assert orders.file.names == ("A", "B")
    assert orders.file.line.tolist() == [2, 3, 4]
    kept = {
        name: np.array(texts)[codes].tolist()
        for name, (codes, texts) in orders.file.columns.items()
    }
    assert kept == {"customer": ["Ann", "Ann", "Bob"], "order_id": ["x1", "x2", "x3"]}
    without = "time,order,sku,quantity\n0,A,0,1\n0,A,3,2\n5,B,1,1\n"
    plain = read_orders(written(tmp_path, without, "plain.csv"), few_skus)
    assert digest(plain, few_skus) == digest(orders, few_skus)


def test_a_slip_in_the_name_of_a_column_is_no_column_of_the_user(tmp_path: Path, few_skus: SkuSet):
    path = written(tmp_path, "time,order_id,sku,quantity\n0,A,0,1\n")
    with pytest.raises(
        InputError, match=r"line 1: unknown column .order_id.; did you mean order\?"
    ):
        read_orders(path, few_skus)


def test_an_unknown_sku_is_told_with_those_that_are_meant(tmp_path: Path):
    ids = np.arange(3)
    names = ("SHOE-41", "SHOE-42", "HAT-RED")
    skus = SkuSet(ids, np.ones(3), np.ones(3), np.ones(3, np.int64), names=names)
    path = written(tmp_path, "time,order,sku,quantity\n0,A,SHOE-43,1\n")
    with pytest.raises(InputError, match=r"line 2: sku SHOE-43 is unknown; valid: SHOE-4") as told:
        read_orders(path, skus)
    assert str(told.value).endswith("SHOE-41, ... (3 SKUs)")

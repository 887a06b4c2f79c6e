"""Orders and bundles in files: round trips, digests, and files that are wrong or hostile."""

from __future__ import annotations

import csv
import hashlib
import resource
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from scenario_tools import DAY_US, SITE, FakeState, drive, scenario

from rmfs.errors import InputError
from rmfs.scenario import (
    Site,
    SkuSet,
    bundle_intake,
    export_stream,
    load,
    order_intake,
    sku_set,
    write_stream,
)
from rmfs.scenario.streams import digest, read_bundles, read_orders
from rmfs.scenario.streams.csv_file import _fields
from rmfs.scenario.streams.stream import BundleStreamBuilder, OrderStreamBuilder

ORDERS = """time,order,sku,quantity,due
0,A,0,1,1800
0,A,3,2,1800
12.5,B,1,1,
12.5,C,0,3,7212.5
"""


def written(folder: Path, text: str | bytes, name: str = "orders.csv") -> Path:
    path = folder / name
    path.write_bytes(text if isinstance(text, bytes) else text.encode())
    return path


def test_orders_by_hand(tmp_path: Path, few_skus: SkuSet):
    orders = read_orders(written(tmp_path, ORDERS), few_skus)
    assert orders.time_us.tolist() == [0, 12_500_000, 12_500_000]
    assert orders.due_us.tolist() == [1_800_000_000, -1, 7_212_500_000]
    assert [orders.lines(k) for k in range(3)] == [((0, 3), (1, 2)), ((1,), (1,)), ((0,), (3,))]


@pytest.mark.parametrize(
    "text",
    [
        ORDERS.replace("\n", "\r\n"),
        "\ufeff" + ORDERS,
        ORDERS.replace(",", " , "),
        ORDERS.rstrip("\n"),
        ORDERS.replace("0,A", "\n0,A"),
        ORDERS.replace("0,A", '0.0,"A"').replace("12.5", "1.25e1").replace(",1,1,", ",1.0,+1,"),
    ],
)
def test_ways_to_write_the_same(tmp_path: Path, few_skus: SkuSet, text: str):
    stream = read_orders(written(tmp_path, text), few_skus)
    known = read_orders(written(tmp_path, ORDERS, "known.csv"), few_skus)
    assert digest(stream, few_skus) == digest(known, few_skus)


@pytest.mark.parametrize(
    "line",
    ["1,2,,x", " 1 ,\t2, ", "", " ", ",", "ä,'b',c;d", '1,"a, b",2', '"a""b",1', '1,a"b,2'],
)
def test_lines_with_and_without_quotes_are_read_as_csv(line: str):
    expected = [field.strip() for field in next(csv.reader([line], strict=True), [])]
    for end in ("\n", "\r\n", ""):
        assert _fields((line + end).encode(), 2) == expected


def test_a_line_break_within_a_line_is_refused():
    with pytest.raises(csv.Error, match="new-line character"):
        _fields(b"1,a\rb,2\n", 2)


def test_columns_in_any_order_and_without_due(tmp_path: Path, few_skus: SkuSet):
    text = "quantity,sku,time,order\n1,2,0,x\n"
    orders = read_orders(written(tmp_path, text), few_skus)
    assert (orders.lines(0), orders.due_us.tolist()) == (((2,), (1,)), [-1])


def test_skus_are_named_by_their_ids(tmp_path: Path):
    skus = SkuSet(np.array([70, 7]), np.ones(2), np.ones(2), np.ones(2, np.int64))
    orders = read_orders(written(tmp_path, "time,order,sku,quantity\n0,1,7,1\n"), skus)
    assert orders.sku.tolist() == [1]
    assert write_stream(orders, skus, tmp_path / "again.csv") == digest(orders, skus)
    assert (tmp_path / "again.csv").read_text().splitlines()[1] == "0.000000,0,7,1,"


@pytest.mark.parametrize("suffix", [".csv", ".parquet"])
def test_skus_with_numbers_as_names_survive_a_file(tmp_path: Path, suffix: str):
    """The file holds ids, unless an id is the name of another SKU."""
    ones = np.ones(5)
    names = ("2", "1", 'A,"x"', "30", "B")
    skus = SkuSet(np.arange(5), ones, ones, ones.astype(np.int64), names=names)
    orders, bundles = OrderStreamBuilder(), BundleStreamBuilder()
    for sku in range(5):
        orders.add(sku, -1, [sku], [1])
        bundles.add(sku, sku, 1)
    path = tmp_path / f"stream{suffix}"
    digest_written = write_stream(orders.build(), skus, path)
    read = read_orders(path, skus)
    assert read.sku.tolist() == [0, 1, 2, 3, 4]
    assert digest(read, skus) == digest_written
    write_stream(bundles.build(), skus, path)
    assert read_bundles(path, skus).sku.tolist() == [0, 1, 2, 3, 4]


@pytest.mark.parametrize("suffix", [".csv", ".parquet"])
def test_orders_and_bundles_survive_a_file(tmp_path: Path, skus: SkuSet, suffix: str):
    given = scenario(demand={"mode": "poisson"}, replenishment={"mode": "poisson"})
    orders = export_stream(given, "orders", tmp_path / f"orders{suffix}", SITE, seed=3)
    bundles = export_stream(given, "bundles", tmp_path / f"bundles{suffix}", SITE, seed=3)
    replayed = scenario(
        demand={"mode": "stream", "file": str(orders.path), "digest": orders.digest},
        replenishment={"mode": "stream", "file": str(bundles.path), "digest": bundles.digest},
    )
    for intake_of, number in ((order_intake, orders.number), (bundle_intake, bundles.number)):
        generated = drive(intake_of(given, skus, SITE, 3), FakeState(), DAY_US)
        again = drive(intake_of(replayed, skus, SITE, 99), FakeState(), DAY_US)
        # what comes from a file also tells its place there
        assert [thing._replace(in_file=-1) for thing in again] == generated
        assert [thing.in_file for thing in again] == list(range(len(again)))
        assert len(again) == number > 50


def test_the_digest_is_that_of_the_csv_file_whatever_the_file(tmp_path: Path, skus: SkuSet):
    given = scenario(demand={"mode": "poisson"})
    as_csv = export_stream(given, "orders", tmp_path / "a.csv", SITE)
    as_parquet = export_stream(given, "orders", tmp_path / "a.parquet", SITE)
    assert as_csv.digest == as_parquet.digest
    assert as_csv.digest == hashlib.sha256(as_csv.path.read_bytes()).hexdigest()
    assert export_stream(given, "orders", tmp_path / "b.csv", SITE, seed=1).digest != as_csv.digest
    assert as_csv.digest == EXPORTED


EXPORTED = "2d30ca5d666aa3f8735e15fe5e718d70fce93aa9dc2289be74ef83b100eb65ea"


def test_another_file_than_the_published_one_is_refused(tmp_path: Path, few_skus: SkuSet):
    path = written(tmp_path, ORDERS)
    given = scenario(demand={"mode": "stream", "file": str(path), "digest": "0" * 64})
    with pytest.raises(InputError, match=r"the digest of the file is [0-9a-f]{64}, not 0000"):
        order_intake(given, few_skus, SITE, 1)


@pytest.mark.parametrize(
    "tables",
    [
        {"demand": {"mode": "backlog"}},
        {"demand": {"mode": "poisson", "tied_to": "pick-stations"}},
        {"demand": {"mode": "poisson", "batches": {"fill_to": [[60, 3]]}}},
    ],
)
def test_what_depends_on_the_run_cannot_be_exported(tmp_path: Path, tables):
    with pytest.raises(InputError, match="test: demand: orders that depend on what happens in a"):
        export_stream(scenario(**tables), "orders", tmp_path / "a.csv", SITE)
    with pytest.raises(InputError, match="test: replenishment: bundles that depend"):
        export_stream(scenario(), "bundles", tmp_path / "a.csv", SITE)
    assert list(tmp_path.iterdir()) == []


def test_batches_that_add_are_exported_too(tmp_path: Path):
    batches = {"cycle_s": 600, "add": [[300, 2]]}
    given = scenario(demand={"mode": "poisson", "batches": batches})
    exported = export_stream(given, "orders", tmp_path / "a.csv", SITE)
    times = pd.read_csv(exported.path)["time"]
    assert (times == 300.0).sum() >= 8


def test_an_export_is_a_plain_table(tmp_path: Path):
    given = scenario(demand={"mode": "poisson"})
    paths = [tmp_path / "a.csv", tmp_path / "a.parquet"]
    for path in paths:
        export_stream(given, "orders", path, SITE)
    csv, parquet = pd.read_csv(paths[0]), pd.read_parquet(paths[1])
    pd.testing.assert_frame_equal(csv, parquet)
    assert csv.columns.tolist() == ["time", "order", "sku", "quantity", "due"]
    assert csv["time"].is_monotonic_increasing
    with pytest.raises(InputError, match=r"must end in .csv or .parquet"):
        export_stream(given, "orders", tmp_path / "a.xlsx", SITE)


def test_a_table_by_pandas(tmp_path: Path, few_skus: SkuSet):
    """Parquet as somebody else writes it: names as text, whole numbers as floats, gaps."""
    table = pd.DataFrame(
        {
            "order": ["a", "a", "b"],
            "sku": [0.0, 1.0, 2.0],
            "time": [0, 0, 5],
            "quantity": np.array([1, 2, 3], np.int16),
            "due": [60.0, 60.0, None],
        }
    )
    table.to_parquet(tmp_path / "a.parquet")
    table.to_csv(tmp_path / "a.csv", index=False)
    orders = read_orders(tmp_path / "a.parquet", few_skus)
    assert digest(orders, few_skus) == digest(read_orders(tmp_path / "a.csv", few_skus), few_skus)
    table.loc[1, "quantity"] = -1
    table["sku"] = [0, 9, 2]
    table.to_parquet(tmp_path / "a.parquet")
    with pytest.raises(
        InputError, match=r"a.parquet: row 2: sku 9 is unknown; valid: 0, 1, 2, ... \(5 SKUs\)$"
    ):
        read_orders(tmp_path / "a.parquet", few_skus)


def test_due_times_that_are_not_given_are_drawn(tmp_path: Path, few_skus: SkuSet):
    lines = "".join(f"{k},{k},0,1,\n" for k in range(2000))
    path = written(tmp_path, "time,order,sku,quantity,due\n" + lines)
    given = scenario(demand={"mode": "stream", "file": str(path)})
    come = drive(order_intake(given, few_skus, SITE, 1), FakeState(5), DAY_US)
    offsets = [(order.due_us - order.time_us) / 1e6 for order in come]
    assert set(offsets) == {1800.0, 7200.0}
    assert offsets.count(1800.0) == pytest.approx(400, abs=60)
    other = drive(order_intake(given, few_skus, SITE, 2), FakeState(5), DAY_US)
    assert [order.due_us for order in other] != [order.due_us for order in come]


def test_what_a_file_gives_for_a_down_period_comes_when_it_ends(tmp_path: Path, few_skus: SkuSet):
    path = written(tmp_path, ORDERS)
    down = {"cycle_s": 100, "periods_s": [[10, 20]]}
    given = scenario(demand={"mode": "stream", "file": str(path), "down": down})
    come = drive(order_intake(given, few_skus, SITE, 1), FakeState(5), DAY_US)
    assert [order.time_us // 10**6 for order in come] == [0, 20, 20]
    assert come[2].due_s == 7212.5


# --- wrong files --------------------------------------------------------------------------------

HEAD = "time,order,sku,quantity,due\n"
WRONG = {
    "": "empty; line 1 must hold the names of the columns",
    "time,order,sku\n": "line 1: column quantity is missing; valid: time, order, "
    "sku, quantity, due, separated by commas, and columns of your own (given: time, order, sku)",
    "time,order,sku,quantity,dew\n": "line 1: unknown column 'dew'; did you mean due?",
    "time;order;sku;quantity\n": "line 1: column time is missing; valid: time, order, sku, ",
    "time,time,order,sku,quantity\n": "line 1: column time occurs twice",
    HEAD + "0,A,0,1\n": "line 2: 4 fields, expected 5",
    HEAD + "0,A,0,-2,\n": "line 2: quantity must be from 1 to 1000000 (given: -2)",
    HEAD + "0,A,0,0,\n": "line 2: quantity must be from 1 to 1000000 (given: 0)",
    HEAD + "0,A,0,1.5,\n": "line 2: quantity must be a whole number (given: 1.5)",
    HEAD + "0,A,0,many,\n": "line 2: quantity must be a number (given: 'many')",
    HEAD + "0,A,0,,\n": "line 2: quantity must be a number (empty)",
    HEAD + "0,A,0,1_0,\n": "line 2: quantity must be a number (given: '1_0')",
    HEAD + "0,A,7,1,\n": "line 2: sku 7 is unknown; valid: 0, 1, 2, ... (5 SKUs)",
    HEAD + "0,A,x,1,\n": "line 2: sku must be a number (given: 'x')",
    HEAD + "-1,A,0,1,\n": "line 2: time must be from 0 to 1e+09 s (given: -1)",
    HEAD + "nan,A,0,1,\n": "line 2: time must be a number (given: 'nan')",
    HEAD + "inf,A,0,1,\n": "line 2: time must be a number (given: 'inf')",
    HEAD + "1e99,A,0,1,\n": "line 2: time must be from 0",
    HEAD + "5,A,0,1,\n3,B,0,1,\n": "line 3: time 3 is earlier than that of the previous order",
    HEAD + "5,A,0,1,4\n": "line 2: due is earlier than time",
    HEAD + "5,A,0,1,\n6,A,1,1,\n": "line 3: time differs from that of the previous line of order A",
    HEAD + "5,A,0,1,9\n5,A,1,1,\n": "line 3: due differs from that of the previous line of order A",
    HEAD + "5,A,0,1,\n5,A,0,1,\n": "line 3: sku 0 occurs twice in order A",
    HEAD + "5,,0,1,\n": "line 2: order is empty",
    HEAD + f"5,{'A' * 201},0,1,\n": "line 2: order is longer than 200 characters",
    HEAD + "5,A,0,1,\n5,B,0,1,\n5,A,1,1,\n": "line 4: order occurs again after another order",
    HEAD + '5,"A,0,1,\n': "line 2: unexpected end of data",
    HEAD + "5,A\0,0,1,\n": "line 2: is not text: contains a zero byte",
    HEAD + "5,A,0,1,\n" + "x" * 5000: "line 3: longer than 4096 bytes",
}


@pytest.mark.parametrize(("text", "problem"), WRONG.items())
def test_a_wrong_line_is_named_with_column_and_reason(
    tmp_path: Path, few_skus: SkuSet, text: str, problem: str
):
    path = written(tmp_path, text)
    with pytest.raises(InputError) as caught:
        read_orders(path, few_skus)
    message = str(caught.value)
    assert message.startswith(f"{path}: {problem}")
    assert "\n" not in message


def test_all_wrong_lines_are_counted_and_ten_are_shown(tmp_path: Path, few_skus: SkuSet):
    path = written(tmp_path, HEAD + "0,A,0,0,\n" * 5000)
    with pytest.raises(InputError) as caught:
        read_orders(path, few_skus)
    message = str(caught.value)
    assert message.count("quantity must be") == 10
    assert message.endswith("; and 4990 more")


BUNDLES_WRONG = {
    "time,sku\n": "line 1: column quantity is missing",
    "time,sku,quantity\n5,0,1\n4,0,1\n": "line 3: time 4 is earlier than that of the previous "
    "bundle",
    "time,sku,quantity,due\n5,0,1,9\n": "line 2: due must be empty: bundles have no due time",
    "time,sku,quantity\n5,4,21\n": "line 2: quantity 21 takes 105 space units, but no pod holds "
    "more than 100",
}


@pytest.mark.parametrize(("text", "problem"), BUNDLES_WRONG.items())
def test_wrong_bundles(tmp_path: Path, few_skus: SkuSet, text: str, problem: str):
    path = written(tmp_path, text)
    with pytest.raises(InputError) as caught:
        read_bundles(path, few_skus, largest=100.0)
    assert str(caught.value).startswith(f"{path}: {problem}")


def test_bundles_by_hand(tmp_path: Path, few_skus: SkuSet):
    path = written(tmp_path, "time,order,sku,quantity\n1,x,2,3\n1,x,2,3\n2,,4,1\n")
    bundles = read_bundles(path, few_skus)
    assert bundles.time_us.tolist() == [1_000_000, 1_000_000, 2_000_000]
    given = scenario(replenishment={"mode": "stream", "file": str(path)})
    come = drive(bundle_intake(given, few_skus, SITE, 1), FakeState(5), DAY_US)
    assert [(b.sku, b.units, b.space) for b in come] == [(2, 3, 9.0), (2, 3, 9.0), (4, 1, 5.0)]
    with pytest.raises(InputError, match="no pod holds more than 8"):
        bundle_intake(given, few_skus, Site(1, 1, 100.0, largest_pod=8.0), 1)


NOT_TABLES = {
    "binary": bytes(range(256)) * 40,
    "utf-16": ORDERS.encode("utf-16"),
    "latin": HEAD.encode() + b"5,\xe4,0,1,\n",
    "zeros": bytes(10_000),
}


@pytest.mark.parametrize("content", NOT_TABLES.values(), ids=NOT_TABLES.keys())
@pytest.mark.parametrize("suffix", [".csv", ".parquet"])
def test_what_is_no_table_is_one_error(
    tmp_path: Path, few_skus: SkuSet, content: bytes, suffix: str
):
    path = written(tmp_path, content, f"orders{suffix}")
    with pytest.raises(InputError) as caught:
        read_orders(path, few_skus)
    assert "\n" not in str(caught.value)
    assert len(str(caught.value)) < len(str(path)) + 300


def test_a_line_of_a_gigabyte_takes_no_memory(tmp_path: Path, few_skus: SkuSet):
    path = tmp_path / "orders.csv"
    with path.open("wb") as file:
        file.write(HEAD.encode() + b"0,A,0,1,")
        file.seek(2**30)
        file.write(b"\n")
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    with pytest.raises(InputError, match="line 2: longer than 4096 bytes"):
        read_orders(path, few_skus)
    assert resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before < 20_000


def test_a_truncated_parquet_file(tmp_path: Path, few_skus: SkuSet, skus: SkuSet):
    given = scenario(demand={"mode": "poisson"})
    whole = export_stream(given, "orders", tmp_path / "a.parquet", SITE).path.read_bytes()
    for end in range(0, len(whole), 499):
        path = written(tmp_path, whole[:end], "cut.parquet")
        with pytest.raises(InputError, match=r"cut.parquet: not a complete Parquet file"):
            read_orders(path, few_skus)
    rng = np.random.default_rng(1)
    for _ in range(60):
        broken = bytearray(whole)
        for at in rng.integers(0, len(whole), 3):
            broken[at] ^= 0xFF
        path = written(tmp_path, bytes(broken), "broken.parquet")
        try:
            read_orders(path, skus)
        except InputError as error:
            assert "\n" not in str(error)


def test_no_such_file_and_other_kinds(tmp_path: Path, few_skus: SkuSet):
    for name, problem in (
        ("none.csv", "no such file"),
        ("none.parquet", "no such file"),
        ("orders.xlsx", "must end in .csv or .parquet"),
    ):
        with pytest.raises(InputError, match=problem):
            read_orders(tmp_path / name, few_skus)
    (tmp_path / "folder.csv").mkdir()
    with pytest.raises(InputError, match="cannot be read"):
        read_orders(tmp_path / "folder.csv", few_skus)


def test_too_many_lines(tmp_path: Path, few_skus: SkuSet, monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr("rmfs.scenario.streams.csv_file.MOST_ROWS", 3)
    with pytest.raises(InputError, match=r"line 4: more than 3 lines$"):
        read_orders(written(tmp_path, ORDERS), few_skus)


def test_a_published_stream_is_replayed_under_its_skus(tmp_path: Path):
    """A scenario names a file relative to itself, so that both can be published together."""
    given = scenario(demand={"mode": "poisson"})
    exported = export_stream(given, "orders", tmp_path / "orders.csv", SITE)
    path = written(
        tmp_path,
        'format = "rmfs-scenario/1"\nduration_s = 3600\nwarmup_s = 0\n[demand]\nmode = "stream"\n'
        f'file = "orders.csv"\ndigest = "{exported.digest}"\n',
        "replay.toml",
    )
    replay = load(path)
    intake = order_intake(replay, sku_set(replay.skus), SITE, 5)
    assert len(drive(intake, FakeState(), DAY_US)) == exported.number

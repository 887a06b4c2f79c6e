"""Classes of orders: how they are drawn, read from files, written and refused."""

from __future__ import annotations

import numpy as np
import pytest
from scenario_tools import DAY_US, SIGNIFICANT, SITE, FakeState, drive, scenario
from scipy.stats import chisquare

from rmfs.errors import InputError
from rmfs.scenario import order_intake
from rmfs.scenario.due import ClassesDue
from rmfs.scenario.streams import StreamRecorder, digest, read_orders
from rmfs.scenario.streams.writing import write_stream

CLASSES = [
    {"name": "express", "share": 0.1, "offset_s": 900.0, "weight": 5.0},
    {"name": "prime", "share": 0.3, "offset_s": 3600.0, "weight": 2.0},
    {"name": "ordinary", "share": 0.6, "offset_s": 10800.0},
]
DUE = {"mode": "classes", "classes": CLASSES}
OFFSETS = [900.0, 3600.0, 10800.0]


def test_a_number_stands_for_a_class_and_its_offset():
    due = ClassesDue.model_validate(DUE)
    offset = due.sampler()
    for uniform, number in [(0.0, 0), (0.0999, 0), (0.1, 1), (0.3999, 1), (0.4, 2), (0.9999, 2)]:
        assert due.class_of(uniform) == number
        assert offset(uniform) == OFFSETS[number]


@pytest.mark.parametrize("demand", [{"mode": "poisson"}, {"mode": "backlog", "orders": 2000}])
def test_orders_are_of_classes_by_their_shares(demand, skus):
    given = scenario(86400.0, orders={"due": DUE}, demand=demand)
    come = drive(order_intake(given, skus, SITE, 1), FakeState(), DAY_US)
    found = np.bincount([order.priority for order in come], minlength=3)
    expected = np.array([0.1, 0.3, 0.6]) * len(come)
    assert len(come) > 1000
    assert chisquare(found, expected).pvalue > SIGNIFICANT
    assert all(order.due_us - order.time_us == OFFSETS[order.priority] * 1e6 for order in come)


def test_classes_leave_the_contents_of_orders_as_they_are(skus):
    plain = scenario(3600.0, demand={"mode": "poisson"})
    classes = scenario(3600.0, demand={"mode": "poisson"}, orders={"due": DUE})
    one = drive(order_intake(plain, skus, SITE, 1), FakeState(), 3600 * 10**6)
    other = drive(order_intake(classes, skus, SITE, 1), FakeState(), 3600 * 10**6)
    assert [order[:3] for order in one] == [order[:3] for order in other]
    assert {order.priority for order in one} == {-1}


ROWS = """time,order,sku,quantity,due,priority
10,a,1,1,500,prime
10,a,2,1,500,prime
20,b,1,1,,express
30,c,2,1,,
"""


def of_file(tmp_path, skus, text=ROWS):
    path = tmp_path / "orders.csv"
    path.write_text(text, "utf-8")
    given = scenario(60.0, orders={"due": DUE}, demand={"mode": "stream", "file": str(path)})
    return drive(order_intake(given, skus, SITE, 1), FakeState(), 60 * 10**6)


def test_a_file_says_the_class_and_with_it_the_offset(tmp_path, skus):
    a, b, c = of_file(tmp_path, skus)
    assert (a.priority, a.due_us) == (1, 500 * 10**6)
    assert (b.priority, b.due_us) == (0, 920 * 10**6)
    assert c.due_us == (30 + OFFSETS[c.priority]) * 10**6  # drawn


@pytest.mark.parametrize(
    ("wrong", "told"),
    [
        (
            ("express", "expres"),
            "line 4: priority expres is not a class; valid: express, prime, ord",
        ),
        (
            ("2,1,500,prime", "2,1,500,express"),
            "line 3: priority differs from that of the previous line",
        ),
    ],
)
def test_wrong_classes_in_files_are_refused_in_one_line(tmp_path, skus, wrong, told):
    with pytest.raises(InputError) as refused:
        of_file(tmp_path, skus, ROWS.replace(*wrong))
    assert told in str(refused.value)
    assert "\n" not in str(refused.value)


def test_without_classes_the_column_is_the_users_own(tmp_path, skus):
    path = tmp_path / "orders.csv"
    path.write_text(ROWS, "utf-8")
    stream = read_orders(path, skus)
    assert stream.priority is None
    assert "priority" in stream.file.columns


@pytest.mark.parametrize("ending", ["csv", "parquet"])
def test_orders_written_down_are_read_back_with_their_classes(tmp_path, skus, ending):
    given = scenario(3600.0, orders={"due": DUE}, demand={"mode": "poisson"})
    recorder = StreamRecorder()
    come = drive(order_intake(given, skus, SITE, 1, recorder), FakeState(), 3600 * 10**6)
    path = tmp_path / f"orders.{ending}"
    told = write_stream(recorder.orders.build(), skus, path)
    back = read_orders(path, skus, classes=tuple(one["name"] for one in CLASSES))
    assert back.priority.tolist() == [order.priority for order in come]
    assert digest(back, skus) == told


@pytest.mark.parametrize(
    ("classes", "told"),
    [
        ([], "at least 1"),
        ([{**CLASSES[0], "share": 0.5}], "shares must sum to 1 (their sum is 0.5)"),
        ([{**CLASSES[0], "share": 0.5}] * 2, "name express occurs twice"),
        ([{**CLASSES[0], "share": 1.0, "weight": 0.0}], "weight"),
        ([{**CLASSES[0], "share": 1.0, "name": "a,b"}], "name"),
        ([{**CLASSES[0], "share": 1.0, "offset_s": 0.0}], "offset_s"),
    ],
)
def test_what_cannot_be_is_refused(classes, told):
    with pytest.raises(InputError) as refused:
        scenario(orders={"due": {"mode": "classes", "classes": classes}})
    assert told in str(refused.value)

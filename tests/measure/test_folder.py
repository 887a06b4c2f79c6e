"""Run folders: whole or not at all, and read back."""

from __future__ import annotations

import json

import pandas as pd
import pytest
from fake_run import run

from rmfs.errors import InputError
from rmfs.measure import load_run, write_run
from rmfs.measure.checker import CheckReport
from rmfs.measure.dictionary import TABLES
from rmfs.measure.folder import plain, reserved


@pytest.fixture(scope="module")
def told():
    return run()


@pytest.fixture
def written(told, tmp_path):
    target = tmp_path / "some" / "where"
    write_run(told, target)
    return target


def test_all_files_are_there_and_nothing_else(written):
    expected = {f"{name}.parquet" for name in TABLES} | {"run.json", "footprint.csv"}
    assert {path.name for path in written.iterdir()} == expected
    assert [path.name for path in written.parent.iterdir()] == ["where"]


def test_tables_are_read_back(written):
    run_folder = load_run(written)
    assert run_folder.footprint["orders_completed"] == 1
    for name in TABLES:
        # its orders come from no file, and are done when they are picked; nobody picks them
        empty = name in ("order_lines", "bundle_lines", "parcels", "totes", "pickers")
        assert bool(len(run_folder.table(name))) == (not empty), name


def test_series_and_decisions_are_attributes_as_of_a_run(written):
    run_folder = load_run(written)
    for name in ("series", "decisions"):
        pd.testing.assert_frame_equal(
            getattr(run_folder, name), pd.read_parquet(written / f"{name}.parquet")
        )


def test_csv_and_parquet_agree(written):
    csv = pd.read_csv(written / "footprint.csv", keep_default_na=True)
    parquet = load_run(written).table("footprint")
    for name in csv:
        one, other = csv[name].iloc[0], parquet[name].iloc[0]
        assert (pd.isna(one) and pd.isna(other)) or one == other
    assert "collisions" in csv and pd.isna(csv["collisions"].iloc[0])
    assert b"\r" not in (written / "footprint.csv").read_bytes()


def test_the_run_is_described(written):
    parameters = load_run(written).parameters
    assert parameters["format"] == "rmfs-run/1"
    assert parameters["seed"] == 3
    assert parameters["scenario"]["parameters"] == {"name": "fake"}
    assert parameters["layout"]["name"] == "fake-layout"
    assert len(parameters["layout"]["digest"]) == 64
    assert parameters["packages"]["numpy"]
    assert parameters["check"] is None


def test_trace_and_verdict_on_request(told, tmp_path):
    write_run(told, tmp_path / "run", trace=True, report=CheckReport())
    folder = load_run(tmp_path / "run")
    assert folder.trace["robot"].nunique() == 2
    assert folder.footprint["collisions"] == 0
    assert folder.parameters["check"] == {"findings": 0, "collisions": 0}


def test_without_trace_this_is_said(written):
    with pytest.raises(InputError, match="--trace"):
        _ = load_run(written).trace


def test_a_run_folder_is_replaced(told, written):
    (written / "trace.parquet").write_text("old")
    write_run(told, written)
    assert not (written / "trace.parquet").exists()
    assert [path.name for path in written.parent.iterdir()] == ["where"]


@pytest.mark.parametrize("failure", [RuntimeError, KeyboardInterrupt])
def test_a_failure_in_the_middle_leaves_the_old_run(told, written, monkeypatch, failure):
    before = (written / "run.json").read_bytes()
    calls = []

    def fails(frame, path, **options):
        calls.append(path)
        if len(calls) == 4:
            raise failure
        path.write_bytes(b"half")

    monkeypatch.setattr(pd.DataFrame, "to_parquet", fails)
    with pytest.raises(failure):
        write_run(told, written)
    assert len(calls) == 4
    assert (written / "run.json").read_bytes() == before
    assert [path.name for path in written.parent.iterdir()] == ["where"]


def test_a_failure_leaves_nothing_where_nothing_was(told, tmp_path, monkeypatch):
    monkeypatch.setattr(pd.DataFrame, "to_csv", lambda *a, **k: 1 / 0)
    with pytest.raises(ZeroDivisionError):
        write_run(told, tmp_path / "a" / "b" / "c")
    assert list(tmp_path.iterdir()) == []


def test_a_full_disk_is_one_line(told, tmp_path, monkeypatch):
    def full(*arguments, **options):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(pd.DataFrame, "to_parquet", full)
    with pytest.raises(InputError, match="No space left"):
        write_run(told, tmp_path / "run")
    assert list(tmp_path.iterdir()) == []


def test_old_and_new_run_are_exchanged_at_once(written, monkeypatch):
    """At no moment is there none: the name is never free, and never moved aside."""
    from pathlib import Path

    def never(self, target):
        raise AssertionError("by steps")

    with reserved(written) as folder:
        (folder / "run.json").write_text("{}")
        monkeypatch.setattr(Path, "replace", never)
    assert (written / "run.json").read_text() == "{}"
    assert [path.name for path in written.parent.iterdir()] == ["where"]


def test_what_a_killed_process_has_left_is_removed(written):
    left = written.parent / f".{written.name}.partial-abc"
    left.mkdir()
    other = written.parent / f".{written.name}s.partial-abc"
    other.mkdir()
    with reserved(written) as folder:
        (folder / "run.json").write_text("{}")
    assert not left.exists() and other.exists()


def test_what_killed_processes_have_left_of_other_targets_is_removed(written):
    """Unless its owner is still at work: the folder's lock says so."""
    dead = written.parent / ".dead.partial-a1b2c3_d"
    dead.mkdir()
    (dead / "run.json").write_text("{}")
    with reserved(written.parent / "alive") as alive:
        with reserved(written) as folder:
            (folder / "run.json").write_text("{}")
        assert alive.is_dir()
        (alive / "run.json").write_text("{}")
    assert sorted(path.name for path in written.parent.iterdir()) == ["alive", "where"]


def test_the_old_run_comes_back_if_the_new_one_cannot_take_its_place(written, monkeypatch):
    """Where the system cannot exchange two folders at once."""
    from pathlib import Path

    monkeypatch.setattr("rmfs.files._exchanged", lambda one, other: False)
    replace, calls = Path.replace, []

    def fails_once(self, target):
        calls.append(target)
        if len(calls) == 2:
            raise KeyboardInterrupt
        return replace(self, target)

    with pytest.raises(KeyboardInterrupt), reserved(written) as folder:
        (folder / "run.json").write_text("{}")
        monkeypatch.setattr(Path, "replace", fails_once)
    assert load_run(written).parameters["seed"] == 3
    assert [path.name for path in written.parent.iterdir()] == ["where"]


def test_strangers_are_left_alone(told, tmp_path):
    (tmp_path / "thesis.txt").write_text("precious")
    with pytest.raises(InputError, match="not a run folder"):
        write_run(told, tmp_path)
    with pytest.raises(InputError, match="not a folder"):
        write_run(told, tmp_path / "thesis.txt")
    with pytest.raises(InputError, match="cannot be written"):
        write_run(told, tmp_path / "thesis.txt" / "below")
    assert (tmp_path / "thesis.txt").read_text() == "precious"
    assert len(list(tmp_path.iterdir())) == 1


def test_an_empty_folder_is_used(told, tmp_path):
    write_run(told, tmp_path)
    assert load_run(tmp_path).parameters["seed"] == 3


def test_a_target_is_refused_before_the_work(tmp_path):
    with (
        pytest.raises(InputError, match="cannot be written"),
        reserved(tmp_path / ("long" * 100) / "run"),
    ):
        pytest.fail("too late")


@pytest.mark.parametrize(
    ("content", "text"),
    [
        ("", "corrupted"),
        ('{"format": "rmfs-run/1"', "corrupted"),
        ('{"format": "rmfs-run/7"}', "rmfs-run/7"),
        ("[]", "expected"),
    ],
)
def test_a_corrupted_description_is_named(written, content, text):
    (written / "run.json").write_text(content)
    with pytest.raises(InputError, match=text) as error:
        load_run(written)
    assert "run.json" in str(error.value)


def test_what_is_no_run_folder_is_named(tmp_path):
    with pytest.raises(InputError, match="not a run folder"):
        load_run(tmp_path / "nowhere")


@pytest.mark.parametrize("content", [b"", b"PAR1 and then nothing of use", b"\0" * 5000])
def test_a_corrupted_table_is_named(written, content):
    (written / "orders.parquet").write_bytes(content)
    with pytest.raises(InputError, match=r"orders\.parquet: corrupted") as error:
        load_run(written).table("orders")
    assert "\n" not in str(error.value)


def test_a_truncated_table_is_named(written):
    whole = (written / "orders.parquet").read_bytes()
    (written / "orders.parquet").write_bytes(whole[: len(whole) // 2])
    with pytest.raises(InputError, match="corrupted"):
        load_run(written).table("orders")


def test_missing_tables_and_columns_are_named(written):
    with pytest.raises(InputError, match="valid: footprint"):
        load_run(written).table("orderz")
    (written / "heat.parquet").unlink()
    with pytest.raises(InputError, match="no such file"):
        load_run(written).table("heat")
    load_run(written).table("pods").drop(columns="lifts").to_parquet(written / "pods.parquet")
    with pytest.raises(InputError, match="column lifts missing"):
        load_run(written).table("pods")


def test_description_is_json_without_surprises(written):
    text = (written / "run.json").read_text()
    assert "NaN" not in text
    assert json.loads(text)["machine"]["cores"] >= 1


def test_infinite_numbers_become_words():
    told = plain({"a": [1.5, float("inf")], "b": (float("nan"), "x", None)})
    assert json.dumps(told, allow_nan=False) == '{"a": [1.5, "inf"], "b": ["nan", "x", null]}'

"""The tool that drives many short disturbed runs: it finds what it is for, and goes on."""

from pathlib import Path

import pytest

from rmfs import instances
from tests.tools import disturbed


def test_every_layout_and_mix() -> None:
    assert set(disturbed.SITES) == set(instances.names("layouts"))
    assert len(disturbed.MIXES) == 15


@pytest.mark.parametrize(
    ("layout", "mix", "seed"),
    [
        ("study-32", "late_motions", 0),  # a robot about to start at time zero was taken to stay
        ("small", "closures+breakdowns+slow+late_motions", 1),
        ("demonstrator", "closures", 2),
    ],
)
def test_runs_are_right(layout: str, mix: str, seed: int) -> None:
    row = disturbed.driven(layout, mix, seed)
    assert row["problem"] == ""
    assert row["distance_m"] > 1
    assert all((row[kind] > 0) == (kind in mix.split("+")) for kind in disturbed.WRONG)


def test_runs_in_which_every_kind_has_struck_are_counted(monkeypatch) -> None:
    rows = [disturbed.driven("demonstrator", "closures+slow", 0)]
    monkeypatch.setitem(disturbed.WRONG, "closures", {"every_s": 1e6, "lasting_s": 20.0})
    rows.append(disturbed.driven("demonstrator", "closures+slow", 0))
    assert [row["closures"] > 0 for row in rows] == [True, False]
    monkeypatch.setattr(disturbed, "MIXES", ["closures+slow"])
    assert disturbed.table(rows).splitlines()[1].split(" | ")[-2:] == ["1", "0"]


def test_a_panic_is_a_problem_of_its_run(monkeypatch) -> None:
    class PanicError(BaseException):
        pass

    def fall(self) -> None:
        raise PanicError("planned to a place")

    monkeypatch.setattr(disturbed.Checked, "run", fall)
    row = disturbed.driven("demonstrator", "slow", 0)
    assert row["problem"] == "PanicError: planned to a place"


def test_it_goes_on_where_it_was(tmp_path: Path, monkeypatch) -> None:
    monkeypatch.setattr(disturbed, "SITES", {"demonstrator": ("demonstrator", 20.0)})
    path = tmp_path / "runs.csv"
    assert len(disturbed.drive(path, range(1), float("inf"))) == 15
    before = path.read_text()
    rows = disturbed.drive(path, range(2), float("inf"))
    assert len(rows) == 30 and path.read_text().startswith(before)
    assert disturbed.table(rows).splitlines()[1].startswith("demonstrator | 30 | 2 | ")


def test_what_fails_or_has_no_end_is_told(monkeypatch) -> None:
    monkeypatch.setitem(disturbed.SITES, "small", ("no-such-scenario", 20.0))
    assert "InputError" in disturbed.driven("small", "slow", 0)["problem"]
    monkeypatch.setattr(disturbed, "LONGEST_S", 1)
    monkeypatch.setitem(disturbed.SITES, "small", ("small", 1e6))
    assert "no end after 1 s" in disturbed.driven("small", "slow", 0)["problem"]

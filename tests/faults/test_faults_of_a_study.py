"""Writes, renames and new files of an experiment fail one by one: resumed, it is the same."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest
from injection import KILLED, Ended, Injector
from tiny_design import DESIGN

from rmfs import experiments
from rmfs.experiments.results import to_csv


class Bench:
    """A folder in which an experiment is disturbed, and resumed."""

    def __init__(self, injector: Injector, place: Path, design: Path) -> None:
        self.injector, self.place = injector, place
        self.arguments = ["experiment", "run", str(design), "--out", "study", "--jobs", "1"]
        ended = self.call()
        assert ended.code == 0, ended.words
        self.calls, self.whole = ended.calls, self.table()

    def call(self, kind: str = "none", number: int = 0, *, resumed: bool = False) -> Ended:
        if not resumed:
            shutil.rmtree(self.place)
            self.place.mkdir()
        return self.injector.call(self.arguments, self.place, kind, number)

    def table(self) -> str:
        frame = experiments.load(self.place / "study")
        target = self.place.parent / "table.csv"
        to_csv(frame, target)
        return target.read_text()

    def judged(self, kind: str, number: int) -> str:
        """Return what came of it; raise if a run is lost, half-written or different."""
        ended = self.call(kind, number)
        assert "Traceback" not in ended.words, ended.words
        if kind == "killed":
            assert ended.code == KILLED
        elif ended.code == 0:
            # a folder could not be made that was there already
            assert self.table() == self.whole
            return "done"
        else:
            assert ended.code == 2, ended
            assert ended.words.splitlines()[-1].startswith("rmfs: ")
        stored = sorted((self.place / "study").glob("runs/[!.]*.parquet"))
        if kind != "killed":
            assert not list(self.place.rglob(".*.parquet.*"))
        if stored:
            lines = self.table().splitlines()
            assert set(lines) <= set(self.whole.splitlines())
            assert len(lines) == len(stored) + 1
        again = self.call(resumed=True)
        assert again.code == 0, again.words
        assert self.table() == self.whole
        assert not list(self.place.rglob(".*.parquet.*"))
        return f"{len(stored)} kept"


@pytest.fixture
def seeds() -> list[int]:
    """Return the seeds of the experiment: six runs with both rules."""
    return [1, 2, 3]


@pytest.fixture
def bench(injector, tmp_path: Path, seeds: list[int]) -> Bench:
    design = tmp_path / "design.toml"
    design.write_text(DESIGN.replace("[1, 2, 3]", str(seeds)))
    one, place = injector("quick_study:main")
    return Bench(one, place, design)


def disturbed(bench: Bench, kind: str, every: int) -> dict[str, int]:
    outcomes: dict[str, int] = {}
    calls = bench.calls
    assert calls > 100
    for number in sorted({1, 2, 3, calls - 1, calls, *range(1, calls + 1, every)}):
        outcome = bench.judged(kind, number)
        outcomes[outcome] = outcomes.get(outcome, 0) + 1
    print(kind, calls, outcomes)
    return outcomes


@pytest.mark.parametrize("kind", ["fails", "disk full", "killed"])
def test_some_changes(bench: Bench, kind: str) -> None:
    assert {"0 kept", "5 kept"} <= set(disturbed(bench, kind, every=1500))


def test_a_read_only_folder(bench: Bench) -> None:
    ended = bench.call("read-only", 1)
    assert ended.code == 2
    assert "Read-only file system" in ended.words.splitlines()[-1]
    assert ended.calls <= 3
    assert not list(bench.place.iterdir())


@pytest.mark.slow
@pytest.mark.parametrize("seeds", [[1]])
@pytest.mark.parametrize("kind", ["fails", "disk full", "killed"])
def test_many_changes(bench: Bench, kind: str) -> None:
    """All of the changes of two runs fail once; one in nine does in the other ways."""
    outcomes = disturbed(bench, kind, every=1 if kind == "fails" else 9)
    assert {"0 kept", "1 kept"} <= set(outcomes)  # the last change is what stores the second run

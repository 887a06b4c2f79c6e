"""Writes, renames and new files of a run fail one by one: nothing half-written, nothing lost."""

from __future__ import annotations

import shutil
from pathlib import Path

import pandas as pd
import pytest
from injection import KILLED, Ended, Injector

from rmfs.measure import load_run
from rmfs.measure.dictionary import reproducible

RUN = ["run", "--layout", "small", "--scenario", "small", "--trace", "--out", "out"]
SHORT = ["--set", "scenario.duration_s=20", "--set", "scenario.warmup_s=0"]
OLD = ["--seed", "1"]


def contents(folder: Path) -> dict[str, bytes]:
    paths = (path for path in folder.rglob("*") if path.is_file())
    return {str(path.relative_to(folder)): path.read_bytes() for path in paths}


def is_whole(folder: Path, footprint: pd.Series) -> bool:
    """Whether a run folder holds all of a run: it is read, proven and shows the same figures."""
    run = load_run(folder)
    assert run.check().ok
    names = reproducible("footprint")
    return bool(run.footprint[names].astype(str).equals(footprint[names].astype(str)))


class Bench:
    """A folder with an older run, or none, in which runs are disturbed."""

    def __init__(self, injector: Injector, place: Path, older: Path | None) -> None:
        self.injector, self.place, self.older = injector, place, older
        self.arguments = [*RUN, *SHORT, *(["--force"] if older else [])]
        self.before = contents(older) if older else {}

    def prepared(self) -> None:
        shutil.rmtree(self.place)
        self.place.mkdir()
        if self.older:
            shutil.copytree(self.older, self.place / "out")

    def call(self, kind: str = "none", number: int = 0) -> Ended:
        self.prepared()
        return self.injector.call(self.arguments, self.place, kind, number)

    def judged(self, ended: Ended, footprint: pd.Series) -> str:
        """Return the outcome; raise if something is lost or half-written."""
        out = self.place / "out"
        if ended.code == KILLED:
            outcome = self._found(out, footprint)
            again = [*self.arguments, *(["--force"] if out.exists() and not self.older else [])]
            repeated = self.injector.call(again, self.place)
            assert repeated.code == 0, repeated.words
            assert is_whole(out, footprint)
            left = sorted(path.name for path in self.place.iterdir())
            assert left == ["out"], left
            return outcome
        assert "Traceback" not in ended.words, ended.words
        assert sorted(path.name for path in self.place.iterdir()) in ([], ["out"])
        if ended.code == 0:
            assert is_whole(out, footprint)
            return "done"
        assert ended.code == 2, ended
        assert ended.words.splitlines()[-1].startswith("rmfs: ")
        return self._found(out, footprint)

    def _found(self, out: Path, footprint: pd.Series) -> str:
        if not out.exists():
            assert not self.older, "the older run is lost"
            return "nothing is there"
        if self.older and contents(out) == self.before:
            return "the older run is there"
        assert is_whole(out, footprint)
        return "the new run is there"


@pytest.fixture
def bench(injector, tmp_path: Path, request) -> tuple[Bench, pd.Series]:
    one, place = injector("quick_run:main")
    older = None
    if request.param == "an older run":
        assert one.call([*RUN, *SHORT, *OLD], place).code == 0
        older = tmp_path / "older"
        shutil.copytree(place / "out", older)
    made = Bench(one, place, older)
    ended = made.call()
    assert ended.code == 0, ended.words
    return made, load_run(place / "out").footprint


def disturbed(bench: tuple[Bench, pd.Series], kind: str, every: int) -> dict[str, int]:
    """Disturb the first changes, the last, and one in so many between; count the outcomes."""
    made, footprint = bench
    calls = made.call().calls
    assert calls > 40
    outcomes: dict[str, int] = {}
    numbers = {1, 2, 3, calls - 2, calls - 1, calls, *range(1, calls + 1, every)}
    for number in sorted(numbers):
        outcome = made.judged(made.call(kind, number), footprint)
        outcomes[outcome] = outcomes.get(outcome, 0) + 1
    print(kind, calls, outcomes)
    return outcomes


@pytest.mark.parametrize("bench", ["an empty folder", "an older run"], indirect=True)
@pytest.mark.parametrize("kind", ["fails", "disk full", "killed"])
def test_some_changes(bench, kind: str) -> None:
    outcomes = disturbed(bench, kind, every=600)
    assert set(outcomes) & {"nothing is there", "the older run is there"}


@pytest.mark.parametrize("bench", ["an empty folder", "an older run"], indirect=True)
def test_a_read_only_folder(bench) -> None:
    """Is noticed by the first write, before the run: it may take hours."""
    made, _ = bench
    ended = made.call("read-only", 1)
    assert ended.code == 2
    assert "Read-only file system" in ended.words.splitlines()[-1]
    assert ended.calls <= 3
    assert contents(made.place / "out") == made.before


@pytest.mark.slow
@pytest.mark.parametrize("bench", ["an empty folder", "an older run"], indirect=True)
@pytest.mark.parametrize("kind", ["fails", "disk full", "killed"])
def test_many_changes(bench, kind: str) -> None:
    outcomes = disturbed(bench, kind, every=1 if kind == "fails" else 9)
    assert set(outcomes) & {"nothing is there", "the older run is there"}

"""A disk that is full while commands write files: one line, and nothing half-written."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest
from injection import Ended, Injector

from rmfs import simulate

SHORT = ["--set", "scenario.duration_s=20", "--set", "scenario.warmup_s=0"]
SMALL = ["--layout", "small", "--scenario", "small"]
COMMANDS = {
    "report": ["report", "RUN", "--out", "report.html"],
    "tables": ["report", "RUN", "--out", "report.html", "--csv"],
    "plot": ["plot", "RUN", "--out", "plots"],
    "page": ["view", "RUN", "--export", "page.html"],
    "layout": ["layout", "new", "hall.toml"],
    "picture": ["layout", "show", "small", "--out", "hall.svg"],
    "picture as png": ["layout", "show", "small", "--out", "hall.png"],
    "skus": ["scenario", "sku-set", "default", "--out", "skus.json"],
    "popularity": ["scenario", "sku-set", "default", "--picture", "skus.svg"],
    "orders": ["scenario", "export", "small-arrivals", "orders.csv"],
    "record": ["run", *SMALL, *SHORT, "--out", "run", "--record", "streams"],
}
LIGHT = ("layout", "picture", "skus", "popularity")
"""Those that take a second or two a call."""


@pytest.fixture(scope="module")
def run(tmp_path_factory: pytest.TempPathFactory) -> Path:
    short = {"scenario.duration_s": 60, "scenario.warmup_s": 0}
    made = simulate("small", "small-arrivals", set=short, trace=True)
    return made.save(tmp_path_factory.mktemp("run") / "run").path


def contents(folder: Path) -> dict[str, bytes]:
    return {
        str(path.relative_to(folder)): path.read_bytes() if path.is_file() else b""
        for path in folder.rglob("*")
    }


class Bench:
    """A folder in which a command is called again and again."""

    def __init__(self, injector: Injector, place: Path, run: Path, arguments: list[str]) -> None:
        self.injector, self.place, self.run = injector, place, run
        self.arguments = arguments
        self.whole: set[str] = set()

    def call(self, kind: str = "none", number: int = 0) -> Ended:
        shutil.rmtree(self.place)
        self.place.mkdir()
        given = "RUN"
        if "--csv" in self.arguments:  # it writes into the run's folder
            given = str(self.place / "run")
            shutil.copytree(self.run, given)
        elif "RUN" in self.arguments:
            given = str(self.run)
        arguments = [given if one == "RUN" else one for one in self.arguments]
        return self.injector.call(arguments, self.place, kind, number)


@pytest.fixture(scope="module")
def called(shim: Path, tmp_path_factory: pytest.TempPathFactory):
    place = tmp_path_factory.mktemp("commands") / "place"
    place.mkdir()
    injector = Injector(shim, place, "rmfs.cli:main")
    yield injector, place
    injector.close()


@pytest.mark.parametrize(
    "name",
    [name if name in LIGHT else pytest.param(name, marks=pytest.mark.slow) for name in COMMANDS],
)
def test_one_line_and_nothing_half_written(called, run: Path, name: str) -> None:
    one, place = called
    bench = Bench(one, place, run, COMMANDS[name])
    ended = bench.call()
    assert ended.code == 0, ended.words
    whole, calls = contents(place), ended.calls
    assert calls > 0
    sizes = {path: len(content) for path, content in whole.items()}
    numbers = sorted({1, calls})
    failed = 0
    for number in numbers:
        ended = bench.call("disk full", number)
        told = f"{name}, disk full at {number} of {calls}: {ended.words}"
        assert "Traceback" not in ended.words, told
        assert ended.code in (0, 2), told
        if ended.code:
            failed += 1
            assert ended.words.splitlines()[-1].startswith("rmfs: "), told
        # what is there is whole: hidden files are none, and others as long as they are without
        found = contents(place)
        assert not [path for path in found if Path(path).name.startswith(".")], told
        assert set(found) <= set(whole), told
        for path, content in found.items():
            if not path.endswith((".parquet", ".json", ".csv", ".save")) or "run/" not in path:
                assert abs(len(content) - sizes[path]) <= 200, (told, path)
    assert failed

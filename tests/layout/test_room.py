"""What does not fit into memory is refused before it is begun, with what it would take."""

from __future__ import annotations

from pathlib import Path

import pytest

import rmfs
from rmfs import layout, room
from rmfs.cli import main
from rmfs.errors import InputError

LARGE = ["--set", "layout.horizontal_aisles=500", "--set", "layout.vertical_aisles=400"]
RUN = ["run", "--layout", "small", "--scenario", "small", "--out", "out"]
SHORT = ["--set", "scenario.duration_s=10", "--set", "scenario.warmup_s=0"]


@pytest.mark.parametrize(
    ("given", "free", "words"),
    [
        (LARGE, 2e9, "tiles"),
        (["--set", "scenario.skus.count=1000000"], 2e9, "1000000 SKUs on 100 pods"),
        (["--set", "scenario.demand.orders=100000"], 1e8, "100000 orders"),
    ],
)
def test_what_does_not_fit_is_refused(
    given: list[str],
    free: float,
    words: str,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys,
) -> None:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(room, "available", lambda: free)
    assert main([*RUN, *SHORT, *given]) == 2
    (line,) = capsys.readouterr().err.splitlines()[-1:]
    assert words in line and " GB of memory" in line and "--force" in line
    assert list(tmp_path.iterdir()) == []


def test_force_runs_it_all_the_same(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys
) -> None:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(room, "available", lambda: 1e5)
    assert main([*RUN, *SHORT]) == 2
    assert main([*RUN, *SHORT, "--force"]) == 0
    with pytest.raises(InputError, match="would need about"):
        rmfs.simulate("small", "small", set={"scenario.duration_s": 10})
    with pytest.raises(InputError, match="would need about"), room.forced(False):
        layout.load("small")
    with room.forced():
        layout.load("small")


def test_sizes_are_spoken() -> None:
    assert room.spoken(41.7e9) == "42 GB"
    assert room.spoken(1.25e9) == "1.2 GB"
    assert room.available() > 1e6

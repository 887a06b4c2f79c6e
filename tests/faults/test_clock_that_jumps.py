"""The clock of the machine jumps during a run: nothing but its time of day knows."""

from __future__ import annotations

import itertools
import re
import time
from pathlib import Path

import pytest

import rmfs
from rmfs.measure.dictionary import reproducible

ROOT = Path(rmfs.__file__).parents[1]
GIVEN = {"scenario.duration_s": 60, "scenario.warmup_s": 0}


def test_a_run(monkeypatch: pytest.MonkeyPatch) -> None:
    names = reproducible("footprint")
    whole = rmfs.simulate("small", "small", set=GIVEN).footprint[names]
    jumps = itertools.cycle([1e9, 0.0, 2e9, 1.0, -5.0])
    monkeypatch.setattr(time, "time", lambda: next(jumps))
    monkeypatch.setattr(time, "time_ns", lambda: int(next(jumps) * 1e9))
    assert rmfs.simulate("small", "small", set=GIVEN).footprint[names].equals(whole)


def test_no_duration_is_taken_from_the_time_of_day() -> None:
    for folder in ("rmfs", "solvers", "experiments"):
        for path in (ROOT / folder).rglob("*.py"):
            assert not re.search(r"\btime\.time(_ns)?\(", path.read_text("utf-8")), path

"""The tool that measures the speed of environments: it tells all that it measures."""

from __future__ import annotations

import pytest

pytest.importorskip("gymnasium")
from tests.tools import environment_speed


def test_it_tells_best_and_median(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(environment_speed, "WARM", 2)
    few = {"layout.robots": 4, "scenario.duration_s": 600, "scenario.warmup_s": 0}
    monkeypatch.setitem(environment_speed.GIVEN, "layout", "small")
    monkeypatch.setitem(environment_speed.GIVEN, "scenario", "small")
    monkeypatch.setitem(environment_speed.GIVEN, "set", few)
    assert environment_speed.main(["--rounds", "2", "--steps", "16", "--environments", "2"]) == 0
    head, *rows = capsys.readouterr().out.splitlines()
    assert head.split() == ["best", "median"]
    for row in rows:
        best, median = (float(one) for one in row.split()[-2:])
        assert (best <= median) if row.split()[-3] == "ms" else (best >= median > 0)

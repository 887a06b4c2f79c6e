"""The command that proves robot-days: cases repeat, it resumes, and it tells what is not right."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.tools import proof


def short(number: int) -> dict:
    case = whole(number)
    return {**case, "set": {**case["set"], "scenario.duration_s": 60.0, "layout.robots": 4}}


whole = proof.drawn


@pytest.fixture
def quick(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(proof, "drawn", short)


def test_cases_cover_what_there_is() -> None:
    cases = [whole(number) for number in range(300)]
    assert cases[:20] == [whole(number) for number in range(20)]
    assert {case["layout"] for case in cases} == {"small", "default", "study-128"} | {
        *("study-tiers", "study-32", "large")
    }
    assert {case["set"]["controllers.pp.name"] for case in cases} == set(proof.PLANNERS)
    wrong = {kind for case in cases for kind in case["set"].get("scenario.disturbances", {})}
    assert wrong == {"closures", "breakdowns", "slow", "elevators_out", "chargers"}
    keys = {key for case in cases for key in case["set"]}
    assert keys >= {"scenario.energy.battery", "scenario.packing"}
    assert keys >= {"layout.other_stations.charger", "layout.other_stations.swap"}


def test_it_goes_on_where_it_was(quick: None, tmp_path: Path, capsys) -> None:
    out = tmp_path / "cases.csv"
    arguments = ["--out", str(out), "--first", "3"]
    assert proof.main([*arguments, "--robot-days", "0.001"]) == 0
    before = proof.done(out)
    assert [row.case for row in before] == [3] and before[0].distance_km > 0
    assert proof.main([*arguments, "--robot-days", str(before[0].robot_days * 1.1)]) == 0
    after = proof.done(out)
    assert after[0] == before[0] and [row.case for row in after][:2] == [3, 4]
    assert "not right: none" in capsys.readouterr().out


@pytest.mark.parametrize("who", ["first checker", "second checker", "ledger", "Boom"])
def test_what_is_not_right_is_told(
    who: str, quick: None, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys
) -> None:
    def wrong(*_: object) -> None:
        raise AssertionError("units are lost")

    class BoomError(Exception):
        pass

    class Report:
        ok = False

        def summary(self, limit: int) -> str:
            return "robots overlap"

    match who:
        case "first checker":
            monkeypatch.setattr("rmfs.simulation.result.Run.check", lambda run: Report())
        case "second checker":
            monkeypatch.setattr(proof, "problems", lambda folder: ["robots touch"])
        case "ledger":
            monkeypatch.setattr(proof.Ledger, "check", wrong)
        case "Boom":
            monkeypatch.setattr(proof, "refuted", lambda *_: (_ for _ in ()).throw(BoomError("x")))
    out = tmp_path / "cases.csv"
    assert proof.main(["--out", str(out), "--first", "5", "--robot-days", "0.001"]) == 1
    assert proof.done(out)[0].problem.startswith(who)
    assert "not right: [5]" in capsys.readouterr().out

"""The fuzzer of inputs: cases repeat, whole inputs pass, and what must not happen is noticed."""

from __future__ import annotations

import json
import random
from pathlib import Path

import pytest

from tests.tools.spoil import mutations, trial
from tests.tools.spoil.__main__ import main
from tests.tools.spoil.cases import RUN, Case, made
from tests.tools.spoil.samples import SHORT, prepared


@pytest.fixture(scope="module")
def whole(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return prepared(tmp_path_factory.mktemp("spoil") / "whole")


def contents(folder: Path) -> dict[str, bytes]:
    paths = (path for path in folder.rglob("*") if path.is_file())
    return {str(path.relative_to(folder)): path.read_bytes() for path in paths}


def test_a_case_is_its_number(whole: Path, tmp_path: Path) -> None:
    kinds = set()
    for number in range(40):
        for folder in ("one", "two"):
            (tmp_path / folder / str(number)).mkdir(parents=True)
        one = made(number, whole, tmp_path / "one" / str(number))
        assert one == made(number, whole, tmp_path / "two" / str(number))
        kinds.add(one.kind)
    assert contents(tmp_path / "one") == contents(tmp_path / "two")
    assert len(kinds) > 8


def test_trees_are_spoilt_and_the_original_stays() -> None:
    tree = {"a": 1, "b": {"c": [1.0, 2.0, "x"], "d": True}}
    before = json.dumps(tree)
    spoilt = {json.dumps(mutations.tree(random.Random(n), tree), default=str) for n in range(200)}
    assert json.dumps(tree) == before
    assert len(spoilt) > 100


def judged(arguments: list[str], tmp_path: Path) -> trial.Verdict:
    for name in ("here", "tmp"):
        (tmp_path / name).mkdir()
    return trial._judged(Case(0, "test", arguments), tmp_path, {})


def test_a_whole_input_runs(tmp_path: Path) -> None:
    assert judged([*RUN, "--out", "out", *SHORT], tmp_path).outcome == "ran"


def broken(monkeypatch: pytest.MonkeyPatch, body) -> None:
    monkeypatch.setattr("rmfs.cli.main", body)


@pytest.mark.parametrize("what", ["traceback", "endless", "litter", "untold", "killed"])
def test_what_must_not_happen_is_noticed(
    what: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def main(arguments: list[str]) -> int:
        match what:
            case "traceback":
                raise ValueError("a defect")
            case "endless":
                while True:
                    pass
            case "litter":
                Path("left").touch()
                print("rmfs: refused", file=trial.sys.stderr)
            case "killed":
                trial.os.kill(trial.os.getpid(), trial.signal.SIGKILL)
        return 2

    broken(monkeypatch, main)
    monkeypatch.setattr(trial, "LIMIT_S", 0.3)
    verdict = judged([], tmp_path)
    assert verdict.outcome == what and not verdict.fine


def test_cases_are_counted(capsys, tmp_path: Path) -> None:
    assert main(["--cases", "12", "--seconds", "300", "--out", str(tmp_path)]) == 0
    assert capsys.readouterr().out.splitlines()[-1].startswith("12 cases: ")

"""Random cases for ten seconds, and again from a file."""

import json

from experiments.traffic import fuzz
from rmfs.cli import main


def test_ten_seconds(tmp_path, capsys):
    assert main(["traffic", "fuzz", "--seconds", "10", "--seed", "3", "--out", str(tmp_path)]) == 0
    assert " 0 failed" in capsys.readouterr().out
    assert list(tmp_path.iterdir()) == []


def test_a_case_is_its_number_and_can_be_replayed(tmp_path, capsys):
    case = fuzz.draw(1003)
    assert case == fuzz.draw(1003)
    path = tmp_path / "case.json"
    path.write_text(json.dumps(case))
    assert main(["traffic", "fuzz", "--replay", str(path)]) == 0
    assert "driven" in capsys.readouterr().out
    path.write_text("{}")
    assert main(["traffic", "fuzz", "--replay", str(path)]) == 2

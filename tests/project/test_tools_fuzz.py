"""Random cases for a few seconds, and again from a file."""

import json

from tests.tools import fuzz


def test_a_few_seconds(tmp_path, capsys):
    assert fuzz.main(["--seconds", "4", "--seed", "3", "--out", str(tmp_path)]) == 0
    assert " 0 failed" in capsys.readouterr().out
    assert list(tmp_path.iterdir()) == []


def test_a_case_is_its_number_and_can_be_replayed(tmp_path, capsys):
    case = fuzz.draw(1003)
    assert case == fuzz.draw(1003)
    path = tmp_path / "case.json"
    path.write_text(json.dumps(case))
    assert fuzz.main(["--replay", str(path)]) == 0
    assert "driven" in capsys.readouterr().out
    path.write_text("{}")
    assert fuzz.main(["--replay", str(path)]) == 2


def test_a_queue_that_begins_at_a_corner():
    """What fuzzing found once: nobody could enter such a queue where aisles run both ways."""
    layout = {
        "robots": 20,
        "horizontal_aisles": 4,
        "vertical_aisles": 6,
        "hall_width": 4,
        "two_directional_aisles": True,
        "counter_clockwise_ring": False,
        "pick_stations": {"east": 2},
        "replenishment_stations": {"west": 1, "south": 1},
    }
    case = {"case": 1061, "planner": "time-windows", "spoilt": "nothing", "layout": layout}
    assert fuzz.run(case).outcome == "driven"

"""The preview of a layout holds what a run with the same changes would have."""

import pytest

from rmfs import layout
from rmfs.errors import InputError
from rmfs.view.container import unpack
from rmfs.view.preview import preview


def test_it_is_the_layout_that_a_run_would_have() -> None:
    wish = {"layout": "default", "set": {"layout.robots": 9, "scenario.duration_s": 1.0}}
    header, arrays = unpack(preview(wish))
    plan = layout.load("default", [(["robots"], 9)])
    assert len(arrays["robot_waypoint"]) == plan.robots == 9
    assert (arrays["pod_waypoint"] == plan.pod_waypoint).all()
    assert len(header["stations"]) == len(plan.stations)
    assert header["title"] == "default"


@pytest.mark.parametrize(
    ("wish", "told"),
    [
        ({"layout": "default", "set": {"layout.robots": 0}}, "robots"),
        ({"layout": "../secret"}, "must be one of"),
        ({"layout": "default", "set": [1]}, "must map keys to values"),
    ],
)
def test_what_cannot_be_built_is_said(wish: dict, told: str) -> None:
    with pytest.raises(InputError, match=told):
        preview(wish)

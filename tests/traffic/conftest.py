from pathlib import Path

import pytest

from rmfs.control.choices import choose
from rmfs.control.pp import planner_settings
from rmfs.control.problems import Problem
from rmfs.layout import load

INSTANCES = Path(__file__).resolve().parents[2] / "../shared/reference/instances"


@pytest.fixture
def reference():
    """Loads a layout of the reference system, or skips."""

    def load_reference(name, **overrides):
        path = INSTANCES / name
        if not path.is_file():
            pytest.skip(f"{path} is not here")
        return load(str(path), [([key], value) for key, value in overrides.items()])

    return load_reference


@pytest.fixture
def settings_of():
    """A planner by name, or by a table of a controllers file."""

    def settings(planner, seed=1):
        table = {"name": planner} if isinstance(planner, str) else planner
        return planner_settings(choose(Problem.PP, table, "test"), seed)

    return settings

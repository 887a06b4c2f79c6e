"""A command line that simulates nothing: `simulate` is replaced, everything around it is real."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

sys.path.append(str(Path(__file__).resolve().parents[1] / "measure"))


@pytest.fixture
def calls(monkeypatch, tmp_path):
    """The arguments of every call of the replaced `simulate`; cwd is a fresh folder."""
    from fake_run import run

    made = []

    def simulate(layout, scenario, controllers, **arguments):
        given = {"layout": layout, "scenario": scenario, "controllers": controllers}
        made.append({**given, **arguments})
        arguments["progress"](0.0, 2.0)
        return run()

    monkeypatch.setattr("rmfs.simulation.run.simulate", simulate)
    monkeypatch.chdir(tmp_path)
    return made

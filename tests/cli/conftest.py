"""A command line that simulates nothing: `simulate` is replaced, everything around it is real."""

from __future__ import annotations

import sys
from pathlib import Path
from types import ModuleType

import pytest

sys.path.append(str(Path(__file__).resolve().parents[1] / "measure"))


@pytest.fixture
def calls(monkeypatch, tmp_path):
    """The keyword arguments of every call of the replaced `simulate`; cwd is a fresh folder."""
    from fake_run import run

    made = []

    def simulate(**arguments):
        made.append(arguments)
        arguments["progress"](1.0, 2.0)
        return run()

    module = ModuleType("rmfs.simulation.run")
    module.simulate = simulate
    monkeypatch.setitem(sys.modules, "rmfs.simulation.run", module)
    monkeypatch.chdir(tmp_path)
    return made

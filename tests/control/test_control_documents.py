"""The page on writing controllers is executed; the catalogue is what the code says."""

import re
import sys
from pathlib import Path

import pytest

import rmfs
from rmfs.control.catalogue import markdown

DOCS = Path(__file__).resolve().parents[2] / "docs"


@pytest.fixture(scope="module")
def page():
    return (DOCS / "write-a-controller.md").read_text("utf-8")


@pytest.fixture
def module(tmp_path, monkeypatch):
    """Write a module that can be imported during one test."""
    monkeypatch.syspath_prepend(str(tmp_path))
    written = []

    def write(name, code):
        (tmp_path / f"{name}.py").write_text(code)
        written.append(name)

    yield write
    for name in written:
        sys.modules.pop(name, None)


def test_the_example_runs(page, module, capsys):
    """What it compares is different; that all of its blocks run, tests/docs finds."""
    rule, comparison = re.findall(r"```python.*?\n(.*?)```", page, re.DOTALL)
    module("my_rules", rule)
    exec(comparison, {"__name__": "__main__"})
    near, ours = capsys.readouterr().out.splitlines()
    assert near.startswith("nearest ")
    assert ours.startswith("my_rules:WantedNear ")
    assert near.split()[1:] != ours.split()[1:]


@pytest.mark.parametrize("pacing", ["instant", "fixed=2", "wall"])
def test_the_controller_that_asks_runs(pacing, module):
    page = (DOCS / "optimisers-in-the-loop.md").read_text("utf-8")
    module("asks_for_orders", re.search(r"```python.*?\n(.*?)```", page, re.DOTALL)[1])
    changes = {
        "controllers.poa.name": "asks_for_orders:EarliestDue",
        "scenario.duration_s": 300,
        "scenario.warmup_s": 0,
    }
    if pacing == "wall":
        changes["pacing.workers"] = 1  # it asks one question after the other
    told = rmfs.simulate("basic", "basic", "default", pacing=pacing, set=changes).footprint
    assert told["orders_completed"] > 0
    assert told["optimiser_calls"] > 5 and told["optimiser_failures"] == 0
    assert told["optimiser_decision_share"] > 0.9 and told["heuristic_decision_share"] == 0


def test_the_catalogue_is_up_to_date():
    """Otherwise: python -m rmfs.control.catalogue > docs/controllers.md."""
    assert (DOCS / "controllers.md").read_text("utf-8") == markdown()

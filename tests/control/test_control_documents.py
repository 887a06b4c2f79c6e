"""The page on writing controllers is executed; the catalogue is what the code says."""

import re
import subprocess
import sys
from pathlib import Path

import pytest

from rmfs.control.catalogue import markdown

DOCS = Path(__file__).resolve().parents[2] / "docs"


@pytest.fixture(scope="module")
def page():
    return (DOCS / "write-a-controller.md").read_text("utf-8")


def test_the_example_runs(page, tmp_path, monkeypatch):
    """What it compares is different; that all of its blocks run, tests/docs finds."""
    rule, comparison = re.findall(r"```python.*?\n(.*?)```", page, re.DOTALL)
    (tmp_path / "my_rules.py").write_text(rule)
    (tmp_path / "compare.py").write_text(comparison)
    done = subprocess.run(
        [sys.executable, "compare.py"], cwd=tmp_path, capture_output=True, text=True, check=True
    )
    near, ours = done.stdout.splitlines()
    assert near.startswith("nearest ")
    assert ours.startswith("my_rules:WantedNear ")
    assert near.split()[1:] != ours.split()[1:]


@pytest.mark.parametrize("pacing", ["instant", "fixed=2", "wall"])
def test_the_controller_that_asks_runs(pacing, tmp_path):
    page = (DOCS / "optimisers-in-the-loop.md").read_text("utf-8")
    code = re.search(r"```python.*?\n(.*?)```", page, re.DOTALL)[1]
    (tmp_path / "asks_for_orders.py").write_text(code)
    (tmp_path / "run.py").write_text(
        "import rmfs\n"
        "changes = [(['controllers', 'poa', 'name'], 'asks_for_orders:EarliestDue')]\n"
        "changes += [(['scenario', 'duration_s'], 300), (['scenario', 'warmup_s'], 0)]\n"
        f"run = rmfs.simulate('basic', 'basic', 'default', pacing={pacing!r}, overrides=changes)\n"
        "told = run.footprint\n"
        "print(told['orders_completed'], told['optimiser_calls'], told['optimiser_failures'])\n"
        "print(told['optimiser_decision_share'], told['heuristic_decision_share'])\n"
    )
    done = subprocess.run(
        [sys.executable, "run.py"], cwd=tmp_path, capture_output=True, text=True, check=True
    )
    completed, calls, failures, by_optimiser, by_rule = (float(n) for n in done.stdout.split())
    assert completed > 0 and calls > 5 and failures == 0
    assert by_optimiser > 0.9 and by_rule == 0


def test_the_catalogue_is_up_to_date():
    """Otherwise: python -m rmfs.control.catalogue > docs/controllers.md."""
    assert (DOCS / "controllers.md").read_text("utf-8") == markdown()

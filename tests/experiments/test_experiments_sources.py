"""Runs are done again when a module that a user's rule imports has changed."""

from __future__ import annotations

import sys

import pytest
from stand_in import Inline

from rmfs import experiments
from rmfs.experiments.running.driver import drive
from rmfs.experiments.running.execute import execute
from rmfs.experiments.store import Store

RULE = """
from rmfs.control.psa.nearest import Nearest
from own_weights import OFFSET


class Mine(Nearest):
    def place(self, robot):
        places = self.view.storage.places
        return int(places[(self.view.storage.is_empty.nonzero()[0][OFFSET])])
"""


@pytest.fixture
def mine(design, tmp_path, monkeypatch):
    """A design with a rule of a user, whose module imports another one."""
    (tmp_path / "own_rules.py").write_text(RULE)
    (tmp_path / "own_weights.py").write_text("OFFSET = 0\n")
    monkeypatch.syspath_prepend(str(tmp_path))
    known = set(sys.modules)
    yield design(factors={"controllers.psa": ["nearest", "own_rules:Mine"]}, seeds=[1])
    for name in set(sys.modules) - known:
        del sys.modules[name]


def digests(plan) -> list[str]:
    return [arm.digest for arm in plan.arms]


def test_a_changed_helper_makes_the_arm_run_again(mine, tmp_path):
    store = Store(tmp_path / "out")
    before = experiments.plan(mine)
    assert drive(before, store, Inline()).ran == 2
    assert digests(experiments.plan(mine)) == digests(before)
    helper = tmp_path / "own_weights.py"
    assert str(helper) in before.files
    helper.write_text("OFFSET = -1\n")
    after = experiments.plan(mine)
    assert digests(after)[0] == digests(before)[0] and digests(after)[1] != digests(before)[1]
    assert after.hash != before.hash
    engine = Inline()
    assert drive(after, store, engine).ran == 1
    assert engine.done == ["psa=own_rules:Mine/1"]


def test_a_worker_that_lives_on_takes_the_changed_module(mine, tmp_path):
    def units_and_way():
        plan = experiments.plan(mine)
        done = execute(plan.job(plan.arms[1], 1))
        assert done.footprint is not None, done.traceback
        return done.footprint["distance_m"].iloc[0]

    before = units_and_way()
    assert units_and_way() == before
    (tmp_path / "own_weights.py").write_text("OFFSET = -1\n")
    assert units_and_way() != before


def test_a_worker_refuses_modules_other_than_planned_with(mine, tmp_path):
    plan = experiments.plan(mine)
    (tmp_path / "own_weights.py").write_text("OFFSET = -1\n")
    assert (
        "own_weights.py: changed since the plan was made"
        in execute(plan.job(plan.arms[1], 1)).error
    )

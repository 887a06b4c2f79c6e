"""What a user's rule decides and cannot be gets one line: problem, rule, time, decision, why."""

from __future__ import annotations

from pathlib import Path

import pytest

import rmfs
from rmfs.cli import main
from rmfs.errors import InputError, RuleError
from rmfs.simulation.idle_rules import IdleRuleWarning

HEAD = """
from rmfs.control.decisions import AssignOrder
from rmfs.control.poa.order_rules import FirstCome

class Odd(FirstCome):
    def decide(self):
"""
SHORT = {"scenario.warmup_s": 0, "scenario.duration_s": 120}

WRONG = {
    "an unknown station": (
        "yield AssignOrder(next(iter(self.view.orders)), 99)",
        r"^poa Odd at 0\.000 s: AssignOrder\(order=0, station=99\) is impossible: there is no pick "
        r"station 99 \(valid: 0 to 1\)$",
    ),
    "an order twice": (
        "order = next(iter(self.view.orders))\n        "
        "yield AssignOrder(order, 0)\n        yield AssignOrder(order, 0)",
        r"poa Odd at 0\.000 s: AssignOrder\(.* is impossible: ",
    ),
    "a tuple": ("yield (1, 2)", r"poa Odd at 0\.000 s: \(1, 2\) is impossible: "),
    "nothing at all": (
        "return None",
        r"poa Odd at 0\.000 s: decide must return decisions, not "
        "None",
    ),
}


@pytest.mark.parametrize("what", WRONG)
def test_what_is_impossible_is_said(what: str, tmp_path: Path, capsys) -> None:
    body, message = WRONG[what]
    (tmp_path / "odd.py").write_text(f"{HEAD}        {body}\n")
    rule = f"{tmp_path}/odd.py:Odd"
    with pytest.raises(RuleError, match=message):
        rmfs.simulate("basic", "basic", set={**SHORT, "controllers.poa.name": rule})
    out = str(tmp_path / "run")
    given = ["--layout", "basic", "--scenario", "basic", "--set", f"controllers.poa.name={rule}"]
    assert main(["run", *given, "--out", out]) not in (0, 2)
    lines = [line for line in capsys.readouterr().err.splitlines() if "poa Odd" in line]
    assert len(lines) == 1 and lines[0].startswith("rmfs: poa Odd at 0.000 s: ")
    assert not Path(out).exists()


def test_a_rule_without_decide_is_refused_before_the_run(tmp_path: Path) -> None:
    code = "from rmfs.control.poa import PickOrderAssignment\n"
    (tmp_path / "bare.py").write_text(code + "class Bare(PickOrderAssignment):\n    pass\n")
    with pytest.raises(InputError, match="Bare has no decide"):
        rmfs.simulate("basic", set={"controllers.poa.name": f"{tmp_path}/bare.py:Bare"})


ASKED_BY_TA = {
    "PPS: no such pod": (
        "pps",
        "from rmfs.control.pps.random import RandomPod as Base",
        "def pick_pod(self, robot, station):\n        return 9999",
        r"^pps Odd at \d+\.\d{3} s: pick pod 9999 is impossible: there is no pod 9999 ",
    ),
    "PPS: no number": (
        "pps",
        "from rmfs.control.pps.random import RandomPod as Base",
        "def pick_pod(self, robot, station):\n        return None",
        r"^pps Odd at \d+\.\d{3} s: pick pod None is impossible: None is not the number of a pod$",
    ),
    "PSA: no place": (
        "psa",
        "from rmfs.control.psa.nearest import Nearest as Base",
        "def place(self, robot):\n        return self.view.pick_stations[0].waypoint",
        r"^psa Odd at \d+\.\d{3} s: place \d+ is impossible: "
        r"waypoint \d+ is not a storage location$",
    ),
    "repositioning: no move": (
        "repositioning",
        "from rmfs.control.repositioning import Repositioning as Base",
        "def move(self, robot):\n        return 7",
        r"^repositioning Odd at \d+\.\d{3} s: move 7 is impossible: expected a Move of ",
    ),
}


@pytest.mark.parametrize("what", ASKED_BY_TA)
def test_what_is_answered_to_ta_is_looked_at(what: str, tmp_path: Path) -> None:
    problem, base, body, message = ASKED_BY_TA[what]
    (tmp_path / "odd.py").write_text(f"{base}\n\nclass Odd(Base):\n    {body}\n")
    rules = {f"controllers.{problem}.name": f"{tmp_path}/odd.py:Odd"}
    rules["controllers.ta.reposition_weight"] = 1.0
    with pytest.raises(RuleError, match=message):
        rmfs.simulate("basic", "basic", set={**SHORT, **rules})


def test_numbers_of_numpy_will_do(tmp_path: Path) -> None:
    code = """
import numpy as np
from rmfs.control.psa.nearest import Nearest

class Odd(Nearest):
    def place(self, robot):
        return np.int64(super().place(robot))
"""
    (tmp_path / "odd.py").write_text(code)
    runs = [
        rmfs.simulate("basic", "basic", set={**SHORT, "controllers.psa.name": name})
        for name in (f"{tmp_path}/odd.py:Odd", "nearest")
    ]
    assert runs[0].footprint["units_picked"] == runs[1].footprint["units_picked"] > 0


LAZY = {
    "poa": ("from rmfs.control.poa import PickOrderAssignment as Base", "orders wait and"),
    "rps": ("from rmfs.control.rps import ReplenishmentPodSelection as Base", "bundles wait for a"),
    "roa": (
        "from rmfs.control.roa import ReplenishmentOrderAssignment as Base",
        "bundles wait for a station with room",
    ),
}


@pytest.mark.parametrize("problem", LAZY)
def test_a_rule_that_never_decides_is_told_of(problem: str, tmp_path: Path, capsys) -> None:
    base, waits = LAZY[problem]
    (tmp_path / "lazy.py").write_text(
        f"{base}\n\nclass Lazy(Base):\n    def decide(self):\n        return iter(())\n"
    )
    rule = {f"controllers.{problem}.name": f"{tmp_path}/lazy.py:Lazy"}
    given = {"scenario.warmup_s": 0, "scenario.duration_s": 900, **rule}
    told = rf"{problem} .*Lazy has never made a decision \(.* ended at 900 s\), "
    told += rf"although \d+ {waits}"
    with pytest.warns(IdleRuleWarning, match=told):
        run = rmfs.simulate("basic", "basic", set=given)
    assert len(run.idle_rules) == 1
    options = [text for key, value in given.items() for text in ("--set", f"{key}={value}")]
    where = ["--layout", "basic", "--scenario", "basic", "--out", str(tmp_path / "run")]
    assert main(["run", *where, *options]) == 0
    (line,) = [line for line in capsys.readouterr().err.splitlines() if "has never made" in line]
    assert line.startswith(f"rmfs: warning: {problem} ")


@pytest.mark.parametrize("controllers", ["default", "random", "pile-on", "m1g"])
def test_shipped_rules_are_not_idle(controllers: str, recwarn) -> None:
    given = {"scenario.warmup_s": 0, "scenario.duration_s": 900}
    assert rmfs.simulate("basic", "basic", controllers, set=given).idle_rules == []
    assert not [one for one in recwarn if issubclass(one.category, IdleRuleWarning)]

"""What a user's rule decides and cannot be gets one line: problem, rule, time, decision, why."""

from __future__ import annotations

from pathlib import Path

import pytest

import rmfs
from rmfs.cli import main
from rmfs.errors import InputError, RuleError

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
        r"station 99 \(they are 0 to 1\)$",
    ),
    "an order twice": (
        "order = next(iter(self.view.orders))\n        "
        "yield AssignOrder(order, 0)\n        yield AssignOrder(order, 0)",
        r"poa Odd at 0\.000 s: AssignOrder\(.* is impossible: ",
    ),
    "a tuple": ("yield (1, 2)", r"poa Odd at 0\.000 s: \(1, 2\) is impossible: "),
    "nothing at all": ("return None", r"poa Odd at 0\.000 s: decide returned nothing to go by"),
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

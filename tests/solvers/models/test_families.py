"""Every family of models has the same parts under the same names."""

from __future__ import annotations

from importlib import import_module
from pathlib import Path

import pytest

import rmfs.solvers.models
from rmfs.solvers.models import ModelError
from rmfs.solvers.models.families import FAMILIES, family

ROOT = Path(rmfs.solvers.models.__file__).parent


@pytest.mark.parametrize("name", FAMILIES)
def test_a_method_is_a_file_with_solve(name: str) -> None:
    """`methods()` names the files whose `solve` is called, and there is no other such file."""
    found = family(name)
    folder = ROOT / FAMILIES[name].replace(".", "/")
    solving = {path.stem for path in folder.glob("*.py") if "\ndef solve(" in path.read_text()}
    assert set(found.methods()) == solving
    assert found.solve.default in found.methods()
    assert found.solve.rule in (*found.methods(), "")
    for method in found.methods():
        module = import_module(f"{found.__name__}.{method}")
        assert found.solve.by_name[method] is module.solve


@pytest.mark.parametrize("name", FAMILIES)
def test_every_family_can_judge_values(name: str) -> None:
    """Objective and violations are the family's own, for tests and for foreign solvers."""
    found = family(name)
    assert callable(found.objective)
    assert callable(found.violations)
    assert (ROOT / FAMILIES[name].replace(".", "/") / "data.py").is_file()


def test_every_folder_of_models_is_a_family() -> None:
    """A folder with data and objective is in the list."""
    folders = {".".join(p.parent.relative_to(ROOT).parts) for p in ROOT.glob("**/data.py")}
    assert folders == set(FAMILIES.values())


def test_unknown_names_are_refused_with_the_known_ones() -> None:
    """A family, and a method of one."""
    with pytest.raises(ModelError, match="family: must be one of pile_on, "):
        family("pileon")
    with pytest.raises(ModelError, match="method: must be one of cp_sat, columns, lns, greedy"):
        family("sequence").solve(None, "simplex")

import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from project_files import ROOT, toml

CONTRACTS = toml("pyproject.toml")["tool"]["importlinter"]["contracts"]


def lint_imports() -> str:
    beside = Path(sys.executable).with_name("lint-imports")
    return str(beside) if beside.exists() else shutil.which("lint-imports") or pytest.skip("absent")


def test_imports_go_one_way() -> None:
    told = subprocess.run(
        [lint_imports(), "--no-cache"], cwd=ROOT, capture_output=True, text=True, check=False
    )
    assert told.returncode == 0, told.stdout
    assert f"{len(CONTRACTS)} kept, 0 broken" in told.stdout


def test_contracts_name_all_parts_that_have_a_place_in_the_order() -> None:
    ordered = {
        part
        for contract in CONTRACTS
        for layer in contract.get("layers", [])
        for part in layer.replace(":", "|").split(" | ")
    }
    assert ordered >= {
        "rmfs.experiments",
        "rmfs.solvers",
        "rmfs.simulation",
        "rmfs.control",
        "rmfs.world",
        "rmfs.layout",
        "rmfs.scenario",
    }
    kept_apart = {
        (source, forbidden)
        for contract in CONTRACTS
        for source in contract.get("source_modules", [])
        for forbidden in contract["forbidden_modules"]
    }
    assert ("rmfs.traffic", "rmfs.world") in kept_apart
    assert ("rmfs.solvers.models", "rmfs.world") in kept_apart
    assert ("rmfs.simulation", "rmfs.rawsimo") in kept_apart

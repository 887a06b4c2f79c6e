import shutil
import subprocess
import sys
from pathlib import Path

import grimp
import networkx as nx
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


def circles(*, types: bool) -> list[list[str]]:
    """Groups of modules that import each other in a circle."""
    graph = grimp.build_graph("rmfs", cache_dir=None, exclude_type_checking_imports=not types)
    arrows = nx.DiGraph(
        (module, imported)
        for module in graph.modules
        for imported in graph.find_modules_directly_imported_by(module)
    )
    return [sorted(group) for group in nx.strongly_connected_components(arrows) if len(group) > 1]


def test_no_modules_import_each_other_in_a_circle() -> None:
    assert circles(types=False) == []


def test_types_are_shared_in_a_circle_inside_a_folder_only() -> None:
    """As `View` and the trackers it has, which look at a view."""
    for group in circles(types=True):
        shared = {tuple(module.split(".")[:2]) for module in group}
        assert len(shared) == 1, group
        assert len(group) <= 4, group


def test_no_part_of_a_run_has_the_whole_simulation() -> None:
    """Each is given the few things it needs: none but who drives a run imports the kernel."""
    graph = grimp.build_graph("rmfs", cache_dir=None)
    holders = {
        module
        for module in graph.find_modules_that_directly_import("rmfs.simulation.kernel")
        if module.startswith("rmfs.simulation.")
    }
    drivers = {"run", "checkpoints", "forking", "saving"}
    assert holders == {f"rmfs.simulation.{name}" for name in drivers}

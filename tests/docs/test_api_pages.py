"""The reference lists everything that a rule reads."""

from __future__ import annotations

import ast
import importlib
import inspect
import pkgutil
import re
from pathlib import Path
from types import ModuleType
from typing import TypeVar

import pytest
from code_blocks import ROOT

import rmfs.control.trackers
import rmfs.world
from rmfs.control.view import View

PAGES = sorted((ROOT / "docs" / "api").glob("*.md"))
ENTRY = re.compile(r"^\.\. auto(\w+):: (\S+)\n((?:   :.*\n)*)", re.MULTILINE)
ENTRIES = [entry for page in PAGES for entry in ENTRY.findall(page.read_text("utf-8"))]


def below(package: ModuleType) -> list[str]:
    return [f"{package.__name__}.{one.name}" for one in pkgutil.iter_modules(package.__path__)]


READ = [
    *below(rmfs.world),
    "rmfs.control.trackers",
    *below(rmfs.control.trackers),
    *(f"rmfs.control.{name}" for name in ("view", "candidates", "travel", "decisions", "asks")),
    *("rmfs.simulation.triggers", "rmfs.layout.model", "rmfs.scenario.skus.sku_set"),
]
"""Modules of which a rule reads objects: a new one in these packages is missed at once."""


def listed() -> set[str]:
    """Modules that the pages show with all their members."""
    return {
        name
        for kind, name, options in ENTRIES
        if kind == "module" and re.search(r"^   :members:\s*$", options, re.MULTILINE)
    }


def public(module: ModuleType) -> dict[str, str | None]:
    """Public names that a module defines, each with what is said of it."""
    tree = ast.parse(Path(str(module.__file__)).read_text("utf-8"))
    found: dict[str, str | None] = {}
    for statement, after in zip(tree.body, [*tree.body[1:], None], strict=True):
        if isinstance(statement, ast.ClassDef | ast.FunctionDef):
            found[statement.name] = ast.get_docstring(statement)
        targets = statement.targets if isinstance(statement, ast.Assign) else []
        targets = [statement.target] if isinstance(statement, ast.AnnAssign) else targets
        for target in (one for one in targets if isinstance(one, ast.Name)):
            text = after.value if isinstance(after, ast.Expr) else None
            said = isinstance(text, ast.Constant) and isinstance(text.value, str)
            found[target.id] = str(text.value) if said and isinstance(text, ast.Constant) else None
    return {name: said for name, said in found.items() if not name.startswith("_")}


@pytest.mark.parametrize("module", READ)
def test_what_a_rule_reads_is_listed(module: str):
    assert module in listed(), f"no page of docs/api shows {module} with its members"


@pytest.mark.parametrize("module", READ)
def test_no_public_name_is_left_out(module: str):
    """Sphinx shows only what has a text: classes, functions, constants, methods, properties."""
    loaded = importlib.import_module(module)
    silent = [name for name, said in public(loaded).items() if not said]
    for name in public(loaded):
        thing = getattr(loaded, name)
        if isinstance(thing, TypeVar) and name in silent:
            silent.remove(name)
        if inspect.isclass(thing) and thing.__module__ == module:
            silent += [
                f"{name}.{member}"
                for member, value in vars(thing).items()
                if not member.startswith("_")
                and (inspect.isfunction(value) or isinstance(value, property))
                and not inspect.getdoc(getattr(thing, member))
            ]
    assert silent == []


def test_entries_name_what_there_is():
    for kind, name, _ in ENTRIES:
        if kind == "module":
            importlib.import_module(name)
        else:
            module, _, member = name.rpartition(".")
            assert hasattr(importlib.import_module(module), member), name
    names = [name for _, name, _ in ENTRIES]
    assert len(names) == len(set(names))


def test_what_a_view_hands_out_is_of_modules_that_are_listed(made_view: View):
    """Objects of a real run, so that a new attribute of the view is seen here."""
    parts = [getattr(made_view, name) for name in dir(made_view) if not name.startswith("_")]
    parts += [item for part in parts if isinstance(part, list | tuple) for item in part[:1]]
    named = {type(part).__module__ for part in parts}
    ours = {name for name in named if name.startswith("rmfs.")}
    assert len(ours) > 5
    assert ours <= listed()


@pytest.fixture
def made_view() -> View:
    simulation = rmfs.Simulation("small", "small", "default", seed=1)
    simulation.run_until(60.0)
    return simulation.view

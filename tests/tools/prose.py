"""Pages and public docstrings drawn at random, for a reader to rate: `python -m tests.tools.prose`.

A reader who did not write them marks whatever has to be read twice. The seed makes the draw
repeatable: the same seed draws the same names as long as no page or public name comes or goes.
"""

from __future__ import annotations

import argparse
import ast
import random
import sys
from dataclasses import dataclass
from typing import TYPE_CHECKING

from tests.tools.checkout import ROOT

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

PACKAGES = ("rmfs", "solvers", "experiments")


@dataclass(frozen=True)
class Docstring:
    """A public docstring, its place and its text."""

    place: str
    name: str
    text: str

    def __str__(self) -> str:
        """The text below the name and the place."""
        body = "\n".join(f"    {line}".rstrip() for line in self.text.splitlines())
        return f"{self.name} ({self.place})\n{body}\n"


def pages() -> list[str]:
    """Return the names of all pages: the README, the change log and the documentation."""
    found = {path.relative_to(ROOT) for path in (ROOT / "docs").glob("**/*.md")}
    kept = {path.as_posix() for path in found if not {"_build", "paper"} & {*path.parts}}
    return sorted(kept | {"README.md", "CHANGELOG.md"})


def docstrings() -> list[Docstring]:
    """Return all docstrings of public modules, classes, functions and methods, sorted by place."""
    found: list[Docstring] = []
    for package in PACKAGES:
        for path in sorted((ROOT / package).rglob("*.py")):
            inside = path.relative_to(ROOT).parts
            # links to packages that are read by themselves, and modules that are not public
            if any((ROOT.joinpath(*inside[:n])).is_symlink() for n in range(1, len(inside))):
                continue
            if not any(part.startswith("_") and part != "__init__.py" for part in inside):
                found += _of_module(path)
    return sorted(found, key=lambda one: (one.place, one.name))


def _of_module(path: Path) -> Iterator[Docstring]:
    tree = ast.parse(path.read_text("utf-8"))
    place = path.relative_to(ROOT).as_posix()
    module = place.removesuffix(".py").removesuffix("/__init__").replace("/", ".")
    for name, node in _public(tree, module):
        text = ast.get_docstring(node)
        if text:
            line = 1 if isinstance(node, ast.Module) else node.lineno
            yield Docstring(f"{place}:{line}", name, text)


Documented = ast.Module | ast.ClassDef | ast.FunctionDef | ast.AsyncFunctionDef


def _public(node: Documented, name: str) -> Iterator[tuple[str, Documented]]:
    """Walk through a module and its classes, but not into functions."""
    yield name, node
    if isinstance(node, ast.Module | ast.ClassDef):
        for child in node.body:
            if not isinstance(child, ast.ClassDef | ast.FunctionDef | ast.AsyncFunctionDef):
                continue
            if not child.name.startswith("_"):
                yield from _public(child, f"{name}.{child.name}")


def draw(seed: int, number_of_pages: int, number: int) -> tuple[list[str], list[Docstring]]:
    """Draw pages and docstrings without replacement, each from a stream of its own."""
    chosen = random.Random(f"{seed} pages").sample(pages(), number_of_pages)
    return chosen, random.Random(f"{seed} docstrings").sample(docstrings(), number)


def main(arguments: list[str] | None = None) -> int:
    """Print the draw and return the exit code."""
    parser = argparse.ArgumentParser(prog="python -m tests.tools.prose", description=__doc__)
    parser.add_argument("--seed", type=int, required=True, help="what is drawn depends on it alone")
    parser.add_argument("--pages", type=int, default=10, help="[default: 10]")
    parser.add_argument("--docstrings", type=int, default=50, help="[default: 50]")
    given = parser.parse_args(arguments)
    try:
        chosen, drawn = draw(given.seed, given.pages, given.docstrings)
    except ValueError:
        print("prose: there are not that many, or the number is negative", file=sys.stderr)
        return 2
    print("\n".join(chosen), end="\n\n")
    print("\n".join(map(str, drawn)))
    return 0


if __name__ == "__main__":
    sys.exit(main())

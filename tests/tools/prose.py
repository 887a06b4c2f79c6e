"""Pages and public docstrings drawn at random, for a reader to rate: `python -m tests.tools.prose`.

A reader who did not write them marks whatever has to be read twice. The seed makes the draw
repeatable: the same seed draws the same names as long as no page or public name comes or goes.

Strict readers mark sentences of any text. With `--among`, as many docstrings of other packages are
mixed in, so that readers do not know which are ours, and the rates can be compared. Readers see
each docstring as in a reference or an editor: with its signature, and with the summaries of its
class and module.
"""

from __future__ import annotations

import argparse
import ast
import importlib.util
import random
import re
import sys
from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING

from rmfs.files import write_text
from tests.tools.checkout import ROOT

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

PACKAGES = ("rmfs", "solvers", "experiments")

LONGEST = 30
"""Maximum number of lines of a docstring of another package."""

FURTHER = re.compile(r"(Examples?|References|See Also|Notes)\n-{3,}\n|>>> |\.\. ")
"""What begins the parts of docstrings that readers do not rate, as ours hardly have them."""


@dataclass(frozen=True)
class Docstring:
    """A public docstring: its place, its name, its text, and what a reader sees beside it.

    Attributes
    ----------
    context
        The summaries of the module and of the class that it belongs to, and its own signature.
    """

    place: str
    name: str
    text: str
    context: tuple[str, ...] = ()

    def __str__(self) -> str:
        """The text below the name and the place."""
        body = "\n".join(f"    {line}".rstrip() for line in self.text.splitlines())
        return f"{self.name} ({self.place})\n{body}\n"


def pages() -> list[str]:
    """Return the names of all pages: the README, the change log and the documentation."""
    found = {path.relative_to(ROOT) for path in (ROOT / "docs").glob("**/*.md")}
    kept = {path.as_posix() for path in found if not {"_build", "paper"} & {*path.parts}}
    return sorted(kept | {"README.md", "CHANGELOG.md"})


@cache
def docstrings() -> tuple[Docstring, ...]:
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
    return tuple(sorted(found, key=lambda one: (one.place, one.name)))


@cache
def others(package: str) -> tuple[Docstring, ...]:
    """Return the docstrings of another installed package that are as short as most of ours.

    Left out are tests, and what readers do not rate, such as examples.

    Raises
    ------
    ValueError
        If the package is not installed.
    """
    spec = importlib.util.find_spec(package)
    if spec is None or not spec.submodule_search_locations:
        raise ValueError(f"{package}: not an installed package")
    folder = Path(spec.submodule_search_locations[0])
    found: dict[str, Docstring] = {}
    for path in sorted(folder.rglob("*.py")):
        inside = path.relative_to(folder).parts
        if any(part.startswith("_") or "test" in part for part in inside):
            continue
        for one in _of_module(path, folder.parent):
            text = FURTHER.split(one.text)[0].rstrip()
            if text and text.count("\n") < LONGEST:
                found.setdefault(text, replace(one, text=text))
    return tuple(found.values())


def _of_module(path: Path, root: Path = ROOT) -> Iterator[Docstring]:
    tree = ast.parse(path.read_text("utf-8"))
    place = path.relative_to(root).as_posix()
    module = place.removesuffix(".py").removesuffix("/__init__").replace("/", ".")
    for name, node, around in _public(tree, module):
        text = ast.get_docstring(node)
        if text:
            line = 1 if isinstance(node, ast.Module) else node.lineno
            yield Docstring(f"{place}:{line}", name, text, around)


Documented = ast.Module | ast.ClassDef | ast.FunctionDef | ast.AsyncFunctionDef


def _public(
    node: Documented, name: str, around: tuple[str, ...] = ()
) -> Iterator[tuple[str, Documented, tuple[str, ...]]]:
    """Walk through a module and its classes, but not into functions; also yield the context."""
    signature = () if isinstance(node, ast.Module) else (_signature(node),)
    yield name, node, (*around, *signature)
    if isinstance(node, ast.Module | ast.ClassDef):
        title = "module" if isinstance(node, ast.Module) else f"class {node.name}"
        summary = (ast.get_docstring(node) or "").partition("\n\n")[0].replace("\n", " ")
        inner = (*around, f"{title}: {summary}") if summary else around
        for child in node.body:
            if not isinstance(child, ast.ClassDef | ast.FunctionDef | ast.AsyncFunctionDef):
                continue
            if not child.name.startswith("_"):
                yield from _public(child, f"{name}.{child.name}", inner)


def _signature(node: ast.ClassDef | ast.FunctionDef | ast.AsyncFunctionDef) -> str:
    """The signature of a function, or the name of a class and of those that it is derived from."""
    if isinstance(node, ast.ClassDef):
        return f"class {node.name}({', '.join(map(ast.unparse, node.bases))})"
    returns = f" -> {ast.unparse(node.returns)}" if node.returns else ""
    return f"def {node.name}({ast.unparse(node.args)}){returns}"


def draw(seed: int, number_of_pages: int, number: int) -> tuple[list[str], list[Docstring]]:
    """Draw pages and docstrings without replacement, each from a stream of its own."""
    chosen = random.Random(f"{seed} pages").sample(pages(), number_of_pages)
    return chosen, random.Random(f"{seed} docstrings").sample(docstrings(), number)


def mixed(seed: int, number: int, packages: Sequence[str]) -> list[Docstring]:
    """Draw as many docstrings of other packages as of ours, all in a random order.

    Parameters
    ----------
    number
        Number of our docstrings, the same as `draw` draws with this seed. The packages contribute
        equal shares of the others, as far as possible.
    """
    stream = random.Random(f"{seed} others")
    drawn = draw(seed, 0, number)[1]
    for index, package in enumerate(packages):
        share = number * (index + 1) // len(packages) - number * index // len(packages)
        drawn += stream.sample(others(package), share)
    stream.shuffle(drawn)
    return drawn


def write_mixed(drawn: Sequence[Docstring], folder: Path) -> None:
    """Write the docstrings without their origin, numbered, and a key that states the origin."""
    folder.mkdir(parents=True, exist_ok=True)
    blind = [
        "\n".join(
            [
                f"## {number}: {one.name.rpartition('.')[2]}",
                "",
                *(f"> {line}  " for line in one.context),
                "",
                one.text,
                "",
            ]
        )
        for number, one in enumerate(drawn, 1)
    ]
    key = [f"{number},{one.name},{one.place}\n" for number, one in enumerate(drawn, 1)]
    write_text(folder / "passages.md", "\n".join(blind))
    write_text(folder / "key.csv", "number,name,place\n" + "".join(key))


def main(arguments: list[str] | None = None) -> int:
    """Print the draw and return the exit code."""
    parser = argparse.ArgumentParser(prog="python -m tests.tools.prose", description=__doc__)
    parser.add_argument("--seed", type=int, required=True, help="what is drawn depends on it alone")
    parser.add_argument("--pages", type=int, default=10, help="[default: 10]")
    parser.add_argument("--docstrings", type=int, default=50, help="[default: 50]")
    parser.add_argument(
        "--among", nargs="+", metavar="PACKAGE", help="mix in docstrings of these packages"
    )
    parser.add_argument("--out", type=Path, help="with --among: where to write them, and the key")
    given = parser.parse_args(arguments)
    if (given.among is None) != (given.out is None):
        parser.error("--among and --out go together")
    try:
        chosen, drawn = draw(given.seed, given.pages, given.docstrings)
        if given.among is not None:
            write_mixed(mixed(given.seed, given.docstrings, given.among), given.out)
            drawn = []
    except ValueError as error:
        print(
            f"prose: there are not that many, or the number is negative ({error})", file=sys.stderr
        )
        return 2
    print("\n".join(chosen), end="\n\n")
    print("\n".join(map(str, drawn)))
    return 0


if __name__ == "__main__":
    sys.exit(main())

"""The user's source files on which a class depends: its module, and what this module imports.

Imports are found by parsing the source text, so the answer does not depend on what the current
process has imported. Python, rmfs and installed packages other than that of the class are left
out, since their versions identify them.
"""

from __future__ import annotations

import ast
import inspect
import sys
import sysconfig
from dataclasses import dataclass
from importlib.machinery import PathFinder
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Sequence

_INSTALLED = ("site-packages", "dist-packages")
_STANDARD = tuple(Path(sysconfig.get_path(key)).resolve() for key in ("stdlib", "platstdlib"))
_OWN = __name__.partition(".")[0]


@dataclass(frozen=True)
class _Module:
    """A module that has been located.

    Attributes
    ----------
    below
        Folders of its submodules; empty unless it is a package.
    """

    name: str
    file: Path
    below: Sequence[str] | None

    @property
    def package(self) -> str:
        """The package to which relative imports refer."""
        return self.name if self.below is not None else self.name.rpartition(".")[0]


def sources(classes: Iterable[type]) -> dict[str, Path]:
    """Return the user's files that classes depend on, by module name.

    A class of rmfs itself depends on none; a class of another installed package depends on the
    files of that package. Modules imported under a name computed at run time are not found.
    """
    found: dict[str, Path] = {}
    for one in classes:
        name = one.__module__
        home = name.partition(".")[0]
        if home != _OWN:
            _collect(name, home, found, _file_of(one))
    return dict(sorted(found.items()))


def _collect(first: str, home: str, found: dict[str, Path], file: Path | None) -> None:
    """Add a module and what it imports."""
    waiting = [first]
    seen = set(found)
    while waiting:
        name = waiting.pop()
        if name in seen or name.partition(".")[0] == _OWN:
            continue
        seen.add(name)
        module = _find(name)
        if module is None and name == first and file is not None:
            module = _Module(name, file, None)
        if module is None or not _is_users(module, home):
            continue
        found[name] = module.file
        waiting += _imported(module)


def _find(name: str) -> _Module | None:
    """Find a module without importing it."""
    loaded = sys.modules.get(name)
    if loaded is not None:
        file, below = getattr(loaded, "__file__", None), getattr(loaded, "__path__", None)
        return None if file is None else _Module(name, Path(file), below and list(below))
    above = name.rpartition(".")[0]
    package = _find(above) if above else None
    if above and (package is None or package.below is None):
        return None
    spec = PathFinder.find_spec(name, None if package is None else package.below)
    if spec is None or spec.origin is None or not spec.has_location:
        return None
    return _Module(name, Path(spec.origin), spec.submodule_search_locations)


def _is_users(module: _Module, home: str) -> bool:
    """Whether a module belongs neither to Python nor to an installed package other than `home`."""
    path = module.file.resolve()
    if any(part in _INSTALLED for part in path.parts):
        return module.name.partition(".")[0] == home
    return path.suffix == ".py" and not any(path.is_relative_to(above) for above in _STANDARD)


def _imported(module: _Module) -> Iterator[str]:
    """Yield all names that a module may import as modules, and their parent packages."""
    try:
        tree = ast.parse(module.file.read_bytes())
    except (OSError, SyntaxError, ValueError):
        return
    for name in _named(tree, module.package):
        parts = name.split(".")
        yield from (".".join(parts[:count]) for count in range(1, len(parts) + 1))


def _named(node: ast.AST, package: str) -> Iterator[str]:
    """Yield the names in the import statements of a tree."""
    if isinstance(node, ast.Import):
        yield from (alias.name for alias in node.names)
    elif isinstance(node, ast.ImportFrom):
        base = node.module or ""
        if node.level:
            above = package.split(".")[: len(package.split(".")) - node.level + 1]
            base = ".".join([*above, *([base] if base else [])])
        if base:
            yield base
            yield from (f"{base}.{alias.name}" for alias in node.names if alias.name != "*")
    elif isinstance(node, ast.If) and _is_for_types(node.test):
        for other in node.orelse:
            yield from _named(other, package)
    elif isinstance(node, ast.Call) and _says(node.func, "import_module") and node.args:
        first = node.args[0]
        if isinstance(first, ast.Constant) and isinstance(first.value, str):
            yield first.value.lstrip(".")
    else:
        for child in ast.iter_child_nodes(node):
            yield from _named(child, package)


def _is_for_types(test: ast.expr) -> bool:
    return _says(test, "TYPE_CHECKING")


def _says(node: ast.expr, name: str) -> bool:
    """Whether an expression is this name, or an attribute of that name."""
    return (isinstance(node, ast.Name) and node.id == name) or (
        isinstance(node, ast.Attribute) and node.attr == name
    )


def _file_of(one: type) -> Path | None:
    try:
        return Path(inspect.getfile(one))
    except (OSError, TypeError):  # a class typed at a prompt
        return None

"""User-defined classes, referenced as `module:Class` or `path/to/file.py:Class`, or given directly.

Modules are looked up on the Python path, then in the working directory. A file is imported under
a module name that encodes its path (`file:/mine/rules%2Epy`), so that files of the same name do not
clash and pickled objects find their class in another process.
"""

from __future__ import annotations

import importlib
import importlib.util
import inspect
import sys
from collections.abc import Mapping
from contextlib import contextmanager
from contextvars import ContextVar
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar
from urllib.parse import quote, unquote

import numpy as np

from rmfs.errors import InputError

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence
    from importlib.machinery import ModuleSpec
    from types import ModuleType

T = TypeVar("T")

_FILE = "file:"
_SUFFIX = ".py"

_GIVEN: dict[str, type] = {}
"""Classes given directly, as in notebooks and functions, which cannot be found by name."""


def resolve(reference: str | type, base: type[T], what: str) -> type[T]:
    """Return the class that a reference denotes.

    Parameters
    ----------
    reference
        The class itself, `module:Class`, or `path/to/file.py:Class`.
    base
        Required base class.
    what
        What the class must be, for error messages, such as "measure".

    Raises
    ------
    InputError
        If the class cannot be found or imported, or is not derived from `base`.
    """
    found = reference if isinstance(reference, type) else _imported(reference, what)
    if isinstance(found, type) and issubclass(found, base):
        return found
    told = reference if isinstance(reference, str) else reference.__qualname__
    article = "an" if what[0] in "aeiou" else "a"
    kind = f"{base.__module__}.{base.__qualname__}"
    raise InputError(f"{told}: is not {article} {what} (a class derived from {kind})")


_INSTALLED_ONLY: ContextVar[bool] = ContextVar("_INSTALLED_ONLY", default=False)


@contextmanager
def installed_only() -> Iterator[None]:
    """Return a context in which `require_allowed` refuses references such as `module:Class`.

    The context is for requests that may select installed classes by name but must not run any
    other code, such as requests from a web page.
    """
    token = _INSTALLED_ONLY.set(True)
    try:
        yield
    finally:
        _INSTALLED_ONLY.reset(token)


def require_allowed(reference: str) -> None:
    """Raise an error if references to classes are refused at present.

    The reference itself is not examined; it only appears in the message.

    Raises
    ------
    InputError
        Within the context `installed_only`.
    """
    if _INSTALLED_ONLY.get():
        raise InputError(
            f"{reference}: must be the name of an installed class, not a reference to code"
        )


def is_reference(text: str) -> bool:
    """Return whether a text is `module:Class` or `file.py:Class`, not a plain name."""
    return ":" in text


def anchored(reference: str, folder: Path | None = None) -> str:
    """Return a reference with the absolute path of its file, if it refers to a file.

    Parameters
    ----------
    reference
        `path/to/file.py:Class`, `module:Class` or a plain name.
    folder
        Folder in which the file is sought first. If the file is not there, or no folder is given,
        the path is relative to the working directory.

    Returns
    -------
    str
        `/absolute/file.py:Class` for a file; any other reference unchanged.
    """
    place, _, name = reference.rpartition(":")
    if not place.endswith(_SUFFIX):
        return reference
    beside = (folder or Path()) / place
    path = beside if beside.is_file() else Path(place)
    return f"{path.absolute()}:{name}"


def anchored_file(given: str, folder: Path) -> str:
    """Return the absolute path of `given` if `folder` contains this file; otherwise, `given`."""
    beside = folder / given
    try:
        return str(beside.absolute()) if beside.is_file() else given
    except OSError:  # too long for a file name: reported where the file is read
        return given


def reference_of(found: type) -> str:
    """Return a reference by which another process finds a class.

    Raises
    ------
    InputError
        If the class cannot be imported because it was defined in a notebook, at a prompt or in a
        function.
    """
    module = found.__module__
    if module.startswith(_FILE):
        return f"{_path_of(module)}:{found.__qualname__}"
    if "." in found.__qualname__:
        raise InputError(f"{found.__qualname__}: must be defined in a module, not in a function")
    if module != "__main__":
        return f"{module}:{found.__qualname__}"
    file = getattr(sys.modules[module], "__file__", None)
    if file is None:
        raise InputError(
            f"{found.__qualname__}: was defined in a notebook or at a prompt, where worker "
            "processes cannot find it; write it to a file and import it from there"
        )
    return f"{Path(file).absolute()}:{found.__qualname__}"


def name_of(found: type) -> str:
    """Return a name by which `resolve` finds a class in this process, wherever it was defined.

    A class that is defined in `__main__` or cannot be imported is kept in memory under this name.
    """
    try:
        return reference_of(found) if found.__module__ != "__main__" else _remembered(found)
    except InputError:
        return _remembered(found)


def plain(value: Any, name: Callable[[type], str]) -> Any:
    """Return a value with classes replaced by names, and with plain Python types throughout.

    Tuples become lists, paths become strings, and NumPy scalars become Python numbers.

    Parameters
    ----------
    name
        Function that gives the name of a class: `name_of` within this process, `reference_of` for
        other processes.
    """
    if isinstance(value, type):
        return name(value)
    if isinstance(value, Mapping):
        return {key: plain(item, name) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [plain(item, name) for item in value]
    if isinstance(value, Path):
        return str(value)
    return value.item() if isinstance(value, np.generic) else value


def _remembered(found: type) -> str:
    name = f"{found.__module__}:{found.__qualname__}"
    _GIVEN[name] = found
    return name


def source_file(found: type) -> Path | None:
    """Return the file that defines a class; None for a class typed at a prompt, for example."""
    try:
        return Path(inspect.getfile(found))
    except (OSError, TypeError):
        return None


def _imported(reference: str, what: str) -> object:
    place, _, name = reference.rpartition(":")
    if reference in _GIVEN:
        return _GIVEN[reference]
    if not place or not name:
        raise InputError(
            f"{reference}: no {what} has this name; expected module:Class or path/to/file.py:Class"
        )
    module = _file(place, reference) if place.endswith(_SUFFIX) else _module(place, reference)
    try:
        found: object = getattr(module, name)
    except AttributeError:
        known = [
            one
            for one, value in vars(module).items()
            if isinstance(value, type) and value.__module__ == module.__name__
        ]
        there = f"; its classes: {', '.join(known)}" if known else ""
        raise InputError(f"{reference}: {place} has no class {name}{there}") from None
    return found


def _file(place: str, reference: str) -> ModuleType:
    path = Path(place).absolute()
    if not path.is_file():
        raise InputError(f"{reference}: there is no file {path}")
    return _import(_module_name(path), reference)


def _module(name: str, reference: str) -> ModuleType:
    here = str(Path.cwd())
    if not _exists(name) and here not in sys.path:
        # last, so that a file cannot hide an installed module of the same name
        sys.path.append(here)
        importlib.invalidate_caches()
    if not _exists(name):
        raise InputError(
            f"{reference}: there is no module {name}, neither installed nor in the working "
            f"directory ({here}); a file is given by its path: path/to/file.py:Class"
        )
    return _import(name, reference)


def _exists(name: str) -> bool:
    if name in sys.modules:
        return True
    try:
        return importlib.util.find_spec(name) is not None
    except (ModuleNotFoundError, ValueError):
        return False
    except Exception:  # its package exists but fails to import: `_import` reports how
        return True


def _import(name: str, reference: str) -> ModuleType:
    try:
        return importlib.import_module(name)
    except KeyboardInterrupt:
        raise
    except BaseException as error:  # anything a user's file may do when it is run, even `exit()`
        line = str(error).splitlines()[0] if str(error) else ""
        raise InputError(
            f"{reference}: cannot be loaded ({type(error).__name__}: {line})"
        ) from error


def _module_name(path: Path) -> str:
    # a dot would separate a package from its module
    return _FILE + quote(str(path)).replace(".", "%2E")


def _path_of(name: str) -> Path:
    return Path(unquote(name.removeprefix(_FILE)))


class _Files:
    """Finds the modules of user files, also when an instance of their classes is unpickled."""

    @classmethod
    def find_spec(
        cls, name: str, path: Sequence[str] | None = None, target: ModuleType | None = None
    ) -> ModuleSpec | None:
        if not name.startswith(_FILE):
            return None
        place = _path_of(name)
        folder = str(place.parent)
        if folder not in sys.path:
            # modules beside the file are found as if the file were run as a script
            sys.path.append(folder)
        return importlib.util.spec_from_file_location(name, place)


if not any(getattr(finder, "__name__", "") == _Files.__name__ for finder in sys.meta_path):
    sys.meta_path.append(_Files)

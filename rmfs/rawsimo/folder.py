"""Import of a file of RAWSim-O, or of all such files in a folder.

The converted files are written to the folders `layouts`, `scenarios`, `controllers` and `skus`, in
the same subfolders as in the source. `skus` also contains lists of orders and bundles. The file
`import.md` lists every file of the source. For each file, it states what was left out or differs in
rmfs, or why the file was skipped or refused.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING

from rmfs import control, scenario
from rmfs import layout as layouts
from rmfs.control.toml import to_toml
from rmfs.errors import InputError
from rmfs.files import replacing_folder, write_text
from rmfs.layout.checks import IMPOSSIBLE
from rmfs.rawsimo.layout.writing import import_layout
from rmfs.rawsimo.scenario import read_xgenc, read_xitem
from rmfs.scenario.parameters import SkuFile
from rmfs.scenario.skus import write_sku_set
from rmfs.scenario.sources import sku_set
from rmfs.scenario.streams import write_stream
from rmfs.scenario.writing import write_scenario

if TYPE_CHECKING:
    from collections.abc import Callable

LIST = "import.md"


@dataclass
class Imported:
    """The result of importing one file.

    Attributes
    ----------
    source
        Path of the file, relative to the imported folder.
    kind
        Kind of the file, such as "scenario"; empty if it is not a RAWSim-O file that can be
        imported.
    written
        Paths of the converted files, relative to the target folder.
    notes
        Remarks on what was left out or differs in rmfs.
    refused
        Reason why the file was refused; empty if the file was not refused.
    """

    source: Path
    kind: str
    written: list[Path] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)
    refused: str = ""

    def lines(self) -> list[str]:
        """Return the result as lines of text, the first of which names the file."""
        if not self.kind:
            return [
                f"{self.source.as_posix()}: skipped, as it is not a RAWSim-O file that can be "
                "imported"
            ]
        if self.refused:
            return [f"{self.source.as_posix()}: {self.kind}, refused: {self.refused}"]
        made = ", ".join(path.as_posix() for path in self.written)
        notes = [f"  {note}" for note in self.notes]
        return [f"{self.source.as_posix()}: {self.kind}, written as {made}", *notes]


def import_files(
    source: Path, target: Path, tell: Callable[[Imported], None] = lambda _: None
) -> list[Imported]:
    """Import a file, or all files of a folder and its subfolders.

    If a file is refused, the others are still imported.

    Parameters
    ----------
    source
        The file or folder.
    target
        The folder to create. An existing folder is replaced, but only if it is empty or was written
        by an earlier import.
    tell
        Function that is called with the result for each file as soon as this file has been handled.

    Returns
    -------
    The result for each file, sorted by path.

    Raises
    ------
    InputError
        If the source does not exist or contains nothing that can be imported, or if the target
        cannot be written or replaced. In all these cases, the target is left unchanged.
    """
    if not source.exists():
        raise InputError(f"{source}: no such file or folder")
    base = source if source.is_dir() else source.parent
    paths = sorted(path for path in source.rglob("*") if path.is_file()) or [source]
    with replacing_folder(target, LIST, "folder of an import") as folder:
        done: list[Imported] = []
        for path in paths:
            done.append(_imported(path, path.relative_to(base), folder))
            tell(done[-1])
        if not any(one.written for one in done):
            known = ", ".join(_KINDS)
            reason = next((one.refused for one in done if one.refused), f"no {known} file")
            raise InputError(f"{source}: nothing to import: {reason}")
        listed = (line for one in done for line in one.lines())
        items = (line[: -len(line.lstrip())] + f"- {line.lstrip()}\n" for line in listed)
        write_text(folder / LIST, f"# Imported from {source.name}\n\n{''.join(items)}")
    return done


def _imported(path: Path, name: Path, folder: Path) -> Imported:
    """Import one file; if it is invalid, the error becomes the reason for the refusal."""
    suffix = path.suffix.lower()
    if suffix not in _KINDS:
        return Imported(name, "")
    kind, below, ending, write = _KINDS[suffix]
    done = Imported(name, kind)
    goal = folder / below / name.parent
    try:
        with TemporaryDirectory(dir=folder) as aside:
            written, done.notes = write(path, Path(aside) / f"{path.stem}{ending}")
            _move(written, goal, folder)
        done.written = [(goal / one.name).relative_to(folder) for one in written]
    except InputError as error:
        done.refused = str(error).removeprefix(f"{path}: ")
    return done


def _move(files: list[Path], goal: Path, folder: Path) -> None:
    """Move the converted files to the folder `goal`; refuse if any of them exists there."""
    for file in files:
        if (goal / file.name).exists():
            taken = (goal / file.name).relative_to(folder).as_posix()
            raise InputError(f"another file was already imported as {taken}")
    goal.mkdir(parents=True, exist_ok=True)
    for file in files:
        file.replace(goal / file.name)


Written = tuple[list[Path], list[str]]
"""What the import of one file returns: the files written, and remarks."""


def _layout(path: Path, target: Path) -> Written:
    notes = import_layout(path, target)
    violations = layouts.check(layouts.load(target))
    if any(one.severity == IMPOSSIBLE for one in violations):
        layouts.refuse(layouts.load(target), path.name, allow_not_well_formed=True)
    if violations:
        notes.append(
            "not well-formed: a run refuses it without --allow-not-well-formed: "
            + "; ".join(map(str, violations))
        )
    return [target], notes


def _scenario(path: Path, target: Path) -> Written:
    read, notes = scenario.load_with_notes(path)
    return write_scenario(read, target), notes


def _controllers(path: Path, target: Path) -> Written:
    read, notes = control.load_with_notes(path)
    write_text(target, to_toml(read))
    return [target], notes


def _sku_set(path: Path, target: Path) -> Written:
    content = read_xgenc(path)
    write_sku_set(sku_set(SkuFile(file=path)), target)
    missing = {
        "space per unit": content.space_per_unit,
        "units per bundle": content.bundle_units,
    }
    drawn = [what for what, given in missing.items() if given is None]
    notes = [f"has no {what}: drawn with the default parameters of a scenario" for what in drawn]
    return [target], notes


def _order_list(path: Path, target: Path) -> Written:
    """Write the SKUs, orders and bundles of a list; the orders have no due times."""
    read = read_xitem(path)
    skus = sku_set(SkuFile(file=path))
    orders, bundles = (target.with_name(f"{target.stem}-{w}.csv") for w in ("orders", "bundles"))
    write_sku_set(skus, target)
    write_stream(read.orders(skus), skus, orders)
    write_stream(read.bundles(skus, math.inf), skus, bundles)
    return [target, orders, bundles], list(read.notes)


_KINDS: dict[str, tuple[str, str, str, Callable[[Path, Path], Written]]] = {
    ".xinst": ("explicit layout", "layouts", ".json", _layout),
    ".xlayo": ("parameters of a layout", "layouts", ".toml", _layout),
    ".xsett": ("scenario", "scenarios", ".toml", _scenario),
    ".xconf": ("controllers", "controllers", ".toml", _controllers),
    ".xgenc": ("SKU set", "skus", ".json", _sku_set),
    ".xitem": ("list of orders and bundles", "skus", ".json", _order_list),
}
"""Kind of a file, target folder and suffix, and the function that writes it."""

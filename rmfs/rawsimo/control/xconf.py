"""Reader for RAWSim-O's controller configurations (.xconf).

Every element is either mapped to a rule or parameter of rmfs, or listed in a note that states why
it is not used.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from rmfs.rawsimo.control import orders, others, paths, pods, tasks
from rmfs.rawsimo.scenario.settings import Settings
from rmfs.rawsimo.xml import read_root

if TYPE_CHECKING:
    from collections.abc import Callable, Collection
    from pathlib import Path

    from rmfs.config import Table

ROOT = "ControlConfiguration"


class _Block(NamedTuple):
    """One of the nine blocks: tag, default method, known methods, and function that reads it."""

    tag: str
    usual: str
    methods: Collection[str]
    read: Callable[[str, Settings], Table]


_BLOCKS = {
    "poa": _Block("OrderBatchingConfig", "PodMatching", orders.POA, orders.poa),
    "roa": _Block("ReplenishmentBatchingConfig", "SamePod", orders.ROA, orders.roa),
    "rps": _Block("ItemStorageConfig", "Emptiest", pods.RPS, pods.rps),
    "ta": _Block("TaskAllocationConfig", "Balanced", tasks.TA, tasks.ta),
    "psa": _Block("PodStorageConfig", "Nearest", pods.PSA, pods.psa),
    "repositioning": _Block("RepositioningConfig", "Dummy", pods.REPOSITIONING, pods.repositioning),
    "sa": _Block("StationActivationConfig", "ActivateAll", others.SA, others.sa),
    "mm": _Block("MethodManagementConfig", "NoChange", others.MM, others.mm),
    "pp": _Block("PathPlanningConfig", "FAR", paths.PP, paths.pp),
}

_OLD_TYPES = tuple(f"{block.tag.removesuffix('Config')}Type" for block in _BLOCKS.values())
_COMMENTS = ("CommentTag1", "CommentTag2", "CommentTag3")


class ImportedControllers(NamedTuple):
    """The controllers read from a controller configuration.

    Attributes
    ----------
    table
        The configuration as the table of a controllers file, not yet validated.
    notes
        Remarks on what was left out, and on differences in rmfs.
    """

    table: Table
    notes: list[str]


def read_xconf(path: Path) -> ImportedControllers:
    """Read a controller configuration; missing elements take RAWSim-O's defaults.

    Raises
    ------
    InputError
        If the file is not a controller configuration, a method is unknown or has no counterpart in
        rmfs, or a value is invalid.
    """
    notes: list[str] = []
    root = Settings(read_root(path, ROOT), path, notes)
    table: Table = {"format": "rmfs-controllers/1", "name": root.text("Name") or path.stem}
    comments = [text for tag in _COMMENTS if (text := root.text(tag))]
    table["description"] = "; ".join(comments) or f"imported from RAWSim-O's {path.name}"
    root.leave(_OLD_TYPES, "RAWSim-O no longer supports it; the type of each block takes its place")
    for problem, given in _BLOCKS.items():
        before = len(notes)
        block = root.block(given.tag)
        block.text("Name")
        method = _method(given, block, root)
        table[problem] = given.read(method, block)
        if problem == "ta":
            table["pps"] = tasks.pps(method, block)
        block.leave_rest()
        # the same is often said of each of several criteria
        notes[before:] = dict.fromkeys(f"{given.tag}: {note}" for note in notes[before:])
    root.leave_rest()
    _let_robots_decide(table, notes)
    return ImportedControllers(table, notes)


def _method(given: _Block, block: Settings, root: Settings) -> str:
    """Return the method that the type of a block names."""
    suffix = f"{given.tag.removesuffix('Config')}Configuration"
    method = block.kind.removesuffix(suffix) or given.usual
    if method not in given.methods:
        raise root.error(
            given.tag,
            f"type {block.kind:.60} is unknown or has no counterpart in rmfs; known methods: "
            f"{', '.join(given.methods)}",
        )
    return method


def _let_robots_decide(table: Table, notes: list[str]) -> None:
    """Replace rules where RAWSim-O and rmfs differ in what the robots decide themselves.

    In both, brute force chooses the pods and stores them. In rmfs, however, it takes bundles to the
    pods that RPS has chosen, and ROA chooses the stations of bundles.
    """
    brute = table["ta"]["name"] == "brute-force"
    if brute and table["psa"]["name"] != "dummy":
        name = table["psa"]["name"]
        notes.append(f"PodStorageConfig: {name} not used: BruteForce also stores pods")
        table["psa"] = {"name": "dummy"}
    if table["rps"]["name"] == "dummy":
        notes.append(
            "ItemStorageConfig: random replaces the dummy: rmfs needs a rule that chooses the pods "
            "of bundles"
        )
        table["rps"] = {"name": "random"}
    if table["psa"]["name"] == "dummy" and not brute:
        notes.append("PodStorageConfig: random replaces the dummy: a rule must store the pods")
        table["psa"] = {"name": "random"}

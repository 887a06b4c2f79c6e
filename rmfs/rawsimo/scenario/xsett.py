"""Reader for RAWSim-O's settings files (.xsett), which define scenarios.

Every element is mapped to a parameter of rmfs or listed in a note that states why it is not used.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from rmfs.rawsimo.scenario.inventory import Inventory
from rmfs.rawsimo.scenario.overrides import layout_overrides
from rmfs.rawsimo.scenario.settings import Settings
from rmfs.rawsimo.xml import read_root

if TYPE_CHECKING:
    from pathlib import Path
    from typing import Any

    from rmfs.config import Table

ROOT = "SettingConfiguration"

_NOT_USED = {
    "the seed is an option of rmfs run": ("Seed",),
    "the scenario does not determine what is printed and written": (
        *("LogLevel", "LogFileLevel", "DebugMode", "MonitorWellSortedness"),
        *("IntenseLocationPolling", "StationShutdownThresholdTime"),
    ),
    "robots stop exactly at waypoints": ("Tolerance",),
    "robots always accelerate, turn in time and use queue zones": (
        *("UseAcceleration", "UseTurnDelay", "QueueHandlingEnabled"),
    ),
    "only for drawing": ("RotatePods",),
    "a controller that needs these frequencies counts them itself": (
        "CorrelativeFrequencyTracking",
    ),
    "RAWSim-O no longer supports it": ("HeatMode", "PPInstanceDumpFrequency"),
}
_COMMENTS = ("CommentTag1", "CommentTag2", "CommentTag3")


class ImportedSettings(NamedTuple):
    """The contents of a settings file.

    Attributes
    ----------
    table
        The scenario, not yet validated; paths of files in it are absolute.
    notes
        Notes on settings that were left out, and on differences between RAWSim-O and rmfs.
    layout
        Overrides of the layout: pairs of a key path, which begins with `layout`, and a value.
    """

    table: Table
    notes: list[str]
    layout: list[tuple[list[str], Any]]


def read_xsett(path: Path) -> ImportedSettings:
    """Read a settings file; missing elements take RAWSim-O's defaults.

    Raises
    ------
    InputError
        If the file is not a settings file, if it contains an invalid value, or if it refers to a
        file that is missing.
    """
    notes: list[str] = []
    settings = Settings(read_root(path, ROOT), path, notes)
    table: Table = {
        "format": "rmfs-scenario/1",
        "name": settings.text("Name") or path.stem,
        "duration_s": settings.number("SimulationDuration", 172800.0),
        "warmup_s": settings.number("SimulationWarmupTime", 0.0),
    }
    comments = [text for tag in _COMMENTS if (text := settings.text(tag))]
    table["description"] = "; ".join(comments) or f"imported from RAWSim-O's {path.name}"
    table |= Inventory(settings.block("InventoryConfiguration"), path).tables()
    layout = layout_overrides(settings.block("OverrideConfig"))
    for reason, tags in _NOT_USED.items():
        settings.leave(tags, reason)
    settings.leave_rest()
    return ImportedSettings(table, notes, layout)

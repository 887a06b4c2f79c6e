"""The command line, with runs of experiments that simulate nothing, in the driver's process."""

from __future__ import annotations

from stand_in import Inline

from rmfs.cli import main as command_line
from rmfs.experiments.running import local


def main(arguments: list[str]) -> int:
    local.LocalProcesses = lambda _: Inline()
    return command_line(arguments)

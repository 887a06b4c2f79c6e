"""The command line, with runs of experiments that simulate nothing, in the driver's process."""

from __future__ import annotations

import contextlib
import functools
import io
import os
import tempfile
from pathlib import Path

import typer.main
from stand_in import Inline
from tiny_design import DESIGN

from rmfs.cli import main as command_line
from rmfs.experiments.running import local

# the commands of the command line are made once, not in each call
typer.main.get_command = functools.cache(typer.main.get_command)


def main(arguments: list[str]) -> int:
    local.LocalProcesses = lambda _: Inline()
    return command_line(arguments)


def warm() -> None:
    """Run it once: what commands import then, no call pays for."""
    quiet = contextlib.redirect_stdout(io.StringIO())
    with tempfile.TemporaryDirectory() as folder, contextlib.chdir(folder), quiet:
        Path("design.toml").write_text(DESIGN)
        main(["experiment", "run", "design.toml", "--out", "out", "--jobs", "1"])


if os.environ.get("RMFS_FAULTS"):
    warm()

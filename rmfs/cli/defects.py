"""Reports on defects that the program detects: a line for the user, a file for the developers."""

from __future__ import annotations

import platform
import shlex
import sys
import tempfile
import traceback
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from rmfs.errors import InternalError


def told(error: InternalError, arguments: list[str] | None) -> str:
    """Write a report of a defect to a file, and return a message with the file's name.

    Parameters
    ----------
    error
        The defect; its notes name the run in which it occurred.
    arguments
        Command-line arguments. Default: those of the process.
    """
    where = "".join(f", {note}" for note in getattr(error, "__notes__", []))
    return f"internal error{where}: {error}; please report {written(error, arguments)}"


def written(error: InternalError, arguments: list[str] | None) -> Path:
    """Write a file, in the working folder, with everything that helps to reproduce a defect.

    Returns
    -------
    Path
        The file; in the folder for temporary files if the working folder is not writable.

    Raises
    ------
    InternalError
        The given error, if neither folder is writable.
    """
    from rmfs.measure.provenance import version

    given = sys.argv[1:] if arguments is None else arguments
    text = "\n".join(
        [
            f"rmfs {version()}, Python {platform.python_version()}, {platform.platform()}",
            shlex.join(["rmfs", *given]),
            "",
            *traceback.format_exception(error),
        ]
    )
    for folder in (Path.cwd(), None):
        try:
            with tempfile.NamedTemporaryFile(
                "w",
                encoding="utf-8",
                prefix="rmfs-defect-",
                suffix=".txt",
                dir=folder,
                delete=False,
            ) as file:
                file.write(text)
        except OSError:
            continue
        return Path(file.name)
    raise error

"""Where tables are printed."""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from rich.console import Console

WIDE = 240
"""Width of a table that goes to a file or a pipe."""


def open_console() -> Console:
    """Return what tables are printed to; elsewhere than on a terminal they are not folded."""
    from rich.console import Console

    return Console(highlight=False, width=None if sys.stdout.isatty() else WIDE)

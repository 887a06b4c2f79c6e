"""The console on which tables are printed."""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from rich.console import Console

WIDE = 240
"""Width of tables written to a file or a pipe."""


def open_console() -> Console:
    """Return the console for tables.

    It is as wide as the terminal or, if the output is not a terminal, 240 characters wide.
    """
    from rich.console import Console

    return Console(highlight=False, width=None if sys.stdout.isatty() else WIDE)

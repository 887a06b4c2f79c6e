"""The console on which tables are printed."""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from rich.console import Console

WIDE = 240
"""Width of tables written to a file or a pipe."""


def open_console() -> Console:
    """Return the console for tables, as wide as the terminal; 240 characters without a terminal."""
    from rich.console import Console

    return Console(highlight=False, width=None if sys.stdout.isatty() else WIDE)

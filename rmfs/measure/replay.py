"""The page with the replay of a run, as a file and as a frame in a notebook."""

from __future__ import annotations

import html
import sys
from dataclasses import dataclass
from pathlib import Path

FRAME_HEIGHT = 640
"""Height of the frame in a notebook, in pixels, at which panel and floor plan are legible."""


@dataclass(frozen=True, slots=True)
class Replay:
    """A page with the replay of a run; a notebook displays it in a frame.

    The frame contains the whole page, not a link to a file. The replay therefore needs no server
    and remains in the notebook when the notebook is sent to others.

    Attributes
    ----------
    path
        The HTML file, which opens in any browser.
    height
        Height (pixels) of the frame in a notebook.
    """

    path: Path
    height: int = FRAME_HEIGHT

    def __fspath__(self) -> str:
        """Return the file, so that it can be opened, copied or removed like any other."""
        return str(self.path)

    @property
    def size_mb(self) -> float:
        """Size of the page in megabytes; displaying it enlarges a notebook by about as much."""
        return self.path.stat().st_size / 1e6

    def _repr_html_(self) -> str:
        page = html.escape(self.path.read_text("utf-8"), quote=True)
        style = f"width: 100%; height: {self.height}px; border: 1px solid #d5d9de"
        return f'<iframe title="replay of a run" style="{style}" srcdoc="{page}"></iframe>'


def in_notebook() -> bool:
    """Return whether this code runs in a notebook, that is, in a Jupyter kernel."""
    shell = sys.modules.get("IPython")
    return shell is not None and type(shell.get_ipython()).__name__ == "ZMQInteractiveShell"

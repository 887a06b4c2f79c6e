"""Base class for the results of a run, whether it has just finished or was loaded from a folder."""

from __future__ import annotations

import importlib
import tempfile
import webbrowser
from abc import ABC, abstractmethod
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rmfs.measure.replay import FRAME_HEIGHT, Replay, in_notebook

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.figure import Figure

    from rmfs.measure.checker import CheckReport
    from rmfs.measure.folder import RunFolder
    from rmfs.measure.summary import Summary

EXPORT = "rmfs.view.export:export"
"""Module and function that export a replay page; the viewer is a layer above the measures."""


class Results(ABC):
    """The results of one run."""

    __slots__ = ()

    @property
    @abstractmethod
    def footprint(self) -> pd.Series[Any]:
        """Measures of the whole run, as in the single row of `footprint.csv`."""

    @property
    def series(self) -> pd.DataFrame:
        """The table `series`: one row of measures for each minute."""
        return self.table("series")

    @property
    def decisions(self) -> pd.DataFrame:
        """The table `decisions`: calls of controllers, and questions to optimisers."""
        return self.table("decisions")

    @abstractmethod
    def table(self, name: str) -> pd.DataFrame:
        """Return a table by its name in the data dictionary: `orders`, `stations`, `series`, ...

        Raises
        ------
        InputError
            If there is no such table, or it cannot be read.
        """

    @abstractmethod
    def check(self) -> CheckReport:
        """Verify with the independent checker that the motion is safe; needs a recorded trace.

        Raises
        ------
        InputError
            If there is no trace, or it is invalid.
        """

    @abstractmethod
    def save(self, path: str | Path, *, force: bool = False) -> RunFolder:
        """Write a run folder, with the trace if there is one, and return the folder.

        Parameters
        ----------
        force
            Whether to replace an existing run folder. Default False.

        Raises
        ------
        InputError
            If `path` is already a run folder and `force` is False, or the folder cannot be written.
        """

    def summary(self) -> Summary:
        """Return the main figures, formatted for display at a prompt or in a notebook."""
        from rmfs.measure.summary import summarised

        return summarised(self.footprint)

    def plot(self, what: str = "throughput") -> Figure:
        """Draw a plot by its name: `throughput`, `heat`, `backlog`, `turnover`, `stations`, ...

        Raises
        ------
        InputError
            If there is no such plot, or its table cannot be read.
        """
        from rmfs.measure.pictures import picture

        return picture(self, what)

    def view(
        self,
        path: str | Path | None = None,
        *,
        open_browser: bool | None = None,
        height: int = FRAME_HEIGHT,
    ) -> Replay:
        """Write a page with a replay of the run, and show it; needs a recorded trace.

        A notebook shows the page in a frame below the cell; elsewhere, a browser opens it unless
        `open_browser` is False.

        Parameters
        ----------
        path
            The HTML file to write. Default: a temporary file.
        open_browser
            Whether to open the page in a browser. Default: True, but False in a notebook.
        height
            Height of the frame in a notebook, in pixels.

        Returns
        -------
        Replay
            The page. Its attribute `path` is the file. The object itself can also be passed to
            functions that take a path, such as Python's `open`.

        Raises
        ------
        InputError
            If there is no trace, or the file cannot be written.
        """
        page = Path(path or Path(tempfile.mkdtemp(prefix="rmfs-")) / "run.html")
        module, _, name = EXPORT.partition(":")
        export = getattr(importlib.import_module(module), name)
        with tempfile.TemporaryDirectory() as folder:
            export([self._in_folder(Path(folder) / "run")], page)
        if not in_notebook() if open_browser is None else open_browser:
            webbrowser.open(page.absolute().as_uri())
        return Replay(page, height)

    def _in_folder(self, path: Path) -> RunFolder:
        """Return the run as a folder; `path` is where one can be written."""
        return self.save(path)

    def __repr__(self) -> str:
        return str(self.summary())

    def _repr_html_(self) -> str:
        return self.summary()._repr_html_()

    def __rich__(self) -> Any:
        return self.summary().__rich__()

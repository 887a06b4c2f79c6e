"""What a run that has just ended and one that is read from its folder have in common."""

from __future__ import annotations

import importlib
import tempfile
import webbrowser
from abc import ABC, abstractmethod
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.figure import Figure

    from rmfs.measure.checker import CheckReport
    from rmfs.measure.folder import RunFolder
    from rmfs.measure.summary import Summary

EXPORT = "rmfs.view.export:export"
"""Module and function that write a page with a replay: the viewer stands above the measures."""


class Results(ABC):
    """The results of one run."""

    __slots__ = ()

    @property
    @abstractmethod
    def footprint(self) -> pd.Series[Any]:
        """Measures of the whole run; one row of `footprint.csv`."""

    @abstractmethod
    def table(self, name: str) -> pd.DataFrame:
        """Return a table of the data dictionary by name: `orders`, `stations`, `series`, ...

        Raises
        ------
        InputError
            If there is no such table.
        """

    @abstractmethod
    def check(self) -> CheckReport:
        """Have the independent checker prove the motion safe; the trace must be recorded.

        Raises
        ------
        InputError
            If there is no trace.
        """

    @abstractmethod
    def save(self, path: str | Path, *, force: bool = False) -> RunFolder:
        """Write a run folder, with the trace if there is one, and return it.

        Parameters
        ----------
        force
            Whether to replace a run folder that is there already.

        Raises
        ------
        InputError
            If the folder is there already or cannot be written.
        """

    def summary(self) -> Summary:
        """Return the main figures; they show themselves at a prompt and in a notebook."""
        from rmfs.measure.summary import summarised

        return summarised(self.footprint)

    def plot(self, what: str = "throughput") -> Figure:
        """Draw a picture: `throughput`, `heat`, `backlog`, `turnover`, `stations`, `robots`, ...

        Raises
        ------
        InputError
            If there is no such picture.
        """
        from rmfs.measure.pictures import picture

        return picture(self, what)

    def view(self, path: str | Path | None = None, *, open_browser: bool = True) -> Path:
        """Write a page with a replay of the run, and open it; the trace must be recorded.

        Parameters
        ----------
        path
            The HTML file. Default: a temporary one.

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
        if open_browser:
            webbrowser.open(page.absolute().as_uri())
        return page

    def _in_folder(self, path: Path) -> RunFolder:
        """Return the run as a folder; `path` is a place to write one."""
        return self.save(path)

    def __repr__(self) -> str:
        return str(self.summary())

    def _repr_html_(self) -> str:
        return self.summary()._repr_html_()

    def __rich__(self) -> Any:
        return self.summary().__rich__()

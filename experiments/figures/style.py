"""Common style and helpers of all figures."""

from __future__ import annotations

from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

import pandas as pd

from rmfs.errors import InputError
from rmfs.experiments.wording import axis_label as axis_label
from rmfs.files import replacing
from rmfs.measure.pictures import Picture

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from matplotlib.figure import Figure

COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#000000")
"""Colours that people with colour blindness can distinguish (Okabe and Ito)."""

FORMATS = ("png", "pdf", "svg")


def levels(frame: pd.DataFrame, factor: str) -> dict[str, pd.DataFrame]:
    """Return the rows of each level of a factor, with levels in the order of first appearance.

    Empty cells count as the level "none": their arms do not set the parameter.
    """
    text = frame[factor].astype(object).map(lambda level: "none" if pd.isna(level) else str(level))
    return {str(level): frame[text == level] for level in text.unique()}


@contextmanager
def saving(
    path: Path | None, width: float = 7.0, height: float = 4.3, *, note: str = "", **layout: Any
) -> Iterator[Figure]:
    """Yield a figure, and save it to a file if a path is given.

    Parameters
    ----------
    path
        A .png, .pdf or .svg file; equal figures give identical files. If None, no file is written.
    width, height
        Size of the figure, in inches.
    note
        A line below the figure. Default: none.

    Raises
    ------
    InputError
        If the suffix of the file is not .png, .pdf or .svg.
    """
    import matplotlib as mpl
    from matplotlib.backends.backend_agg import FigureCanvasAgg

    form = "" if path is None else path.suffix.lower().removeprefix(".")
    if path is not None and form not in FORMATS:
        raise InputError(f"{path}: unknown suffix; valid: .{', .'.join(FORMATS)}")
    with mpl.rc_context({"svg.hashsalt": "rmfs", "axes.grid": True, "grid.alpha": 0.3}):
        # not by pyplot: it would change the back end of who calls from a notebook
        figure = Picture(figsize=(width, height), layout="constrained", **layout)
        FigureCanvasAgg(figure)
        yield figure
        if note:
            figure.supxlabel(note, fontsize=8, color=COLOURS[1])
        if path is not None:
            # no date in the file: it would be another one each time
            metadata = {"png": {}, "pdf": {"CreationDate": None}, "svg": {"Date": None}}[form]
            with replacing(path) as temporary:
                figure.savefig(temporary, format=form, dpi=150, metadata=metadata)

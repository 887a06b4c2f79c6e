"""What all figures have in common."""

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
"""Told apart by people who see colours differently (Okabe and Ito)."""

FORMATS = ("png", "pdf", "svg")


def levels(frame: pd.DataFrame, factor: str) -> dict[str, pd.DataFrame]:
    """Return the rows of each level of a factor, in the order of their first appearance.

    Where a parameter stays as it is in the file, the level is called "none".
    """
    text = frame[factor].astype(object).map(lambda level: "none" if pd.isna(level) else str(level))
    return {str(level): frame[text == level] for level in text.unique()}


@contextmanager
def saving(
    path: Path | None, width: float = 7.0, height: float = 4.3, *, note: str = "", **layout: Any
) -> Iterator[Figure]:
    """Yield a figure, and save it if it is to be a file.

    Parameters
    ----------
    path
        A .png, .pdf or .svg file, the same content gives the same bytes; None for no file.
    width, height
        Inches.
    note
        A line below everything. Default none.

    Raises
    ------
    InputError
        If the file has another ending.
    """
    import matplotlib as mpl
    from matplotlib.backends.backend_agg import FigureCanvasAgg

    form = "" if path is None else path.suffix.lower().removeprefix(".")
    if path is not None and form not in FORMATS:
        raise InputError(f"{path}: unknown kind of picture; valid: .{', .'.join(FORMATS)}")
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

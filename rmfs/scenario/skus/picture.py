"""Plots of the popularity of SKUs."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.ticker import PercentFormatter

from rmfs.errors import InputError
from rmfs.files import replacing

if TYPE_CHECKING:
    from pathlib import Path

    from matplotlib.axes import Axes

    from rmfs.scenario.skus.sku_set import SkuSet

FORMATS = (".svg", ".png", ".pdf")


def draw_popularity(skus: SkuSet, ax: Axes, *, cumulative: bool = False) -> None:
    """Plot the share of demand of each SKU, the most popular SKU first.

    Parameters
    ----------
    ax
        Axes on which to plot.
    cumulative
        Whether to plot cumulative shares, from the most popular SKU on. A thin line then shows the
        case of equal popularity.
    """
    shares = np.sort(skus.by_popularity.probabilities)[::-1]
    rank = np.arange(1, len(shares) + 1) / len(shares)
    ax.set_xlabel("SKUs, the most popular first")
    ax.xaxis.set_major_formatter(PercentFormatter(1.0))
    ax.yaxis.set_major_formatter(PercentFormatter(1.0))
    ax.set_xlim(0, 1)
    if cumulative:
        ax.plot([0, 1], [0, 1], color="0.7", linewidth=0.8)
        ax.plot([0, *rank], [0, *np.cumsum(shares)], color="black")
        ax.set_ylabel("share of demand, cumulative")
    else:
        ax.step([0, *rank], [shares[0], *shares], where="pre", color="black")
        ax.set_ylabel("share of demand")
    ax.set_ylim(bottom=0)


def save_picture(skus: SkuSet, path: Path) -> None:
    """Save plots of the shares of demand and of the cumulative shares, side by side in one file.

    Raises
    ------
    InputError
        If the format is unknown or the file cannot be written.
    """
    suffix = path.suffix.lower()
    if suffix not in FORMATS:
        raise InputError(f"{path}: must end in {', '.join(FORMATS)}")
    figure = Figure(figsize=(9.0, 3.6), layout="constrained")
    FigureCanvasAgg(figure)
    simple, cumulative = figure.subplots(1, 2)
    draw_popularity(skus, simple)
    draw_popularity(skus, cumulative, cumulative=True)
    # without a date, equal SKUs give equal files
    date = {".png": None, ".svg": "Date", ".pdf": "CreationDate"}[suffix]
    with replacing(path) as temporary:
        figure.savefig(
            temporary, format=suffix[1:], dpi=150, metadata={date: None} if date else None
        )

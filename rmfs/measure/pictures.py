"""Plots of the results in a run folder, selected by name."""

from __future__ import annotations

import io
from typing import TYPE_CHECKING, Any

import matplotlib as mpl
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from rmfs.errors import InputError
from rmfs.files import replacing
from rmfs.measure import plots

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from rmfs.measure.results import Results

PICTURES: dict[str, tuple[str, Callable[..., None], str]] = {
    "progression": ("series", plots.progression, "Picked units and distance per hour"),
    "heat": ("heat", plots.heat, "Where robots drive"),
    "backlog": ("series", plots.backlog, "Backlogs and open orders"),
    "turnover": ("orders", plots.turnover, "Order turnover"),
    "delays": ("delays", plots.delays, "Where the time of orders goes"),
    "stations": ("stations", plots.stations, "Station utilisation"),
    "robots": ("series", plots.robots, "Robots by state"),
    "pile-on": ("visits", plots.pile_on, "Units per visit"),
    "warmup": ("series", plots.warmup, "Proposed warm-up"),
}
"""Table, function and title of each plot."""

ALIASES = {"throughput": "progression"}
"""Alternative names of plots."""

FORMATS = {"png": "Software", "svg": "Date", "pdf": "CreationDate"}
"""File suffixes, each with the metadata entry that is left out to keep files reproducible."""


class Picture(Figure):
    """A figure that notebooks display, whichever matplotlib back end is in use."""

    def _repr_png_(self) -> bytes:
        content = io.BytesIO()
        self.savefig(content, format="png", dpi=100)
        return content.getvalue()


def picture(run: Results, what: str) -> Figure:
    """Draw a plot of a run; the heat map has one subplot for each tier.

    Parameters
    ----------
    what
        A name in `PICTURES` or `ALIASES`. For the heat map, the name may be followed by a column of
        the table `heat`, for example `heat:loaded_visits` or `heat:pick_waiting_s`.

    Raises
    ------
    InputError
        If there is no such plot, or the run folder lacks the data for it.
    """
    name, _, column = ALIASES.get(what, what).partition(":")
    if name not in PICTURES or (column and name != "heat"):
        raise InputError(f"picture {what}: unknown; valid: {', '.join(PICTURES)}, heat:COLUMN")
    table, draw, title = PICTURES[name]
    frame = run.table(table)
    tiers = sorted(frame["tier"].unique()) if name == "heat" else [0]
    figure = Picture(figsize=(7.0, 4.0 * len(tiers)), layout="constrained")
    FigureCanvasAgg(figure)
    for place, tier in enumerate(tiers, start=1):
        ax = figure.add_subplot(len(tiers), 1, place)
        draw(frame, ax, **_more(run, name, tier, column))
        ax.set_title(title if len(tiers) == 1 else f"{title}, tier {tier}")
    return figure


def _more(run: Results, what: str, tier: int, column: str) -> dict[str, Any]:
    """Return what a plot needs besides its table."""
    if what == "heat":
        return {"tier": tier, **({"column": column} if column else {})}
    if what == "progression":
        return {"bound_per_h": float(run.footprint["units_per_h_bound"])}
    return {}


def save(run: Results, what: str, path: Path) -> None:
    """Save a plot as PNG, SVG or PDF; identical runs give identical files.

    Raises
    ------
    InputError
        If the suffix is not supported, there is no such plot, the run folder lacks the data for it,
        or the file cannot be written.
    """
    suffix = path.suffix.lower()[1:]
    if suffix not in FORMATS:
        raise InputError(f"{path}: supported formats: {', '.join(FORMATS)}")
    figure = picture(run, what)
    with replacing(path) as temporary, mpl.rc_context({"svg.hashsalt": "rmfs"}):
        figure.savefig(temporary, format=suffix, dpi=150, metadata={FORMATS[suffix]: None})

"""Draws a layout in the style of figure 4 of the RAWSim-O paper."""

from __future__ import annotations

from typing import TYPE_CHECKING

import matplotlib as mpl
import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.collections import LineCollection, PatchCollection
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Circle, Rectangle
from matplotlib.transforms import IdentityTransform, ScaledTranslation

from rmfs.errors import InputError
from rmfs.files import replacing
from rmfs.layout import colours
from rmfs.layout.graph import edge_sources

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence
    from pathlib import Path

    from matplotlib.axes import Axes
    from matplotlib.patches import Patch
    from numpy.typing import NDArray

    from rmfs.layout.model import Layout

    Points = NDArray[np.float64]
    Mask = NDArray[np.bool_]

FORMATS = (".svg", ".png", ".pdf")
TIER_GAP_M = 3.0
TICK_M = 10
STORAGE_SIDE = 0.8
"""Side of a storage square as a share of the distance between waypoints."""
ELEVATOR_SIDE = 0.9
ARROW_SHARE = 0.55
"""Length of an arrow as a share of the length of its edge."""
LARGEST_IN = (12.0, 9.0)
"""Maximum width and height in inches of the floor plan in a saved figure."""
LEGEND_IN = 0.45
"""Distance of the legend below the axes in inches."""


def draw(
    layout: Layout,
    ax: Axes,
    *,
    arrows: bool = False,
    pods: bool = True,
    robots: bool = True,
    legend: bool = True,
) -> None:
    """Draw a layout.

    Pick stations are red, replenishment stations yellow, elevators purple and robots green;
    stations of other kinds have their own colours. Storage locations are blue squares, dark where a
    pod stands. Queue zones have a dotted outline; the halls (the areas between the storage area and
    the queues) have a dashed outline. Tiers are drawn side by side.

    Parameters
    ----------
    ax
        Axes to draw on; coordinates are in m.
    arrows
        Whether to draw the direction of one-way edges.
    pods, robots
        Whether to show the pods and the robots, at their initial positions.
    legend
        Whether to add a legend of the colours and lines below the plan.
    """
    points = _points(layout)
    pitch_m = _pitch(layout)
    _roads(layout, ax, points)
    _storage(layout, ax, points, pitch_m, pods=pods)
    zone, hallway = layout.is_queue, _hallway(layout, pitch_m)
    ax.add_collection(_outline(points[zone], pitch_m, colours.QUEUE_ZONE, "dotted"))
    ax.add_collection(_outline(points[hallway], pitch_m, colours.HALLWAY, "dashed"))
    if arrows:
        _arrows(layout, ax, points)
    _stations(layout, ax, points, pitch_m)
    if robots:
        _robots(layout, ax, points)
    _frame(layout, ax, margin_m=pitch_m / 2)
    if legend:
        _legend(layout, ax)


def save_picture(layout: Layout, path: Path, *, arrows: bool = False) -> None:
    """Save a drawing of a layout as SVG, PNG or PDF; equal layouts result in identical files.

    Raises
    ------
    InputError
        If the suffix of `path` is not supported or the file cannot be written.
    """
    suffix = path.suffix.lower()
    if suffix not in FORMATS:
        raise InputError(f"{path}: supported formats: {', '.join(FORMATS)}")
    length_m = _offsets(layout)[-1] - TIER_GAP_M
    width_m = max(tier.width_m for tier in layout.tiers)
    scale = min(LARGEST_IN[0] / length_m, LARGEST_IN[1] / width_m)
    figure = Figure(figsize=(scale * length_m, scale * width_m))
    FigureCanvasAgg(figure)
    draw(layout, figure.add_subplot(), arrows=arrows)
    # a fixed salt and no date: the same layout gives the same file
    with replacing(path) as temporary, mpl.rc_context({"svg.hashsalt": "rmfs"}):
        dated = {".png": "Software", ".svg": "Date", ".pdf": "CreationDate"}[suffix]
        figure.savefig(
            temporary, format=suffix[1:], dpi=150, bbox_inches="tight", metadata={dated: None}
        )


def _offsets(layout: Layout) -> Points:
    """Return the x position of the west side of each tier, and of one more tier after the last."""
    lengths = np.array([tier.length_m for tier in layout.tiers])
    return np.concatenate([[0.0], np.cumsum(lengths + TIER_GAP_M)])


def _points(layout: Layout) -> Points:
    """Return the positions of the waypoints in the picture, shape (N, 2)."""
    return np.column_stack([layout.x_m + _offsets(layout)[layout.tier], layout.y_m])


def _pitch(layout: Layout) -> float:
    """Return the typical distance between neighbouring waypoints in m."""
    tails, heads = edge_sources(layout), layout.edge_target
    if not heads.size:
        return 1.0
    lengths = np.hypot(layout.x_m[tails] - layout.x_m[heads], layout.y_m[tails] - layout.y_m[heads])
    return float(np.median(lengths))


def _hallway(layout: Layout, pitch_m: float) -> Mask:
    """Return the road waypoints outside the storage area and its ring road."""
    hallway = ~layout.is_storage & ~layout.is_queue
    for tier in range(len(layout.tiers)):
        here = layout.tier == tier
        storage = here & layout.is_storage
        if not storage.any():
            continue
        inside = here.copy()
        for along in (layout.x_m, layout.y_m):
            low, high = along[storage].min(), along[storage].max()
            inside &= (along >= low - 1.5 * pitch_m) & (along <= high + 1.5 * pitch_m)
        hallway &= ~inside
    return hallway


def _roads(layout: Layout, ax: Axes, points: Points) -> None:
    """Draw the edges outside the storage blocks as thin lines."""
    tails, heads = edge_sources(layout), layout.edge_target
    road = ~layout.is_storage[tails] & ~layout.is_storage[heads]
    lines = np.stack([points[tails[road]], points[heads[road]]], axis=1)
    ax.add_collection(LineCollection(list(lines), colors=colours.ROAD, linewidths=0.5, zorder=1))


def _arrows(layout: Layout, ax: Axes, points: Points) -> None:
    """Draw an arrow in the middle of each one-way edge."""
    tails, heads = edge_sources(layout).astype(np.int64), layout.edge_target
    size = layout.waypoints
    one_way = ~np.isin(tails * size + heads, heads.astype(np.int64) * size + tails)
    start, end = points[tails[one_way]], points[heads[one_way]]
    along = (end - start) * ARROW_SHARE
    foot = (start + end - along) / 2
    ax.quiver(
        *(foot[:, 0], foot[:, 1], along[:, 0], along[:, 1]),
        angles="xy",
        scale_units="xy",
        scale=1,
        width=0.0012,
        headwidth=5,
        color=colours.ARROW,
        zorder=3,
    )


def _storage(layout: Layout, ax: Axes, points: Points, pitch_m: float, *, pods: bool) -> None:
    taken = np.zeros(layout.waypoints, dtype=np.bool_)
    taken[layout.pod_waypoint] = True
    shown = layout.is_storage & taken if pods else np.zeros_like(taken)
    side_m = STORAGE_SIDE * pitch_m
    for places, colour in (
        (layout.is_storage & ~shown, colours.FREE_STORAGE),
        (shown, colours.STORAGE),
    ):
        squares = [_square(point, side_m) for point in points[places]]
        ax.add_collection(
            PatchCollection(
                squares, facecolor=colour, edgecolor=colours.STORAGE, linewidth=0.5, zorder=2
            )
        )


def _stations(layout: Layout, ax: Axes, points: Points, pitch_m: float) -> None:
    for kind in {station.kind.name: station.kind for station in layout.stations}.values():
        own = [station for station in layout.stations if station.kind.name == kind.name]
        discs = [Circle(_xy(points[s.waypoint]), s.radius_m) for s in own]
        _add(ax, discs, kind.colour, zorder=5)
    boarding = [waypoint for elevator in layout.elevators for waypoint in elevator.waypoints]
    squares = [_square(points[waypoint], ELEVATOR_SIDE * pitch_m) for waypoint in boarding]
    _add(ax, squares, colours.ELEVATOR, zorder=5)


def _robots(layout: Layout, ax: Axes, points: Points) -> None:
    radii = np.array([kind.radius_m for kind in layout.robot_kinds])[layout.robot_kind]
    places = points[layout.robot_waypoint]
    discs = [Circle(_xy(place), radius) for place, radius in zip(places, radii, strict=True)]
    _add(ax, discs, colours.ROBOT, zorder=6)


def _add(ax: Axes, patches: Sequence[Patch], colour: str, *, zorder: float) -> None:
    ax.add_collection(
        PatchCollection(
            patches, facecolor=colour, edgecolor=colours.OUTLINE, linewidth=0.5, zorder=zorder
        )
    )


def _square(centre: Points, side_m: float) -> Patch:
    return Rectangle((float(centre[0]) - side_m / 2, float(centre[1]) - side_m / 2), side_m, side_m)


def _xy(point: Points) -> tuple[float, float]:
    return float(point[0]), float(point[1])


def _outline(places: Points, pitch_m: float, colour: str, style: str) -> LineCollection:
    """Return the border of the area covered by the cells around some waypoints."""
    cells = {(round(x / pitch_m * 2), round(y / pitch_m * 2)): (x, y) for x, y in places}
    half_m = pitch_m / 2
    lines = []
    for (column, row), (x, y) in cells.items():
        for right, up in ((1, 0), (-1, 0), (0, 1), (0, -1)):
            if (column + 2 * right, row + 2 * up) in cells:
                continue
            middle = np.array([x + right * half_m, y + up * half_m])
            reach = np.array([up, right]) * half_m
            lines.append([middle - reach, middle + reach])
    return LineCollection(lines, colors=colour, linestyles=style, linewidths=0.9, zorder=4)


def _frame(layout: Layout, ax: Axes, margin_m: float) -> None:
    """Draw the borders of the tiers and label the axes in metres, tier by tier."""
    offsets = _offsets(layout)
    several = len(layout.tiers) > 1
    ticks: list[float] = []
    labels: list[str] = []
    for number, tier in enumerate(layout.tiers):
        x_m = float(offsets[number])
        border = Rectangle((x_m, 0), tier.length_m, tier.width_m, fill=False, linewidth=0.8)
        border.set_edgecolor(colours.OUTLINE)
        ax.add_patch(border)
        marks = _marks(tier.length_m)
        ticks += [x_m + mark for mark in marks]
        labels += [f"{mark:g}" for mark in marks]
        if several:
            ax.text(
                x_m + tier.length_m / 2, tier.width_m, f"tier {number}", ha="center", va="bottom"
            )
    ax.set_xlim(-margin_m, float(offsets[-1]) - TIER_GAP_M + margin_m)
    ax.set_ylim(-margin_m, max(tier.width_m for tier in layout.tiers) + margin_m)
    ax.set_xticks(ticks, labels)
    ax.set_aspect("equal")
    ax.spines[:].set_visible(False)
    ax.set_xlabel("x (m)")
    ax.set_ylabel("y (m)")


def _marks(length_m: float) -> Iterable[float]:
    """Return tick positions along a tier."""
    step = TICK_M if length_m >= TICK_M else 1
    return [float(mark) for mark in range(0, int(length_m) + 1, step)]


def _legend(layout: Layout, ax: Axes) -> None:
    def mark(label: str, colour: str, shape: str) -> Line2D:
        return Line2D(
            *([], []),
            label=label,
            marker=shape,
            linestyle="none",
            markerfacecolor=colour,
            markeredgecolor=colours.OUTLINE,
        )

    entries = [
        mark("pick station", colours.PICK_STATION, "o"),
        mark("replenishment station", colours.REPLENISHMENT_STATION, "o"),
        mark("robot", colours.ROBOT, "o"),
        mark("pod", colours.STORAGE, "s"),
        mark("free storage location", colours.FREE_STORAGE, "s"),
        Line2D([], [], color=colours.QUEUE_ZONE, linestyle="dotted", label="queue zone"),
        Line2D([], [], color=colours.HALLWAY, linestyle="dashed", label="hall"),
    ]
    if layout.elevators:
        entries.insert(2, mark("elevator", colours.ELEVATOR, "s"))
    figure = ax.get_figure(root=True)
    below = (
        ScaledTranslation(0, -LEGEND_IN, figure.dpi_scale_trans) if figure else IdentityTransform()
    )
    ax.legend(
        handles=entries,
        loc="upper center",
        bbox_to_anchor=(0.5, 0.0),
        bbox_transform=ax.transAxes + below,
        ncols=4,
        frameon=False,
    )

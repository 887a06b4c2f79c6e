"""Guidance of a layout: extra costs that make robots avoid edges, and its file format."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Annotated, Any, Literal

import numpy as np
import pydantic

from rmfs.config import Model, validate
from rmfs.digest import digest
from rmfs.errors import InputError
from rmfs.files import read_bounded, write_text
from rmfs.layout.graph import edge_sources

if TYPE_CHECKING:
    from pathlib import Path

    from numpy.typing import NDArray

    from rmfs.layout.model import Layout

FORMAT = "rmfs-guidance/1"

MOST_EXTRA_S = 600.0
"""Maximum extra cost of an edge, in s."""

GuidedEdges = tuple[tuple[int, int, float], ...]
"""Edges with an extra cost: waypoints at their beginning and end, and the cost in s."""

_Waypoints = Annotated[list[Annotated[int, pydantic.Field(ge=0)]], pydantic.FailFast()]
_Extra = Annotated[float, pydantic.Field(ge=0, le=MOST_EXTRA_S, allow_inf_nan=False)]
_Extras = Annotated[list[_Extra], pydantic.FailFast()]


class _GuidanceFile(Model):
    """The keys of a file of guidance."""

    format: Literal["rmfs-guidance/1"]
    description: str = ""
    layout: str = ""
    waypoints: int
    edges: int
    graph: str
    origin: dict[str, Any] = pydantic.Field(default_factory=dict)
    from_: _Waypoints = pydantic.Field(alias="from")
    to: _Waypoints
    extra_s: _Extras


def graph_digest(layout: Layout) -> str:
    """Return a hash of the waypoint graph: positions, tiers and edges.

    Robots, pods and stations do not matter, so guidance can be used with any number of robots.
    """
    return digest((layout.x_m, layout.y_m, layout.tier, layout.edge_start, layout.edge_target))


def read_guidance(path: Path, layout: Layout) -> GuidedEdges:
    """Read the guidance of a layout from a file.

    Raises
    ------
    InputError
        If the file cannot be read, is invalid, belongs to another layout, names an edge twice, or
        names an edge that does not exist.
    """
    content = read_bounded(path)
    try:
        table = json.loads(content)
    except (ValueError, RecursionError) as error:
        raise InputError(f"{path}: not valid JSON: {error!s:.200}") from None
    if not isinstance(table, dict):
        raise InputError(f'{path}: expected an object with "format": "{FORMAT}"')
    given = validate(_GuidanceFile, table, str(path))
    graph = (layout.waypoints, len(layout.edge_target), graph_digest(layout))
    if (given.waypoints, given.edges, given.graph) != graph:
        raise InputError(
            f"{path}: is guidance for another layout ({given.layout or 'without name'}, "
            f"{given.waypoints} waypoints, {given.edges} edges, graph {given.graph:.12}); this "
            f"layout ({layout.name}) has {graph[0]} waypoints, {graph[1]} edges and graph "
            f"{graph[2]:.12}"
        )
    if not len(given.from_) == len(given.to) == len(given.extra_s):
        raise InputError(
            f"{path}: from, to and extra_s must have the same number of values (given: "
            f"{len(given.from_)}, {len(given.to)}, {len(given.extra_s)})"
        )
    known = set(zip(edge_sources(layout).tolist(), layout.edge_target.tolist(), strict=True))
    pairs = list(zip(given.from_, given.to, strict=True))
    for pair in pairs:
        if pair not in known:
            raise InputError(f"{path}: no edge of the layout leads from {pair[0]} to {pair[1]}")
    if len(set(pairs)) < len(pairs):
        twice = next(pair for pair in pairs if pairs.count(pair) > 1)
        raise InputError(f"{path}: the edge from {twice[0]} to {twice[1]} occurs twice")
    return tuple((*pair, extra) for pair, extra in zip(pairs, given.extra_s, strict=True))


def write_guidance(
    path: Path,
    layout: Layout,
    extra_s: NDArray[np.float64],
    *,
    description: str = "",
    origin: dict[str, Any] | None = None,
) -> None:
    """Write the guidance of a layout; reading it back gives the same costs, to the microsecond.

    Parameters
    ----------
    extra_s
        Extra cost of each edge in s, aligned with `layout.edge_target`, shape (M,).
    origin
        How the guidance was found.

    Raises
    ------
    InputError
        If the name does not end in .json, a cost is not between 0 and `MOST_EXTRA_S`, or the file
        cannot be written.
    """
    if path.suffix.lower() != ".json":
        raise InputError(f"{path}: must end in .json")
    content: dict[str, Any] = {
        "format": FORMAT,
        "description": description,
        "layout": layout.name,
        "waypoints": layout.waypoints,
        "edges": len(layout.edge_target),
        "graph": graph_digest(layout),
        "origin": origin or {},
    }
    edges = guided_edges(layout, extra_s)
    for key, column in zip(("from", "to", "extra_s"), range(3), strict=True):
        content[key] = [edge[column] for edge in edges]
    # a line per key
    lines = (f"  {json.dumps(key)}: {json.dumps(value)}" for key, value in content.items())
    write_text(path, "{\n" + ",\n".join(lines) + "\n}\n")


def guided_edges(layout: Layout, extra_s: NDArray[np.float64]) -> GuidedEdges:
    """Return the edges whose extra cost is at least a microsecond.

    Parameters
    ----------
    extra_s
        Extra cost of each edge in s, aligned with `layout.edge_target`, shape (M,).

    Raises
    ------
    InputError
        If the number of costs is wrong, or a cost is not between 0 and `MOST_EXTRA_S`.
    """
    extra_s = np.asarray(extra_s, dtype=np.float64)
    if extra_s.shape != layout.edge_target.shape:
        raise InputError(
            f"guidance: must have a cost for each of the {len(layout.edge_target)} edges "
            f"(given: {extra_s.size})"
        )
    if not ((extra_s >= 0) & (extra_s <= MOST_EXTRA_S)).all():
        raise InputError(f"guidance: extra costs must be between 0 and {MOST_EXTRA_S:g} s")
    rounded = np.round(extra_s, 6)
    some = np.flatnonzero(rounded)
    columns = edge_sources(layout)[some], layout.edge_target[some], rounded[some]
    return tuple(zip(*(column.tolist() for column in columns), strict=True))

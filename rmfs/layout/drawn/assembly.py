"""Builds the layout of a drawn floor."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from rmfs.errors import InputError
from rmfs.layout.drawn.drawing import Ground
from rmfs.layout.equipping import pick_stations, replenishment_stations
from rmfs.layout.generator.placement import draw_pods, draw_robots
from rmfs.layout.graph import compressed
from rmfs.layout.model import Layout, RobotKind, Tier

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from rmfs.layout.drawn.drawing import Drawing, Stand
    from rmfs.layout.drawn.parameters import Equipment

ROBOTS_PER_PICK_STATION = 4
"""Default number of robots per pick station."""


def assembled(drawing: Drawing, given: Equipment, name: str) -> Layout:
    """Return the layout of a drawn floor; waypoints are numbered row by row, the top row first.

    Parameters
    ----------
    given
        Parameters that the drawing does not contain, such as the number of robots.
    name
        Name of the layout, if `given` has none.

    Raises
    ------
    InputError
        If a required element is missing, or if the number of robots in `given` is smaller than the
        number drawn or larger than the number for which the aisles have room.
    """
    _refuse_incomplete(drawing)
    number = np.full(drawing.ground.shape, -1, dtype=np.int32)
    used = drawing.ground != Ground.NOTHING
    number[used] = np.arange(used.sum())
    rows, columns = np.nonzero(used)
    ground = drawing.ground[used]
    edges = ((int(number[tail]), int(number[head])) for tail, head in drawing.steps())
    edge_start, edge_target = compressed(len(rows), edges)
    pods = _pods(drawing, given, number)
    robots = _robots(drawing, given, number)
    height, width = drawing.ground.shape

    def stands(kind: str) -> list[tuple[tuple[int, ...], int]]:
        return _ranked([stand for stand in drawing.stands if stand.kind == kind], number)

    return Layout(
        name=given.name or name,
        tiers=(Tier(width * given.cell_m, height * given.cell_m),),
        x_m=(columns.astype(np.float64) + 0.5) * given.cell_m,
        y_m=(height - rows.astype(np.float64) - 0.5) * given.cell_m,
        tier=np.zeros(len(rows), dtype=np.int16),
        edge_start=edge_start,
        edge_target=edge_target,
        is_storage=ground == Ground.STORAGE,
        is_queue=ground == Ground.QUEUE,
        pick_stations=pick_stations(stands("pick"), given),
        replenishment_stations=replenishment_stations(stands("replenishment"), given),
        elevators=(),
        pod_waypoint=pods,
        pod_capacity=np.full(len(pods), given.pod_capacity),
        pod_radius_m=given.pod_radius_m,
        robot_waypoint=robots,
        robot_heading_rad=np.zeros(len(robots)),
        robot_kind=np.zeros(len(robots), dtype=np.int16),
        robot_kinds=(_robot_kind(given),),
    )


def _refuse_incomplete(drawing: Drawing) -> None:
    grounds = drawing.ground
    kinds = {stand.kind for stand in drawing.stands}
    lacking = [
        word
        for word, there in (
            ("aisle", (grounds == Ground.AISLE).any()),
            ("storage location", (grounds == Ground.STORAGE).any()),
            ("pick station", "pick" in kinds),
            ("replenishment station", "replenishment" in kinds),
        )
        if not there
    ]
    if lacking:
        raise InputError(f"the layout has no {', no '.join(lacking)}")


def _pods(drawing: Drawing, given: Equipment, number: NDArray[np.int32]) -> NDArray[np.int32]:
    full = [int(number[cell]) for cell in drawing.full]
    told = {*full, *(int(number[cell]) for cell in drawing.empty)}
    storage = number[drawing.ground == Ground.STORAGE]
    open_ones = np.array([place for place in storage.tolist() if place not in told], np.int32)
    drawn = draw_pods(open_ones, given.pod_share, given.seed, 0)
    return np.concatenate([np.array(full, np.int32), drawn])


def _robots(drawing: Drawing, given: Equipment, number: NDArray[np.int32]) -> NDArray[np.int32]:
    there = np.array([number[cell] for cell in drawing.robots], np.int32)
    aisles = number[drawing.ground == Ground.AISLE]
    room = np.setdiff1d(aisles, there)
    wanted = given.robots
    if wanted is None:
        picks = sum(stand.kind == "pick" for stand in drawing.stands)
        places = int((drawing.ground == Ground.STORAGE).sum())
        most = min(ROBOTS_PER_PICK_STATION * picks, places, len(room))
        wanted = len(there) or most
    if not len(there) <= wanted <= len(there) + len(room):
        raise InputError(
            f"robots: must be from {len(there)}, the number drawn, to {len(there) + len(room)}, "
            f"the number for which the aisles have room (given: {wanted})"
        )
    return np.concatenate([there, draw_robots(room, wanted - len(there), given.seed, 0)])


def _ranked(stands: list[Stand], number: NDArray[np.int32]) -> list[tuple[tuple[int, ...], int]]:
    """Return each station's queue and its activation rank: from the middle outwards."""
    middle = [(size - 1) / 2 for size in number.shape]

    def away(which: int) -> tuple[float, int]:
        row, column = stands[which].queue[0]
        return (row - middle[0]) ** 2 + (column - middle[1]) ** 2, which

    order = sorted(range(len(stands)), key=away)
    ranks = {which: rank for rank, which in enumerate(order, 1)}
    return [
        (tuple(int(number[cell]) for cell in stand.queue), ranks[which])
        for which, stand in enumerate(stands)
    ]


def _robot_kind(given: Equipment) -> RobotKind:
    return RobotKind(
        radius_m=given.robot_radius_m,
        acceleration_m_s2=given.acceleration_m_s2,
        deceleration_m_s2=given.deceleration_m_s2,
        top_speed_m_s=given.top_speed_m_s,
        full_turn_s=given.full_turn_s,
        pod_transfer_s=given.pod_transfer_s,
    )

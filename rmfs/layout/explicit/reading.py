"""Reads explicit layouts, that is, JSON files that list every waypoint and edge."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

import numpy as np

from rmfs.config import Table, validate
from rmfs.errors import InputError
from rmfs.files import read_bounded
from rmfs.layout.explicit.schema import FORMAT, ExplicitElevator, ExplicitLayout
from rmfs.layout.graph import compressed
from rmfs.layout.kinds import station_kind
from rmfs.layout.model import (
    Elevator,
    Layout,
    OtherStation,
    PickStation,
    ReplenishmentStation,
    RobotKind,
    Tier,
)
from rmfs.layout.problems import stop_if_any

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path


def read_json(path: Path) -> Layout:
    """Read an explicit layout.

    Raises
    ------
    InputError
        If the file is missing, not JSON, or not a valid layout; the message lists the errors.
    """
    return build(_parse(path), str(path), path.parent)


def build(table: Table, source: str, folder: Path | None = None) -> Layout:
    """Build a layout from the contents of an explicit layout file.

    Parameters
    ----------
    table
        The contents of the file, as parsed from JSON.
    source
        Name of the file, for messages.
    folder
        Folder that is searched, before the working directory, for Python files that define kinds of
        station. Default: only the working directory.

    Raises
    ------
    InputError
        If a value is wrong, or an index refers to an element that does not exist.
    """
    explicit = validate(ExplicitLayout, table, source)
    stop_if_any(list(_dangling(explicit)), source)
    try:
        others = tuple(_other_stations(explicit, folder))
    except InputError as error:
        raise InputError(f"{source}: {error}") from None
    return _layout(explicit, others)


def _parse(path: Path) -> Table:
    content = read_bounded(path)
    try:
        table = json.loads(content, object_pairs_hook=_once)
    except (ValueError, RecursionError) as error:
        raise InputError(f"{path}: not valid JSON: {error}") from None
    if not isinstance(table, dict):
        raise InputError(f'{path}: expected an object with "format": "{FORMAT}"')
    return table


def _once(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    """Refuse a key that occurs twice; plain JSON readers keep the last one silently."""
    table = dict(pairs)
    if len(table) < len(pairs):
        keys = [key for key, _ in pairs]
        twice = next(key for key in keys if keys.count(key) > 1)
        raise ValueError(f"key {twice} occurs twice in one object")
    return table


def _dangling(explicit: ExplicitLayout) -> Iterator[str]:
    """Yield every reference to an element that does not exist."""
    waypoints, tiers = explicit.waypoints, len(explicit.tiers)
    last = len(waypoints) - 1
    for v, waypoint in enumerate(waypoints):
        if waypoint.tier >= tiers:
            yield f"waypoints.{v}.tier: there is no tier {waypoint.tier}"
        for head in waypoint.to:
            if head > last:
                yield f"waypoints.{v}.to: there is no waypoint {head} (last: {last})"
            elif head == v:
                yield f"waypoints.{v}.to: must not contain the waypoint itself"
            elif waypoints[head].tier != waypoint.tier:
                yield f"waypoints.{v}.to: waypoint {head} is on another tier; use an elevator"
    for key, index in _references(explicit):
        if index > last:
            yield f"{key}: there is no waypoint {index} (last: {last})"
    kinds = len(explicit.robot_kinds)
    for r, robot in enumerate(explicit.robots):
        if robot.kind >= kinds:
            yield f"robots.{r}.kind: there is no robot kind {robot.kind}"
    for e, elevator in enumerate(explicit.elevators):
        boarding = {queue[0] for queue in elevator.queues}
        for i, ride in enumerate(elevator.rides):
            for key, end in (("origin", ride.origin), ("destination", ride.destination)):
                if end not in boarding:
                    yield (
                        f"elevators.{e}.rides.{i}.{key}: {end} is not the first waypoint of one "
                        "of its queues"
                    )


def _references(explicit: ExplicitLayout) -> Iterator[tuple[str, int]]:
    """Yield every waypoint that is referred to, except by edges."""
    for p, pod in enumerate(explicit.pods):
        yield f"pods.{p}.waypoint", pod.waypoint
    for r, robot in enumerate(explicit.robots):
        yield f"robots.{r}.waypoint", robot.waypoint
    for s, pick in enumerate(explicit.pick_stations):
        yield from ((f"pick_stations.{s}.queue", place) for place in pick.queue)
    for s, replenishment in enumerate(explicit.replenishment_stations):
        yield from ((f"replenishment_stations.{s}.queue", place) for place in replenishment.queue)
    for name, group in explicit.other_stations.items():
        for s, other in enumerate(group.stations):
            key = f"other_stations.{name}.stations.{s}.queue"
            yield from ((key, place) for place in other.queue)
    for e, elevator in enumerate(explicit.elevators):
        for queue in elevator.queues:
            yield from ((f"elevators.{e}.queues", place) for place in queue)


def _other_stations(explicit: ExplicitLayout, folder: Path | None) -> Iterator[OtherStation]:
    for name, given in explicit.other_stations.items():
        kind = station_kind(name, given.kind, given.parameters, folder)
        for station in given.stations:
            yield OtherStation(kind, station.queue[0], tuple(station.queue), station.radius_m)


def _layout(explicit: ExplicitLayout, others: tuple[OtherStation, ...]) -> Layout:
    waypoints = explicit.waypoints
    edges = ((v, head) for v, waypoint in enumerate(waypoints) for head in waypoint.to)
    edge_start, edge_target = compressed(len(waypoints), edges)
    elevators = tuple(_elevator(elevator) for elevator in explicit.elevators)
    pick_stations = tuple(
        PickStation(waypoint=s.queue[0], queue=tuple(s.queue), **s.model_dump(exclude={"queue"}))
        for s in explicit.pick_stations
    )
    replenishment_stations = tuple(
        ReplenishmentStation(
            waypoint=s.queue[0], queue=tuple(s.queue), **s.model_dump(exclude={"queue"})
        )
        for s in explicit.replenishment_stations
    )
    is_queue = np.array([waypoint.queue for waypoint in waypoints])
    for queue in (
        *(pick.queue for pick in pick_stations),
        *(replenishment.queue for replenishment in replenishment_stations),
        *(other.queue for other in others),
        *(queue for elevator in elevators for queue in elevator.queues.values()),
    ):
        is_queue[list(queue)] = True
    return Layout(
        name=explicit.name,
        tiers=tuple(Tier(**tier.model_dump()) for tier in explicit.tiers),
        x_m=np.array([waypoint.x_m for waypoint in waypoints], dtype=np.float64),
        y_m=np.array([waypoint.y_m for waypoint in waypoints], dtype=np.float64),
        tier=np.array([waypoint.tier for waypoint in waypoints], dtype=np.int16),
        edge_start=edge_start,
        edge_target=edge_target,
        is_storage=np.array([waypoint.storage for waypoint in waypoints]),
        is_queue=is_queue,
        pick_stations=pick_stations,
        replenishment_stations=replenishment_stations,
        other_stations=others,
        elevators=elevators,
        pod_waypoint=np.array([pod.waypoint for pod in explicit.pods], dtype=np.int32),
        pod_capacity=np.array([pod.capacity for pod in explicit.pods], dtype=np.float64),
        pod_radius_m=explicit.pod_radius_m,
        robot_waypoint=np.array([robot.waypoint for robot in explicit.robots], dtype=np.int32),
        robot_heading_rad=np.array([robot.heading_rad for robot in explicit.robots], np.float64),
        robot_kind=np.array([robot.kind for robot in explicit.robots], dtype=np.int16),
        robot_kinds=tuple(RobotKind(**kind.model_dump()) for kind in explicit.robot_kinds),
    )


def _elevator(explicit: ExplicitElevator) -> Elevator:
    return Elevator(
        waypoints=tuple(queue[0] for queue in explicit.queues),
        travel_s={(ride.origin, ride.destination): ride.travel_s for ride in explicit.rides},
        queues={queue[0]: tuple(queue) for queue in explicit.queues},
    )

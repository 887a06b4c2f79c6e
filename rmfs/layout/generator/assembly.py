"""Assembles the layout of the whole warehouse from the tiles of one tier.

All tiers have the same tiles; waypoints are numbered tier by tier and, within a tier, row by row.
"""

from __future__ import annotations

from itertools import permutations
from typing import TYPE_CHECKING

import numpy as np

from rmfs.layout.equipping import pick_stations, replenishment_stations
from rmfs.layout.generator.buffers import Buffer, buffer
from rmfs.layout.generator.compass import SIDES
from rmfs.layout.generator.placement import draw_pods, draw_robots
from rmfs.layout.generator.pockets import pockets
from rmfs.layout.generator.sites import sites
from rmfs.layout.generator.tiles import ROAD, Kind, tile_kinds
from rmfs.layout.generator.traffic_rules import TrafficRules
from rmfs.layout.graph import compressed
from rmfs.layout.kinds import station_kind
from rmfs.layout.model import (
    Elevator,
    Layout,
    OtherStation,
    RobotKind,
    Tier,
)

if TYPE_CHECKING:
    from pathlib import Path

    from rmfs.layout.parameters import LayoutParameters


class Assembly:
    """Collects the parts of a layout.

    Parameters
    ----------
    parameters
        Validated parameters of the layout.
    folder
        Folder that is searched, before the working directory, for Python files that define kinds of
        station. Default: only the working directory.
    """

    def __init__(self, parameters: LayoutParameters, folder: Path | None = None) -> None:
        self._parameters = parameters
        self._folder = folder
        self._kinds = tile_kinds(parameters)
        self._buffers = [
            buffer(parameters, site) for side in SIDES for site in sites(parameters, side)
        ]
        for zone in self._buffers:
            for tile in zone.tiles:
                self._kinds[tile] = Kind.BUFFER
        self._pockets = pockets(parameters, self._kinds)
        for pocket in self._pockets:
            self._kinds[pocket.tile] = Kind.BUFFER
        self._number = np.full(self._kinds.shape, -1, dtype=np.int32)
        self._used = self._kinds != Kind.NOTHING
        self._per_tier = int(self._used.sum())
        self._number[self._used] = np.arange(self._per_tier)
        rows, columns = np.nonzero(self._used)
        self._x_m, self._y_m = columns + 0.5, rows + 0.5

    def layout(self) -> Layout:
        """Return the finished layout."""
        parameters, tiers = self._parameters, range(self._parameters.tiers)
        kinds = self._kinds[self._used]
        edge_start, edge_target = compressed(self._per_tier * len(tiers), self._edges())
        storage = np.flatnonzero(kinds == Kind.STORAGE).astype(np.int32)
        road = np.flatnonzero(np.isin(kinds, ROAD)).astype(np.int32)
        pods = [
            draw_pods(storage, parameters.pod_share, parameters.seed, tier) + self._offset(tier)
            for tier in tiers
        ]
        robots = [
            draw_robots(road, parameters.robots, parameters.seed, tier) + self._offset(tier)
            for tier in tiers
        ]
        pod_waypoint, robot_waypoint = np.concatenate(pods), np.concatenate(robots)
        return Layout(
            name=parameters.name,
            tiers=tuple(self._tier(tier) for tier in tiers),
            x_m=np.tile(self._x_m, len(tiers)),
            y_m=np.tile(self._y_m, len(tiers)),
            tier=np.repeat(np.arange(len(tiers), dtype=np.int16), self._per_tier),
            edge_start=edge_start,
            edge_target=edge_target,
            is_storage=np.tile(kinds == Kind.STORAGE, len(tiers)),
            is_queue=np.tile(kinds == Kind.BUFFER, len(tiers)),
            pick_stations=pick_stations(self._ranked("pick"), self._parameters),
            replenishment_stations=replenishment_stations(
                self._ranked("replenishment"), self._parameters
            ),
            other_stations=self._other_stations(),
            elevators=self._elevators(),
            pod_waypoint=pod_waypoint,
            pod_capacity=np.full(len(pod_waypoint), parameters.pod_capacity),
            pod_radius_m=parameters.pod_radius_m,
            robot_waypoint=robot_waypoint,
            robot_heading_rad=np.zeros(len(robot_waypoint)),
            robot_kind=np.zeros(len(robot_waypoint), dtype=np.int16),
            robot_kinds=(_robot_kind(parameters),),
        )

    def _offset(self, tier: int) -> int:
        """Index of the first waypoint of a tier."""
        return tier * self._per_tier

    def _tier(self, tier: int) -> Tier:
        rows, columns = self._kinds.shape
        return Tier(float(columns), float(rows), tier * self._parameters.tier_height_m)

    def _edges(self) -> list[tuple[int, int]]:
        """Return the directed edges of all tiers, elevators excepted."""
        rules = TrafficRules(self._parameters, self._kinds)
        outside = np.argwhere(self._used & (self._kinds != Kind.BUFFER)).tolist()
        steps = [step for row, column in outside for step in rules.steps((row, column))]
        for zone in self._buffers:
            steps += [*zone.steps, *zone.entrances]
        for pocket in self._pockets:
            steps += [(pocket.tile, pocket.aisle), (pocket.aisle, pocket.tile)]
        number = self._number
        edges = [(int(number[tail]), int(number[head])) for tail, head in steps]
        offsets = [self._offset(tier) for tier in range(self._parameters.tiers)]
        return [(tail + offset, head + offset) for offset in offsets for tail, head in edges]

    def _ranked(self, kind: str) -> list[tuple[tuple[int, ...], int]]:
        """Return each station's queue and its activation rank, for one kind."""
        found = self._stations(kind)
        return [*zip(found, self._activation(found), strict=True)]

    def _other_stations(self) -> tuple[OtherStation, ...]:
        parameters = self._parameters
        return tuple(
            OtherStation(kind, queue[0], queue, parameters.station_radius_m)
            for name, given in parameters.other_stations.items()
            for kind in [station_kind(name, given.kind, given.parameters, self._folder)]
            for queue in (*self._stations(name), *self._within(name))
        )

    def _within(self, kind: str) -> list[tuple[int, ...]]:
        """Return the queues, of one place each, of the stations of a kind in the storage area."""
        tiles = [pocket.tile for pocket in self._pockets if pocket.kind == kind]
        tiers = range(self._parameters.tiers)
        return [(int(self._number[tile]) + self._offset(tier),) for tier in tiers for tile in tiles]

    def _stations(self, kind: str) -> list[tuple[int, ...]]:
        """Return the queues of the stations of a kind, tier by tier, side by side."""
        zones = [zone for zone in self._buffers if zone.site.kind == kind]
        return [self._queue(zone, tier) for tier in range(self._parameters.tiers) for zone in zones]

    def _queue(self, zone: Buffer, tier: int) -> tuple[int, ...]:
        return tuple(int(self._number[tile]) + self._offset(tier) for tile in zone.queue)

    def _activation(self, queues: list[tuple[int, ...]]) -> list[int]:
        """Rank stations by tier, then by distance from the middle of the tier, then by number."""
        middle = np.array(self._kinds.shape[::-1]) / 2
        places = np.array([divmod(queue[0], self._per_tier) for queue in queues]).reshape(-1, 2)
        tier, waypoint = places[:, 0], places[:, 1]
        away = (self._x_m[waypoint] - middle[0]) ** 2 + (self._y_m[waypoint] - middle[1]) ** 2
        ranks = np.empty(len(queues), dtype=np.int64)
        ranks[np.lexsort((np.arange(len(queues)), away, tier))] = np.arange(1, len(queues) + 1)
        return [int(rank) for rank in ranks]

    def _elevators(self) -> tuple[Elevator, ...]:
        zones = [zone for zone in self._buffers if zone.site.kind == "elevator"]
        return tuple(self._elevator(zone) for zone in zones)

    def _elevator(self, zone: Buffer) -> Elevator:
        """Connect the same place on all tiers by an elevator."""
        tiers = range(self._parameters.tiers)
        queues = [self._queue(zone, tier) for tier in tiers]
        waypoints = tuple(queue[0] for queue in queues)
        pace_s = self._parameters.elevator_s_per_tier
        travel_s = {
            (waypoints[a], waypoints[b]): abs(a - b) * pace_s for a, b in permutations(tiers, 2)
        }
        return Elevator(waypoints, travel_s, {queue[0]: queue for queue in queues})


def _robot_kind(parameters: LayoutParameters) -> RobotKind:
    return RobotKind(
        radius_m=parameters.robot_radius_m,
        acceleration_m_s2=parameters.acceleration_m_s2,
        deceleration_m_s2=parameters.deceleration_m_s2,
        top_speed_m_s=parameters.top_speed_m_s,
        full_turn_s=parameters.full_turn_s,
        pod_transfer_s=parameters.pod_transfer_s,
    )

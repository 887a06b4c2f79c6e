"""The layout: arrays of waypoints, pods and robots, and tuples of stations and elevators.

All of them are identified by index. Stations share one numbering: pick stations come first, then
replenishment stations, then those of all other kinds.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, ClassVar

from rmfs.digest import OMITTED
from rmfs.layout.kinds import PICK, REPLENISHMENT, StationKind

if TYPE_CHECKING:
    import networkx as nx  # type: ignore[import-untyped]
    import numpy as np
    from numpy.typing import NDArray


@dataclass(frozen=True, slots=True)
class Tier:
    """One floor.

    Attributes
    ----------
    length_m, width_m
        Extent in x and in y, in m.
    height_m
        Height of the floor above the ground in m, for drawing.
    """

    length_m: float
    width_m: float
    height_m: float = 0.0


@dataclass(frozen=True, slots=True)
class PickStation:
    """A station where units are picked from pods into orders.

    Attributes
    ----------
    waypoint
        Waypoint of the robot while its pod is served.
    queue
        Waiting places: `queue[0] == waypoint`, and the entrance is last.
    order_slots
        Maximum number of open orders.
    unit_transfer_s
        Time for which one unit occupies the station, in s.
    unit_pick_s
        Time for which one unit occupies the robot, in s.
    activation
        Rank of the station, from 1, in the sequence in which stations of its kind are switched on.
    """

    kind: ClassVar[StationKind] = PICK

    waypoint: int
    queue: tuple[int, ...]
    radius_m: float
    order_slots: int
    unit_transfer_s: float
    unit_pick_s: float
    activation: int


@dataclass(frozen=True, slots=True)
class ReplenishmentStation:
    """A station where bundles are put into pods.

    Attributes
    ----------
    capacity
        Maximum total size of the bundles assigned to the station at any time, in space units.
    bundle_transfer_s
        Time for which one bundle occupies both station and robot, in s.
    """

    kind: ClassVar[StationKind] = REPLENISHMENT

    waypoint: int
    queue: tuple[int, ...]
    radius_m: float
    capacity: float
    bundle_transfer_s: float
    activation: int


@dataclass(frozen=True, slots=True)
class OtherStation:
    """A station neither for picking nor for replenishment; its kind defines its service."""

    kind: StationKind
    waypoint: int
    queue: tuple[int, ...]
    radius_m: float


@dataclass(frozen=True, slots=True)
class Elevator:
    """An elevator, which carries one robot at a time.

    Attributes
    ----------
    waypoints
        Waypoints where robots board and leave, one on each tier that the elevator serves.
    travel_s
        Duration of the ride in s, by origin and destination, which are two of these waypoints.
    queues
        Waiting places by boarding waypoint, nearest first; the first is the waypoint itself.
    """

    waypoints: tuple[int, ...]
    travel_s: dict[tuple[int, int], float]
    queues: dict[int, tuple[int, ...]]


@dataclass(frozen=True, slots=True)
class RobotKind:
    """Size and motion of a robot.

    Attributes
    ----------
    full_turn_s
        Seconds for a turn of 360 degrees on the spot.
    pod_transfer_s
        Seconds to lift or to set down a pod.
    """

    radius_m: float
    acceleration_m_s2: float
    deceleration_m_s2: float
    top_speed_m_s: float
    full_turn_s: float
    pod_transfer_s: float


@dataclass(frozen=True, slots=True)
class Layout:
    """A warehouse before a run.

    Attributes
    ----------
    x_m, y_m
        Positions of the N waypoints in m, shape (N,).
    tier
        Tier index of each waypoint, shape (N,).
    edge_start
        CSR offsets, shape (N + 1,): the waypoints reached directly from v are
        `edge_target[edge_start[v]:edge_start[v + 1]]`, ascending. Edges between tiers are not
        here but in `elevators`.
    edge_target
        Heads of the directed edges, shape (M,).
    is_storage
        Whether each waypoint is a storage location, shape (N,).
    is_queue
        Whether each waypoint belongs to a queue zone, including the way out, shape (N,).
    pod_waypoint
        Initial waypoint of each of the P pods, shape (P,).
    pod_capacity
        Capacity of each pod in space units, shape (P,).
    pod_radius_m
        Radius of the pods in m (the largest, if they differ).
    robot_waypoint
        Initial waypoint of each of the R robots, shape (R,).
    robot_heading_rad
        Initial heading of each robot in rad, 0 = +x, growing towards +y, shape (R,).
    robot_kind
        Index of the kind of each robot in `robot_kinds`, shape (R,).
    """

    name: str
    tiers: tuple[Tier, ...]
    x_m: NDArray[np.float64]
    y_m: NDArray[np.float64]
    tier: NDArray[np.int16]
    edge_start: NDArray[np.int32]
    edge_target: NDArray[np.int32]
    is_storage: NDArray[np.bool_]
    is_queue: NDArray[np.bool_]
    pick_stations: tuple[PickStation, ...]
    replenishment_stations: tuple[ReplenishmentStation, ...]
    elevators: tuple[Elevator, ...]
    pod_waypoint: NDArray[np.int32]
    pod_capacity: NDArray[np.float64]
    pod_radius_m: float
    robot_waypoint: NDArray[np.int32]
    robot_heading_rad: NDArray[np.float64]
    robot_kind: NDArray[np.int16]
    robot_kinds: tuple[RobotKind, ...]
    other_stations: tuple[OtherStation, ...] = field(default=(), metadata={OMITTED: True})

    @property
    def stations(self) -> tuple[PickStation | ReplenishmentStation | OtherStation, ...]:
        """All stations in the order of their common numbering: pick stations first."""
        return (*self.pick_stations, *self.replenishment_stations, *self.other_stations)

    @property
    def other_kinds(self) -> tuple[StationKind, ...]:
        """The kinds of the stations in `other_stations`, each once, in order of occurrence."""
        return tuple({station.kind.name: station.kind for station in self.other_stations}.values())

    @property
    def waypoints(self) -> int:
        """Number of waypoints."""
        return len(self.x_m)

    @property
    def pods(self) -> int:
        """Number of pods."""
        return len(self.pod_waypoint)

    @property
    def robots(self) -> int:
        """Number of robots."""
        return len(self.robot_waypoint)

    def to_networkx(self) -> nx.DiGraph[int]:
        """Return waypoints and edges as a graph of networkx; see `networkx_graph.to_networkx`."""
        from rmfs.layout.networkx_graph import to_networkx

        return to_networkx(self)

"""The layout: arrays of waypoints, pods and robots, and tuples of stations and elevators.

Waypoints, pods, robots, stations and elevators are identified by their indices. All stations share
one numbering: pick stations come first, then replenishment stations, then those of other kinds.
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
    """A station where units are picked from pods for orders.

    Attributes
    ----------
    waypoint
        Waypoint at which a robot stands while its pod is served.
    queue
        Waypoints of the queue: the first is `waypoint`, and the last is the entrance.
    order_slots
        Maximum number of open orders.
    unit_transfer_s
        Time for which one unit occupies the station, in s.
    unit_pick_s
        Time for which one unit occupies the robot, in s.
    activation
        Position of the station, from 1, in the order in which the stations of its kind are
        activated.
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
    """A station of any other kind, which is neither for picking nor for replenishment."""

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
        Duration of each ride in s. The keys are pairs of origin and destination, both from
        `waypoints`.
    queues
        For each waypoint in `waypoints`, the waypoints at which robots wait for the elevator,
        nearest first; the first is the boarding waypoint itself.
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
        Duration of a turn of 360 degrees on the spot, in s.
    pod_transfer_s
        Duration of lifting or setting down a pod, in s.
    """

    radius_m: float
    acceleration_m_s2: float
    deceleration_m_s2: float
    top_speed_m_s: float
    full_turn_s: float
    pod_transfer_s: float


@dataclass(frozen=True, slots=True)
class Layout:
    """A warehouse in its state before a run.

    Attributes
    ----------
    x_m, y_m
        Positions of the N waypoints in m, shape (N,).
    tier
        Tier index of each waypoint, shape (N,).
    edge_start
        Offsets into `edge_target` (compressed sparse rows, CSR), shape (N + 1,). The edges from
        waypoint v lead to `edge_target[edge_start[v]:edge_start[v + 1]]`, in ascending order.
        Elevator rides are not among these edges; they are in `elevators`.
    edge_target
        Heads of the M directed edges, shape (M,).
    is_storage
        Whether each waypoint is a storage location, shape (N,).
    is_queue
        Whether each waypoint belongs to a queue zone (a queue or the path out of it), shape (N,).
    pod_waypoint
        Initial waypoint of each of the P pods, shape (P,).
    pod_capacity
        Capacity of each pod in space units, shape (P,).
    pod_radius_m
        Radius of the pods in m (the largest, if they differ).
    robot_waypoint
        Initial waypoint of each of the R robots, shape (R,).
    robot_heading_rad
        Initial heading of each robot in rad, shape (R,): 0 is the direction +x, pi / 2 is +y.
    robot_kind
        Kind of each robot, as an index into `robot_kinds`, shape (R,).
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
        """All stations in order of their numbers: first pick, then replenishment, then others."""
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
        """Return waypoints and edges as a networkx graph; see `networkx_graph.to_networkx`."""
        from rmfs.layout.networkx_graph import to_networkx

        return to_networkx(self)

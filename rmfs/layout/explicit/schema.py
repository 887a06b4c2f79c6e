"""The content of a `rmfs-layout-explicit/1` file.

Elements are named by their position in their list, counted from 0.
"""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import Field

from rmfs.layout.values import Count, Index, Positive, Strict

FORMAT = "rmfs-layout-explicit/1"


class ExplicitTier(Strict):
    """A floor: extent in x and y and height above the ground, in m."""

    length_m: Positive
    width_m: Positive
    height_m: float = 0.0


class ExplicitWaypoint(Strict):
    """A waypoint, and the waypoints of its tier that are reached directly from it."""

    x_m: float
    y_m: float
    tier: Index = 0
    to: list[Index] = Field(default_factory=list)
    storage: bool = False
    queue: bool = False


class ExplicitPickStation(Strict):
    """A pick station; `queue` lists its waiting places from the station to the entrance."""

    queue: list[Index] = Field(min_length=1)
    radius_m: Positive
    order_slots: Count
    unit_transfer_s: Positive
    unit_pick_s: Positive
    activation: Count


class ExplicitReplenishmentStation(Strict):
    """A replenishment station; `queue` as for pick stations."""

    queue: list[Index] = Field(min_length=1)
    radius_m: Positive
    capacity: Positive
    bundle_transfer_s: Positive
    activation: Count


class ExplicitOtherStation(Strict):
    """A station of another kind; `queue` as for pick stations."""

    queue: list[Index] = Field(min_length=1)
    radius_m: Positive


class ExplicitOtherStations(Strict):
    """All stations of another kind: its class, what is set of it, and where they are."""

    kind: str
    parameters: dict[str, Any] = Field(default_factory=dict)
    stations: list[ExplicitOtherStation]


class ExplicitRide(Strict):
    """Seconds from one boarding waypoint of an elevator to another."""

    origin: Index
    destination: Index
    travel_s: Positive


class ExplicitElevator(Strict):
    """An elevator; one queue per tier, each beginning with its boarding waypoint."""

    queues: list[Annotated[list[Index], Field(min_length=1)]] = Field(min_length=2)
    rides: list[ExplicitRide]


class ExplicitRobotKind(Strict):
    """Size and motion of robots."""

    radius_m: Positive
    acceleration_m_s2: Positive
    deceleration_m_s2: Positive
    top_speed_m_s: Positive
    full_turn_s: Positive
    pod_transfer_s: Positive


class ExplicitPod(Strict):
    """A pod and where it stands at the start."""

    waypoint: Index
    capacity: Positive


class ExplicitRobot(Strict):
    """A robot and where it stands at the start."""

    waypoint: Index
    heading_rad: float = 0.0
    kind: Index = 0


class ExplicitLayout(Strict):
    """The content of a `rmfs-layout-explicit/1` file."""

    format: Literal["rmfs-layout-explicit/1"]
    name: str = Field(min_length=1)
    tiers: list[ExplicitTier] = Field(min_length=1)
    pod_radius_m: Positive
    robot_kinds: list[ExplicitRobotKind] = Field(min_length=1)
    pick_stations: list[ExplicitPickStation] = Field(default_factory=list)
    replenishment_stations: list[ExplicitReplenishmentStation] = Field(default_factory=list)
    other_stations: dict[str, ExplicitOtherStations] = Field(default_factory=dict)
    elevators: list[ExplicitElevator] = Field(default_factory=list)
    robots: list[ExplicitRobot] = Field(default_factory=list)
    pods: list[ExplicitPod] = Field(default_factory=list)
    waypoints: list[ExplicitWaypoint] = Field(min_length=1)

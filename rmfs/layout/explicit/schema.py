"""The content of a `rmfs-layout-explicit/1` file.

Elements are named by their position in their list, counted from 0.
"""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import Field

from rmfs.layout.values import Count, Index, Positive, Rate, Seconds, Some, Space, Strict

FORMAT = "rmfs-layout-explicit/1"


class ExplicitTier(Strict):
    """A floor: extent in x and y and height above the ground, in m."""

    length_m: Positive = Field(description="extent in x, in m")
    width_m: Positive = Field(description="extent in y, in m")
    height_m: float = Field(0.0, description="m above the ground, for drawing only")


class ExplicitWaypoint(Strict):
    """A waypoint, and the waypoints of its tier that are reached directly from it."""

    x_m: float = Field(description="position in m, to the right")
    y_m: float = Field(description="position in m, upwards")
    tier: Index = Field(0, description="its tier")
    to: list[Index] = Field(
        default_factory=list, description="waypoints to which an edge leads from it, one-way"
    )
    storage: bool = Field(False, description="whether a pod may be stored there")
    queue: bool = Field(
        False,
        description="whether it belongs to a queue without being a place of it, such as its exit; "
        "places of queues need not be told again",
    )


class ExplicitPickStation(Strict):
    """A pick station; `queue` lists its waiting places from the station to the entrance."""

    queue: list[Index] = Field(
        min_length=1, description="waypoints from the station to the entrance of its queue"
    )
    radius_m: Positive = Field(description="m")
    order_slots: Some = Field(description="orders open at once")
    unit_transfer_s: Seconds = Field(description="s one picked unit keeps the station busy")
    unit_pick_s: Seconds = Field(description="s one picked unit keeps the robot")
    activation: Count = Field(description="rank in which stations are switched on")


class ExplicitReplenishmentStation(Strict):
    """A replenishment station; `queue` as for pick stations."""

    queue: list[Index] = Field(
        min_length=1, description="waypoints from the station to the entrance of its queue"
    )
    radius_m: Positive = Field(description="m")
    capacity: Space = Field(description="space units of bundles assigned at once")
    bundle_transfer_s: Seconds = Field(description="s one bundle keeps robot and station")
    activation: Count = Field(description="rank in which stations are switched on")


class ExplicitOtherStation(Strict):
    """A station of another kind; `queue` as for pick stations."""

    queue: list[Index] = Field(
        min_length=1, description="waypoints from the station to the entrance of its queue"
    )
    radius_m: Positive = Field(description="m")


class ExplicitOtherStations(Strict):
    """All stations of another kind: its class, what is set of it, and where they are."""

    kind: str = Field(description="its class: module:Class, path/to/file.py:Class, or a name")
    parameters: dict[str, Any] = Field(default_factory=dict, description="those of the class")
    stations: list[ExplicitOtherStation] = Field(description="where they are")


class ExplicitRide(Strict):
    """Seconds from one boarding waypoint of an elevator to another."""

    origin: Index = Field(description="boarding waypoint")
    destination: Index = Field(description="boarding waypoint on another tier")
    travel_s: Seconds = Field(description="s of the ride")


class ExplicitElevator(Strict):
    """An elevator; one queue per tier, each beginning with its boarding waypoint."""

    queues: list[Annotated[list[Index], Field(min_length=1)]] = Field(
        min_length=2, description="per tier, waypoints from the boarding one to the entrance"
    )
    rides: list[ExplicitRide] = Field(description="how long each ride takes")


class ExplicitRobotKind(Strict):
    """Size and motion of robots."""

    radius_m: Positive = Field(description="m")
    acceleration_m_s2: Rate = Field(description="m/s2")
    deceleration_m_s2: Rate = Field(description="m/s2")
    top_speed_m_s: Rate = Field(description="m/s")
    full_turn_s: Seconds = Field(description="s for a turn of 360 degrees on the spot")
    pod_transfer_s: Seconds = Field(description="s to lift or to set down a pod")


class ExplicitPod(Strict):
    """A pod and where it stands at the start."""

    waypoint: Index = Field(description="a storage place")
    capacity: Space = Field(description="space units")


class ExplicitRobot(Strict):
    """A robot and where it stands at the start."""

    waypoint: Index = Field(description="where it stands")
    heading_rad: float = Field(0.0, description="0 is towards x, growing towards y")
    kind: Index = Field(0, description="its robot kind")


class ExplicitLayout(Strict):
    """The content of a `rmfs-layout-explicit/1` file."""

    format: Literal["rmfs-layout-explicit/1"] = Field(description="version of this format")
    name: str = Field(min_length=1, description="name shown in results")
    tiers: list[ExplicitTier] = Field(min_length=1, description="floors")
    pod_radius_m: Positive = Field(description="m; the largest, if they differ")
    robot_kinds: list[ExplicitRobotKind] = Field(
        min_length=1, description="what kinds of robots there are"
    )
    pick_stations: list[ExplicitPickStation] = Field(
        default_factory=list, description="stations where units are picked"
    )
    replenishment_stations: list[ExplicitReplenishmentStation] = Field(
        default_factory=list, description="stations where bundles are stored"
    )
    other_stations: dict[str, ExplicitOtherStations] = Field(
        default_factory=dict, description="stations of further kinds, by name of the kind"
    )
    elevators: list[ExplicitElevator] = Field(
        default_factory=list, description="lifts between tiers"
    )
    robots: list[ExplicitRobot] = Field(default_factory=list, description="robots at the start")
    pods: list[ExplicitPod] = Field(default_factory=list, description="pods at the start")
    waypoints: list[ExplicitWaypoint] = Field(
        min_length=1, description="all places, numbered from 0 in this order"
    )

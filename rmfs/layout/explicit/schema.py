"""The contents of a `rmfs-layout-explicit/1` file.

Elements are identified by their position in their list, counted from 0.
"""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import Field

from rmfs.layout.values import Count, Index, Positive, Rate, Seconds, Some, Space, Strict

FORMAT = "rmfs-layout-explicit/1"


class ExplicitTier(Strict):
    """Size of a floor, and its height above the ground."""

    length_m: Positive = Field(description="extent in x, in m")
    width_m: Positive = Field(description="extent in y, in m")
    height_m: float = Field(0.0, description="height above the ground in m, for drawing only")


class ExplicitWaypoint(Strict):
    """A waypoint, and the waypoints of its tier that can be reached directly from it."""

    x_m: float = Field(description="x coordinate in m; x increases to the right")
    y_m: float = Field(description="y coordinate in m; y increases upwards")
    tier: Index = Field(0, description="index of the waypoint's tier")
    to: list[Index] = Field(
        default_factory=list, description="waypoints to which an edge leads from this waypoint"
    )
    storage: bool = Field(False, description="whether a pod may be stored here")
    queue: bool = Field(
        False,
        description="whether the waypoint belongs to a queue zone; needed only for waypoints on "
        "the way out, since the places of a queue always belong to its zone",
    )


class ExplicitPickStation(Strict):
    """A pick station with its queue."""

    queue: list[Index] = Field(
        min_length=1,
        description="waypoints of the queue, from the station (included) to the entrance",
    )
    radius_m: Positive = Field(description="radius of the station, m")
    order_slots: Some = Field(description="maximum number of open orders")
    unit_transfer_s: Seconds = Field(
        description="time in s for which a unit keeps the station busy"
    )
    unit_pick_s: Seconds = Field(
        description="time in s for which a unit keeps the robot at the station"
    )
    activation: Count = Field(
        description="rank of the station, counted from 1, in the order in which the stations of "
        "its kind are switched on"
    )


class ExplicitReplenishmentStation(Strict):
    """A replenishment station with its queue."""

    queue: list[Index] = Field(
        min_length=1,
        description="waypoints of the queue, from the station (included) to the entrance",
    )
    radius_m: Positive = Field(description="radius of the station, m")
    capacity: Space = Field(
        description="maximum total size, in space units, of the bundles assigned to the station "
        "at any time"
    )
    bundle_transfer_s: Seconds = Field(
        description="time in s for which a bundle keeps the station and the robot busy"
    )
    activation: Count = Field(
        description="rank of the station, counted from 1, in the order in which the stations of "
        "its kind are switched on"
    )


class ExplicitOtherStation(Strict):
    """A station of another kind, with its queue."""

    queue: list[Index] = Field(
        min_length=1,
        description="waypoints of the queue, from the station (included) to the entrance",
    )
    radius_m: Positive = Field(description="radius of the station, m")


class ExplicitOtherStations(Strict):
    """The stations of one further kind, and the class that defines this kind."""

    kind: str = Field(
        description="class of the stations, as `module:Class`, `path/to/file.py:Class` or a "
        "registered name such as `charger`"
    )
    parameters: dict[str, Any] = Field(default_factory=dict, description="parameters of this class")
    stations: list[ExplicitOtherStation] = Field(description="stations of this kind")


class ExplicitRide(Strict):
    """An elevator ride from one boarding waypoint to another."""

    origin: Index = Field(description="boarding waypoint at which the ride begins")
    destination: Index = Field(
        description="boarding waypoint on another tier, at which the ride ends"
    )
    travel_s: Seconds = Field(description="duration of the ride in s")


class ExplicitElevator(Strict):
    """An elevator: its rides, and its queue on each tier that it serves."""

    queues: list[Annotated[list[Index], Field(min_length=1)]] = Field(
        min_length=2,
        description="for each tier that the elevator serves, the waypoints of its queue, from "
        "the boarding waypoint (included) to the entrance",
    )
    rides: list[ExplicitRide] = Field(description="possible rides, with their durations")


class ExplicitRobotKind(Strict):
    """A kind of robot: its size, speeds and times."""

    radius_m: Positive = Field(description="radius of a robot, m")
    acceleration_m_s2: Rate = Field(description="acceleration, m/s2")
    deceleration_m_s2: Rate = Field(description="deceleration, m/s2")
    top_speed_m_s: Rate = Field(description="top speed, m/s")
    full_turn_s: Seconds = Field(description="duration of a turn of 360 degrees on the spot, s")
    pod_transfer_s: Seconds = Field(description="duration of lifting or setting down a pod, s")


class ExplicitPod(Strict):
    """A pod, and where it is at the start."""

    waypoint: Index = Field(description="storage location of the pod")
    capacity: Space = Field(description="capacity in space units")


class ExplicitRobot(Strict):
    """A robot, and where it is at the start."""

    waypoint: Index = Field(description="waypoint of the robot")
    heading_rad: float = Field(
        0.0,
        description="heading in rad: 0 is the +x direction, and positive angles turn towards +y",
    )
    kind: Index = Field(0, description="index of the robot's kind in `robot_kinds`")


class ExplicitLayout(Strict):
    """The contents of a `rmfs-layout-explicit/1` file."""

    format: Literal["rmfs-layout-explicit/1"] = Field(description="version of this format")
    name: str = Field(min_length=1, description="name shown in results")
    tiers: list[ExplicitTier] = Field(min_length=1, description="floors")
    pod_radius_m: Positive = Field(
        description="radius of a pod in m; if pods differ, the largest radius"
    )
    robot_kinds: list[ExplicitRobotKind] = Field(min_length=1, description="kinds of robots")
    pick_stations: list[ExplicitPickStation] = Field(
        default_factory=list, description="stations at which units are picked"
    )
    replenishment_stations: list[ExplicitReplenishmentStation] = Field(
        default_factory=list, description="stations at which bundles are put into pods"
    )
    other_stations: dict[str, ExplicitOtherStations] = Field(
        default_factory=dict, description="stations of other kinds, by name of the kind"
    )
    elevators: list[ExplicitElevator] = Field(
        default_factory=list, description="elevators between tiers"
    )
    robots: list[ExplicitRobot] = Field(default_factory=list, description="robots at the start")
    pods: list[ExplicitPod] = Field(default_factory=list, description="pods at the start")
    waypoints: list[ExplicitWaypoint] = Field(
        min_length=1, description="all waypoints, numbered from 0 in this order"
    )

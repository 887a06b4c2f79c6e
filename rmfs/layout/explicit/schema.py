"""The contents of a `rmfs-layout-explicit/1` file.

Elements are identified by their position in their list, counted from 0.
"""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import Field

from rmfs.layout.values import Count, Index, Positive, Rate, Seconds, Some, Space, Strict

FORMAT = "rmfs-layout-explicit/1"


class ExplicitTier(Strict):
    """A floor: its extents in x and y, and its height above the ground, in m."""

    length_m: Positive = Field(description="extent in x, in m")
    width_m: Positive = Field(description="extent in y, in m")
    height_m: float = Field(0.0, description="height above the ground in m, for drawing only")


class ExplicitWaypoint(Strict):
    """A waypoint, and the waypoints of its tier that can be reached directly from it."""

    x_m: float = Field(description="position in m, to the right")
    y_m: float = Field(description="position in m, upwards")
    tier: Index = Field(0, description="tier of the waypoint")
    to: list[Index] = Field(
        default_factory=list, description="waypoints to which directed edges lead"
    )
    storage: bool = Field(False, description="whether a pod may be stored there")
    queue: bool = Field(
        False,
        description="whether it belongs to a queue zone (the places of a queue and the way out) "
        "without being a place of the queue; queue places need not be marked",
    )


class ExplicitPickStation(Strict):
    """A pick station; `queue` lists the waypoints of its queue, from station to entrance."""

    queue: list[Index] = Field(
        min_length=1, description="waypoints from the station to the entrance of its queue"
    )
    radius_m: Positive = Field(description="radius of the station, m")
    order_slots: Some = Field(description="maximum number of open orders")
    unit_transfer_s: Seconds = Field(description="time in s for which a unit occupies the station")
    unit_pick_s: Seconds = Field(description="time in s for which a unit occupies the robot")
    activation: Count = Field(
        description="rank of the station, from 1, in the sequence in which stations of its kind "
        "are switched on"
    )


class ExplicitReplenishmentStation(Strict):
    """A replenishment station; `queue` as for pick stations."""

    queue: list[Index] = Field(
        min_length=1, description="waypoints from the station to the entrance of its queue"
    )
    radius_m: Positive = Field(description="radius of the station, m")
    capacity: Space = Field(
        description="maximum total size, in space units, of the bundles assigned to the station "
        "at any time"
    )
    bundle_transfer_s: Seconds = Field(
        description="time in s for which a bundle occupies robot and station"
    )
    activation: Count = Field(
        description="rank of the station, from 1, in the sequence in which stations of its kind "
        "are switched on"
    )


class ExplicitOtherStation(Strict):
    """A station neither for picking nor for replenishment; `queue` as for pick stations."""

    queue: list[Index] = Field(
        min_length=1, description="waypoints from the station to the entrance of its queue"
    )
    radius_m: Positive = Field(description="radius of the station, m")


class ExplicitOtherStations(Strict):
    """A kind of station other than pick and replenishment: class, parameters and stations."""

    kind: str = Field(
        description="class of the stations, as `module:Class`, `path/to/file.py:Class` or a "
        "registered name such as `charger`"
    )
    parameters: dict[str, Any] = Field(default_factory=dict, description="parameters of the class")
    stations: list[ExplicitOtherStation] = Field(description="the stations")


class ExplicitRide(Strict):
    """An elevator ride from one boarding waypoint to another."""

    origin: Index = Field(description="boarding waypoint")
    destination: Index = Field(description="boarding waypoint on another tier")
    travel_s: Seconds = Field(description="duration of the ride in s")


class ExplicitElevator(Strict):
    """An elevator; on each tier that it serves, a queue that begins with the boarding waypoint."""

    queues: list[Annotated[list[Index], Field(min_length=1)]] = Field(
        min_length=2,
        description="for each tier that it serves, waypoints from the boarding waypoint to the "
        "entrance of its queue",
    )
    rides: list[ExplicitRide] = Field(description="durations of the rides")


class ExplicitRobotKind(Strict):
    """Size and dynamics of robots."""

    radius_m: Positive = Field(description="radius of a robot, m")
    acceleration_m_s2: Rate = Field(description="acceleration, m/s2")
    deceleration_m_s2: Rate = Field(description="deceleration, m/s2")
    top_speed_m_s: Rate = Field(description="top speed, m/s")
    full_turn_s: Seconds = Field(description="duration of a turn of 360 degrees on the spot, s")
    pod_transfer_s: Seconds = Field(description="duration of lifting or setting down a pod, s")


class ExplicitPod(Strict):
    """A pod and where it stands at the start."""

    waypoint: Index = Field(description="storage location where it stands")
    capacity: Space = Field(description="capacity in space units")


class ExplicitRobot(Strict):
    """A robot and where it stands at the start."""

    waypoint: Index = Field(description="where it stands")
    heading_rad: float = Field(
        0.0,
        description="heading in rad: 0 is the +x direction, and positive angles turn towards +y",
    )
    kind: Index = Field(0, description="index of its robot kind")


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
        default_factory=list, description="stations where units are picked"
    )
    replenishment_stations: list[ExplicitReplenishmentStation] = Field(
        default_factory=list, description="stations where bundles are put into pods"
    )
    other_stations: dict[str, ExplicitOtherStations] = Field(
        default_factory=dict, description="stations of further kinds, by name of the kind"
    )
    elevators: list[ExplicitElevator] = Field(
        default_factory=list, description="elevators between tiers"
    )
    robots: list[ExplicitRobot] = Field(default_factory=list, description="robots at the start")
    pods: list[ExplicitPod] = Field(default_factory=list, description="pods at the start")
    waypoints: list[ExplicitWaypoint] = Field(
        min_length=1, description="all waypoints, numbered from 0 in this order"
    )

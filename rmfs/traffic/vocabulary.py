"""Types of the interface to `Traffic`: steps of commands, events, rows of traces, and trips."""

from __future__ import annotations

from enum import IntEnum
from typing import NamedTuple


class Step(IntEnum):
    """Kinds of commands to robots: drive to a waypoint, lift or set down a pod, go to a station."""

    DRIVE = 0
    LIFT = 1
    SET_DOWN = 2
    STATION = 3


class EventKind(IntEnum):
    """Kinds of traffic events.

    The description of each kind states in brackets what `TrafficEvent.value` contains.
    """

    ARRIVED = 0
    """The robot has finished a drive (waypoint)."""
    LIFT_STARTED = 1
    """The robot stands beneath the pod and lifts it (pod)."""
    LIFTED = 2
    """The robot has lifted the pod (pod)."""
    DEPARTED = 3
    """A plan by which the robot leaves a storage location was accepted (the waypoint it leaves)."""
    QUEUE_ENTERED = 4
    """The robot reached a queue zone (station); not reported at present."""
    AT_HEAD = 5
    """The robot stands at the station (station)."""
    SET_DOWN_STARTED = 6
    """The robot starts to set its pod down (pod)."""
    SET_DOWN = 7
    """The robot has set the pod down (pod)."""
    IDLE = 8
    """The robot has completed its program (waypoint)."""


class Piece(IntEnum):
    """Kinds of rows in a trace.

    A straight run on which the robot was delayed is recorded as GUIDED: its path is known, but not
    where on the path the robot was at each time.
    """

    HOLD = 0
    TURN = 1
    RUN = 2
    RIDE = 3
    LIFT = 4
    SET_DOWN = 5
    GUIDED = 6


class TripKind(IntEnum):
    """Destination of a trip: a pod, a station, a storage location, or a place to rest."""

    TO_POD = 0
    TO_STATION = 1
    TO_STORAGE = 2
    TO_REST = 3


class TrafficEvent(NamedTuple):
    """A traffic event; `Traffic.advance` returns plain tuples of these values in this order."""

    time_us: int
    kind: int
    robot: int
    value: int


class PlannedMove(NamedTuple):
    """One move of a plan: a straight run or an elevator ride that begins and ends at rest."""

    from_waypoint: int
    to_waypoint: int
    heading_rad: float
    start_us: int
    end_us: int
    is_ride: bool


class CutOff(NamedTuple):
    """Storage locations and stations that closed waypoints cut off.

    Attributes
    ----------
    storage
        Storage locations (waypoints) that are closed, or that lack a route for pods to or from one
        or more of the remaining stations.
    stations
        Stations (numbers) that are closed, or to which pods cannot be carried from any storage
        location and back.
    """

    storage: list[int]
    stations: list[int]

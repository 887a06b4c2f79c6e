"""Checks that the places of each queue form a chain to its head and are in no other queue (W3).

Condition W3 of deadlock freedom (docs/safety.md) requires that no more robots are sent to a station
than its queue has places. The traffic layer assigns the places one by one, and robots without a
place wait where they are. A short queue therefore suffices for any number of robots, with one
exception: if two queues consist of their stations alone, and the robot at each of these stations
has to go to the other one next, the two robots wait for each other forever. Chargers and swap
stations are exempt, since robots never go directly from one of them to another.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from rmfs.layout.charging import RecoveryKind
from rmfs.layout.checks.violation import (
    NOT_WELL_FORMED,
    Violation,
    at,
    station_label,
    waypoint_label,
)

if TYPE_CHECKING:
    from collections.abc import Iterator

    from rmfs.layout.model import Layout


@dataclass(frozen=True, slots=True)
class Queue:
    """The queue of a station, or of an elevator on one tier.

    Attributes
    ----------
    label
        Name of the queue in messages.
    head
        The waypoint of the station or elevator.
    places
        Waypoints of the queue, from the head to the entrance.
    of_elevator
        Whether the head is a waypoint of an elevator.
    is_left
        Whether the station is a charger or swap station; a robot never goes directly from one such
        station to another.
    """

    label: str
    head: int
    places: tuple[int, ...]
    of_elevator: bool
    is_left: bool = False

    @property
    def entrance(self) -> int:
        """The last place, at which robots enter the queue."""
        return self.places[-1]


def all_queues(layout: Layout) -> list[Queue]:
    """Return the queues of stations and elevators.

    A queue for which the layout lists no places consists of its head alone.
    """
    queues = [
        Queue(
            station_label(layout, s),
            station.waypoint,
            station.queue or (station.waypoint,),
            False,
            isinstance(station.kind, RecoveryKind),
        )
        for s, station in enumerate(layout.stations)
    ]
    for number, elevator in enumerate(layout.elevators):
        for waypoint in elevator.waypoints:
            label = f"elevator {number} ({at(layout, waypoint)})"
            places = elevator.queues.get(waypoint) or (waypoint,)
            queues.append(Queue(label, waypoint, places, True))
    return queues


def queue_lists(layout: Layout) -> Iterator[Violation]:
    """Yield violations: queues that are not chains, are too short or share places with others."""
    owner: dict[int, str] = {}
    for queue in all_queues(layout):
        yield from _chain(layout, queue)
        yield from _length(layout, queue)
        for place in dict.fromkeys(queue.places):
            if place in owner:
                message = f"shares {waypoint_label(layout, place)} with {owner[place]} (W3)"
                yield Violation(NOT_WELL_FORMED, queue.label, message)
            owner.setdefault(place, queue.label)


def _length(layout: Layout, queue: Queue) -> Iterator[Violation]:
    """Yield a violation if the queue is too short for robots that go from station to station."""
    several = layout.robots > 1 and len(layout.stations) > 1
    if several and not (queue.of_elevator or queue.is_left) and len(queue.places) == 1:
        message = (
            "its queue is too short: with one place, robots that go on to each other's station "
            "wait for each other (W3)"
        )
        yield Violation(NOT_WELL_FORMED, queue.label, message)


def _chain(layout: Layout, queue: Queue) -> Iterator[Violation]:
    """Yield the faults of one queue."""
    places = queue.places
    if places[0] != queue.head:
        message = f"its queue begins at {waypoint_label(layout, places[0])}, not at itself (W3)"
        yield Violation(NOT_WELL_FORMED, queue.label, message)
    if len(set(places)) < len(places):
        twice = next(place for place in places if places.count(place) > 1)
        message = f"its queue lists {waypoint_label(layout, twice)} twice (W3)"
        yield Violation(NOT_WELL_FORMED, queue.label, message)
    for rank in range(1, len(places)):
        place, ahead = places[rank], places[rank - 1]
        if layout.is_storage[place]:
            message = f"its {waypoint_label(layout, place)} is part of its queue (W1)"
            yield Violation(NOT_WELL_FORMED, queue.label, message)
        start, stop = layout.edge_start[place], layout.edge_start[place + 1]
        if ahead not in layout.edge_target[start:stop]:
            message = (
                f"queue place {rank} (waypoint {place}) does not lead to place {rank - 1} "
                f"(waypoint {ahead}) (W3)"
            )
            yield Violation(NOT_WELL_FORMED, queue.label, message)

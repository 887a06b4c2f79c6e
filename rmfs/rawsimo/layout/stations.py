"""Stations and elevators of RAWSim-O's explicit instances (.xinst), with their queues."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rmfs.rawsimo.layout.fields import Fields, slashed

if TYPE_CHECKING:
    from xml.etree.ElementTree import Element

    from rmfs.config import Table
    from rmfs.rawsimo.layout.instance import Instance
    from rmfs.rawsimo.layout.waypoints import Occupants


def pick_stations(instance: Instance, occupants: Occupants) -> list[Table]:
    """Return the pick stations.

    Each unit occupies the station for the ItemTransferTime and the robot for the ItemPickTime. If
    the ItemPickTime is missing or 0, the unit occupies the robot for the ItemTransferTime as well
    (as in RAWSim-O).
    """
    ranks = _ranks(instance, "OutputStation")
    stations, without = [], 0
    for position, fields in enumerate(instance.fields("OutputStation")):
        unit_transfer_s = fields.number("ItemTransferTime")
        unit_pick_s = fields.number("ItemPickTime", 0.0)
        if unit_pick_s == 0.0:
            without += 1
            unit_pick_s = unit_transfer_s
        stations.append(
            {
                "queue": _station_queue(instance, "OutputStation", position, occupants),
                "radius_m": fields.number("Radius"),
                "order_slots": fields.whole("Capacity"),
                "unit_transfer_s": unit_transfer_s,
                "unit_pick_s": unit_pick_s,
                "activation": ranks[position],
            }
        )
    if without:
        instance.remarks.append(
            f"{without} pick stations have no ItemPickTime: a unit occupies the robot as long as "
            "the station (ItemTransferTime)"
        )
    return stations


def replenishment_stations(instance: Instance, occupants: Occupants) -> list[Table]:
    """Return the replenishment stations."""
    ranks = _ranks(instance, "InputStation")
    return [
        {
            "queue": _station_queue(instance, "InputStation", position, occupants),
            "radius_m": fields.number("Radius"),
            "capacity": fields.number("Capacity"),
            "bundle_transfer_s": fields.number("ItemBundleTransferTime"),
            "activation": ranks[position],
        }
        for position, fields in enumerate(instance.fields("InputStation"))
    ]


def elevators(instance: Instance) -> tuple[list[Table], set[tuple[int, int]]]:
    """Return the elevators and, as pairs (origin, destination) of waypoints, all their rides."""
    found: list[Table] = []
    pairs: set[tuple[int, int]] = set()
    for element in instance.elements("Elevator"):
        label = Fields(element, instance.problems).label
        boarding = [
            instance.waypoint(entry.text, label) for entry in element.iterfind("Waypoints/Waypoint")
        ]
        queues = _queues(instance, element, label)
        rides = _rides(instance, element, label)
        pairs |= {(ride["origin"], ride["destination"]) for ride in rides}
        found.append(
            {
                "queues": [
                    _headed(instance, queues.get(waypoint, []), waypoint, label)
                    for waypoint in boarding
                ],
                "rides": rides,
            }
        )
    return found, pairs


def _rides(instance: Instance, element: Element, label: str) -> list[Table]:
    """Return the rides of an elevator, with their travel times."""
    rides: list[Table] = []
    for entry in element.iterfind("Timings/Timing"):
        parts = slashed(entry.text, 3)
        try:
            origin, destination, travel_s = parts or ("", "", "")
            seconds = float(travel_s)
        except ValueError:
            instance.problems.add(
                f"{label}: expected a timing FROM/TO/SECONDS (given: {entry.text!r})"
            )
            continue
        ride: Table = {
            "origin": instance.waypoint(origin, label),
            "destination": instance.waypoint(destination, label),
            "travel_s": seconds,
        }
        rides.append(ride)
    return rides


def _ranks(instance: Instance, kind: str) -> list[int]:
    """Return the ranks of stations, from 1, by ActivationOrderID and then by order in the file."""
    given = [fields.whole("ActivationOrderID", 0) for fields in instance.fields(kind)]
    order = sorted(range(len(given)), key=lambda position: (given[position], position))
    ranks = [0] * len(given)
    for rank, position in enumerate(order, start=1):
        ranks[position] = rank
    if ranks != given:
        instance.remarks.append(
            f"{kind}.ActivationOrderID is missing or not 1 to {len(given)}: ranked by it, then "
            "by the "
            "order of the file"
        )
    return ranks


def _station_queue(instance: Instance, kind: str, position: int, occupants: Occupants) -> list[int]:
    element = instance.elements(kind)[position]
    label = Fields(element, instance.problems).label
    if (kind, position) not in occupants:
        instance.problems.add(f"{label}: no waypoint names it")
        return [0]
    head = occupants[kind, position]
    queues = _queues(instance, element, label)
    if queues.keys() - {head}:
        instance.problems.add(f"{label}: one of its queues belongs to another waypoint")
    return _headed(instance, queues.get(head, []), head, label)


def _queues(instance: Instance, element: Element, label: str) -> dict[int, list[int]]:
    """Return the queue of each key waypoint of a station or elevator."""
    queues: dict[int, list[int]] = {}
    for entry in element.iterfind("Queues/Queues"):
        pair = slashed(entry.text, 2)
        if pair is None:
            instance.problems.add(
                f"{label}: expected a queue place KEY/PLACE (given: {entry.text!r})"
            )
            continue
        key, place = (instance.waypoint(text, label) for text in pair)
        queues.setdefault(key, []).append(place)
    return queues


def _headed(instance: Instance, queue: list[int], head: int, label: str) -> list[int]:
    """Return a queue that begins at `head`, the waypoint at which it is served."""
    if not queue:
        instance.remarks.append(f"{label}: has no queue; its own waypoint is its only queue place")
    elif queue[0] != head:
        instance.remarks.append(f"{label}: its own waypoint was put first in its queue")
    return [head, *(place for place in queue if place != head)]

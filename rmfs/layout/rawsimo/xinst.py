"""Import of RAWSim-O's explicit instances (.xinst).

The elements are translated into the table of an explicit layout, so that both formats share one
validation. Ids become positions in the order of the file.
"""

from __future__ import annotations

from collections import Counter
from typing import TYPE_CHECKING, Any

import numpy as np
from scipy.spatial import KDTree

from rmfs.layout.explicit import build
from rmfs.layout.explicit.schema import FORMAT
from rmfs.layout.rawsimo.fields import NOBODY, Fields, Problems, slashed
from rmfs.layout.rawsimo.xml import Unknown, read_root

if TYPE_CHECKING:
    from pathlib import Path
    from xml.etree.ElementTree import Element

    from rmfs.config import Table
    from rmfs.layout.model import Layout

_BODY = {"ID", "X", "Y", "Tier", "Radius"}
_ATTRIBUTES: dict[str, set[str]] = {
    "Tier": {
        *("ID", "Length", "Width"),
        *("RelativePositionX", "RelativePositionY", "RelativePositionZ"),
    },
    "Bot": {
        *_BODY,
        *("Orientation", "PodTransferTime", "MaxAcceleration", "MaxDeceleration"),
        *("MaxVelocity", "TurnSpeed", "CollisionPenaltyTime"),
    },
    "Pod": {*_BODY, "Orientation", "Capacity"},
    "InputStation": {*_BODY, "Capacity", "ItemBundleTransferTime", "ActivationOrderID"},
    "OutputStation": {
        *_BODY,
        *("Capacity", "ItemTransferTime", "ItemPickTime", "ActivationOrderID"),
    },
    "Elevator": {"ID"},
    "Waypoint": {
        *("ID", "X", "Y", "Tier", "InputStation", "OutputStation", "Elevator", "Pod"),
        *("PodStorageLocation", "IsQueueWaypoint"),
    },
    "Semaphore": {"ID", "Capacity"},
}
_CHILDREN: dict[str, set[str]] = {
    "InputStation": {"Queues"},
    "OutputStation": {"Queues"},
    "Elevator": {"Waypoints", "Timings", "Queues"},
    "Waypoint": {"Paths"},
    "Semaphore": {"Guards"},
}
_ENTRIES = {
    "Queues": "Queues",
    "Waypoints": "Waypoint",
    "Timings": "Timing",
    "Paths": "Waypoint",
    "Guards": "Guard",
}
_LISTS = {
    "Bots": "Bot",
    "Pods": "Pod",
    "Elevators": "Elevator",
    "InputStations": "InputStation",
    "OutputStations": "OutputStation",
    "Tiers": "Tier",
    "Waypoints": "Waypoint",
    "Semaphores": "Semaphore",
}
_UNNAMED = "unnamed"


def read_xinst(path: Path) -> tuple[Layout, list[str]]:
    """Read a file into a layout and remarks about what was left out or filled in.

    Raises
    ------
    InputError
        If the file cannot be read or does not describe a layout; the problems are named.
    """
    root = read_root(path, "Instance")
    problems = Problems()
    translation = _Translation(root, problems)
    problems.stop(path)
    table = translation.table()
    problems.stop(path)
    return build(table, str(path)), translation.notes()


class _Translation:
    """One file on its way to the table of an explicit layout."""

    def __init__(self, root: Element, problems: Problems) -> None:
        self._root = root
        self._problems = problems
        self._remarks: list[str] = []
        self._unknown = Unknown()
        self._elements = {kind: self._list(name) for name, kind in _LISTS.items()}
        self._index = {kind: self._positions(kind) for kind in self._elements}
        self._survey()
        self._waypoint_of: dict[tuple[str, int], int] = {}

    def notes(self) -> list[str]:
        """Remarks, in the order in which they came up."""
        return self._remarks + self._unknown.notes()

    def table(self) -> Table:
        """Return the table of the explicit layout."""
        waypoints = self._waypoints()
        rides, elevators = self._elevators()
        self._edges(waypoints, rides)
        pods, pod_radius_m = self._pods(waypoints)
        kinds, robots = self._robots(waypoints)
        return {
            "format": FORMAT,
            "name": self._root.get("Name") or _UNNAMED,
            "tiers": self._tiers(),
            "pod_radius_m": pod_radius_m,
            "robot_kinds": kinds,
            "pick_stations": self._pick_stations(),
            "replenishment_stations": self._replenishment_stations(),
            "elevators": elevators,
            "robots": robots,
            "pods": pods,
            "waypoints": waypoints,
        }

    # --- the file as a whole -------------------------------------------------------------------

    def _list(self, name: str) -> list[Element]:
        found = self._root.find(name)
        return [] if found is None else [child for child in found if child.tag == _LISTS[name]]

    def _positions(self, kind: str) -> dict[int, int]:
        """Map the ids of a kind to positions."""
        positions: dict[int, int] = {}
        for position, element in enumerate(self._elements[kind]):
            name = Fields(element, self._problems).whole("ID")
            if name in positions:
                self._problems.add(f"{kind} {name}: the ID occurs twice")
            positions[name] = position
        return positions

    def _survey(self) -> None:
        """Note unknown elements and attributes, and those that have no meaning here."""
        self._unknown.attributes(self._root, ("Name",))
        self._unknown.children(self._root, _LISTS)
        for name, kind in _LISTS.items():
            for found in self._root.findall(name):
                self._unknown.children(found, (kind,))
            for element in self._elements[kind]:
                self._unknown.attributes(element, _ATTRIBUTES[kind])
                self._unknown.children(element, _CHILDREN.get(kind, ()))
                for nested in element:
                    self._unknown.children(nested, (_ENTRIES.get(nested.tag, ""),))
        self._survey_meaning()

    def _survey_meaning(self) -> None:
        """Note what is known but has no meaning here."""
        if semaphores := self._elements["Semaphore"]:
            self._remarks.append(
                f"{len(semaphores)} semaphores left out: only RAWSim-O's legacy robot heeds them"
            )
        if any("CollisionPenaltyTime" in bot.attrib for bot in self._elements["Bot"]):
            self._remarks.append("Bot.CollisionPenaltyTime left out: robots never collide here")
        if any(pod.get("Orientation", "0") != "0" for pod in self._elements["Pod"]):
            self._remarks.append("Pod.Orientation left out: pods are discs")
        for name in ("RelativePositionX", "RelativePositionY"):
            if any(tier.get(name, "0") != "0" for tier in self._elements["Tier"]):
                self._remarks.append(f"Tier.{name} left out: tiers lie above each other")

    def _position(self, kind: str, name: int, where: str) -> int:
        """Return the position of an id, or 0 and a problem if there is none."""
        if name not in self._index[kind]:
            self._problems.add(f"{where}: there is no {kind} {name}")
        return self._index[kind].get(name, 0)

    # --- tiers, waypoints, edges ---------------------------------------------------------------

    def _tiers(self) -> list[Table]:
        tiers = []
        for element in self._elements["Tier"]:
            fields = Fields(element, self._problems)
            tiers.append(
                {
                    "length_m": fields.number("Length"),
                    "width_m": fields.number("Width"),
                    "height_m": fields.number("RelativePositionZ", 0.0),
                }
            )
        return tiers

    def _waypoints(self) -> list[Table]:
        """Return the waypoints, still without edges, and learn who stands where."""
        waypoints: list[Table] = []
        moved = 0
        for element in self._elements["Waypoint"]:
            fields = Fields(element, self._problems)
            x_m, y_m = fields.number("X"), fields.number("Y")
            for kind in ("Pod", "InputStation", "OutputStation"):
                occupant = self._occupant(fields, kind, len(waypoints))
                if occupant is not None:
                    at_x_m, at_y_m = occupant.number("X", x_m), occupant.number("Y", y_m)
                    moved += (at_x_m, at_y_m) != (x_m, y_m)
                    x_m, y_m = at_x_m, at_y_m
            waypoints.append(
                {
                    "x_m": x_m,
                    "y_m": y_m,
                    "tier": self._position("Tier", fields.whole("Tier"), fields.label),
                    "storage": fields.switch("PodStorageLocation")
                    or fields.whole("Pod", NOBODY) != NOBODY,
                    "queue": fields.switch("IsQueueWaypoint"),
                }
            )
        if moved:
            self._remarks.append(f"{moved} waypoints moved to the pod or station they name")
        return waypoints

    def _occupant(self, fields: Fields, kind: str, waypoint: int) -> Fields | None:
        """Return the pod or station that a waypoint names, and remember where it stands."""
        name = fields.whole(kind, NOBODY)
        if name == NOBODY:
            return None
        position = self._position(kind, name, fields.label)
        if (kind, position) in self._waypoint_of:
            self._problems.add(f"{kind} {name}: named by two waypoints")
        self._waypoint_of[kind, position] = waypoint
        if name not in self._index[kind]:
            return None
        return Fields(self._elements[kind][position], self._problems)

    def _edges(self, waypoints: list[Table], rides: set[tuple[int, int]]) -> None:
        """Fill in the edges; those between tiers are left to the elevators."""
        across = 0
        for v, element in enumerate(self._elements["Waypoint"]):
            heads: list[int] = []
            for path in element.iterfind("Paths/Waypoint"):
                head = self._waypoint(path.text, f"Waypoint {element.get('ID')}")
                if waypoints[head]["tier"] == waypoints[v]["tier"]:
                    heads.append(head)
                elif (v, head) not in rides:
                    across += 1
            waypoints[v]["to"] = heads
        if across:
            self._remarks.append(f"{across} edges between tiers left out: they belong to no lift")

    def _waypoint(self, text: str | None, where: str) -> int:
        """Return the position of a waypoint given by its id as text."""
        try:
            name = int(text or "")
        except ValueError:
            self._problems.add(f"{where}: expected the ID of a waypoint (given: {text!r})")
            return 0
        return self._position("Waypoint", name, where)

    # --- stations and elevators ----------------------------------------------------------------

    def _pick_stations(self) -> list[Table]:
        ranks = self._ranks("OutputStation")
        stations, without = [], 0
        for position, element in enumerate(self._elements["OutputStation"]):
            fields = Fields(element, self._problems)
            unit_transfer_s = fields.number("ItemTransferTime")
            unit_pick_s = fields.number("ItemPickTime", 0.0)
            if unit_pick_s == 0.0:
                without += 1
                unit_pick_s = unit_transfer_s
            stations.append(
                {
                    "queue": self._station_queue("OutputStation", position),
                    "radius_m": fields.number("Radius"),
                    "order_slots": fields.whole("Capacity"),
                    "unit_transfer_s": unit_transfer_s,
                    "unit_pick_s": unit_pick_s,
                    "activation": ranks[position],
                }
            )
        if without:
            self._remarks.append(
                f"{without} pick stations without ItemPickTime: the robot is held as long as the "
                "station (ItemTransferTime)"
            )
        return stations

    def _replenishment_stations(self) -> list[Table]:
        ranks = self._ranks("InputStation")
        stations = []
        for position, element in enumerate(self._elements["InputStation"]):
            fields = Fields(element, self._problems)
            stations.append(
                {
                    "queue": self._station_queue("InputStation", position),
                    "radius_m": fields.number("Radius"),
                    "capacity": fields.number("Capacity"),
                    "bundle_transfer_s": fields.number("ItemBundleTransferTime"),
                    "activation": ranks[position],
                }
            )
        return stations

    def _ranks(self, kind: str) -> list[int]:
        """Return activation ranks from 1: those of the file if it has them, else by position."""
        elements = self._elements[kind]
        given = [Fields(e, self._problems).whole("ActivationOrderID", 0) for e in elements]
        order = sorted(range(len(given)), key=lambda position: (given[position], position))
        ranks = [0] * len(given)
        for rank, position in enumerate(order, start=1):
            ranks[position] = rank
        if ranks != given:
            self._remarks.append(
                f"{kind}.ActivationOrderID missing or not 1 to {len(given)}: ranked in the order "
                "of the file"
            )
        return ranks

    def _station_queue(self, kind: str, position: int) -> list[int]:
        element = self._elements[kind][position]
        label = Fields(element, self._problems).label
        if (kind, position) not in self._waypoint_of:
            self._problems.add(f"{label}: no waypoint names it")
            return [0]
        head = self._waypoint_of[kind, position]
        queues = self._queues(element, label)
        for key in queues:
            if key != head:
                self._problems.add(f"{label}: a queue belongs to another waypoint")
        return self._headed(queues.get(head, []), head, label)

    def _queues(self, element: Element, label: str) -> dict[int, list[int]]:
        """Return the queue of each key waypoint of a station or elevator."""
        queues: dict[int, list[int]] = {}
        for entry in element.iterfind("Queues/Queues"):
            pair = slashed(entry.text, 2)
            if pair is None:
                self._problems.add(f"{label}: expected a queue place KEY/PLACE ({entry.text!r})")
                continue
            key, place = (self._waypoint(text, label) for text in pair)
            queues.setdefault(key, []).append(place)
        return queues

    def _headed(self, queue: list[int], head: int, label: str) -> list[int]:
        """Make sure that a queue begins where it is served."""
        if not queue:
            self._remarks.append(f"{label}: without queue, the only place is the one served")
        elif queue[0] != head:
            self._remarks.append(f"{label}: the place served was put first in its queue")
        return [head, *(place for place in queue if place != head)]

    def _elevators(self) -> tuple[set[tuple[int, int]], list[Table]]:
        """Return all pairs of waypoints joined by a lift, and the lifts."""
        pairs: set[tuple[int, int]] = set()
        elevators = []
        for element in self._elements["Elevator"]:
            label = Fields(element, self._problems).label
            boarding = [
                self._waypoint(entry.text, label)
                for entry in element.iterfind("Waypoints/Waypoint")
            ]
            queues = self._queues(element, label)
            rides = self._rides(element, label)
            pairs |= {(ride["origin"], ride["destination"]) for ride in rides}
            elevators.append(
                {
                    "queues": [
                        self._headed(queues.get(waypoint, []), waypoint, label)
                        for waypoint in boarding
                    ],
                    "rides": rides,
                }
            )
        return pairs, elevators

    def _rides(self, element: Element, label: str) -> list[Table]:
        rides: list[Table] = []
        for entry in element.iterfind("Timings/Timing"):
            parts = slashed(entry.text, 3)
            try:
                origin, destination, travel_s = parts or ("", "", "")
                seconds = float(travel_s)
            except ValueError:
                self._problems.add(f"{label}: expected a timing FROM/TO/SECONDS ({entry.text!r})")
                continue
            ride: Table = {
                "origin": self._waypoint(origin, label),
                "destination": self._waypoint(destination, label),
                "travel_s": seconds,
            }
            rides.append(ride)
        return rides

    # --- pods and robots -----------------------------------------------------------------------

    def _pods(self, waypoints: list[Table]) -> tuple[list[Table], float]:
        nearest = _Nearest(waypoints, [bool(waypoint["storage"]) for waypoint in waypoints])
        pods, radii, searched = [], Counter[float](), 0
        for position, element in enumerate(self._elements["Pod"]):
            fields = Fields(element, self._problems)
            radii[fields.number("Radius")] += 1
            waypoint = self._waypoint_of.get(("Pod", position))
            if waypoint is None:
                searched += 1
                tier = self._position("Tier", fields.whole("Tier"), fields.label)
                waypoint = nearest.to(fields.number("X"), fields.number("Y"), tier)
                if waypoint is None:
                    self._problems.add(f"{fields.label}: no storage place on its tier")
            pods.append({"waypoint": waypoint or 0, "capacity": fields.number("Capacity")})
        if searched:
            self._remarks.append(
                f"{searched} pods named by no waypoint: put at the nearest storage place"
            )
        if len(radii) > 1:
            self._remarks.append(f"pods of {len(radii)} radii: the largest is used for all")
        return pods, max(radii, default=_POD_RADIUS_M)

    def _robots(self, waypoints: list[Table]) -> tuple[list[Table], list[Table]]:
        """Return the kinds of robots and the robots, each at the nearest waypoint of its tier."""
        nearest = _Nearest(waypoints, [True] * len(waypoints))
        kinds: dict[tuple[float, ...], int] = {}
        robots: list[Table] = []
        for element in self._elements["Bot"]:
            fields = Fields(element, self._problems)
            body = tuple(fields.number(name) for name in _ROBOT_KIND)
            tier = self._position("Tier", fields.whole("Tier"), fields.label)
            waypoint = nearest.to(fields.number("X"), fields.number("Y"), tier)
            if waypoint is None:
                self._problems.add(f"{fields.label}: no waypoint on its tier")
            robots.append(
                {
                    "waypoint": waypoint or 0,
                    "heading_rad": fields.number("Orientation", 0.0),
                    "kind": kinds.setdefault(body, len(kinds)),
                }
            )
        if not kinds:
            self._problems.add("Bots: at least one robot is needed")
        names = _ROBOT_KIND.values()
        return [dict(zip(names, body, strict=True)) for body in kinds], robots


_ROBOT_KIND = {
    "Radius": "radius_m",
    "MaxAcceleration": "acceleration_m_s2",
    "MaxDeceleration": "deceleration_m_s2",
    "MaxVelocity": "top_speed_m_s",
    "TurnSpeed": "full_turn_s",
    "PodTransferTime": "pod_transfer_s",
}
_POD_RADIUS_M = 0.45
"""For a layout without pods (RAWSim-O's default)."""


class _Nearest:
    """Finds the nearest of some waypoints on a tier."""

    def __init__(self, waypoints: list[Table], eligible: list[bool]) -> None:
        self._trees: dict[int, tuple[KDTree, list[int]]] = {}
        members: dict[int, list[int]] = {}
        for v, waypoint in enumerate(waypoints):
            if eligible[v]:
                members.setdefault(waypoint["tier"], []).append(v)
        for tier, found in members.items():
            places: Any = np.array([(waypoints[v]["x_m"], waypoints[v]["y_m"]) for v in found])
            self._trees[tier] = KDTree(places), found

    def to(self, x_m: float, y_m: float, tier: int) -> int | None:
        """Return the nearest waypoint, or None if the tier has none."""
        if tier not in self._trees:
            return None
        tree, found = self._trees[tier]
        return found[int(tree.query((x_m, y_m))[1])]

"""Access to the elements of RAWSim-O's explicit instances (.xinst) by kind and id.

Unknown elements and attributes are listed in remarks.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from rmfs.rawsimo.layout.fields import Fields, Problems
from rmfs.rawsimo.xml import Unknown

if TYPE_CHECKING:
    from collections.abc import Iterator
    from xml.etree.ElementTree import Element

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
_UNNAMED = "unnamed"


class Instance:
    """An .xinst file that is being converted to a layout.

    Parameters
    ----------
    root
        The root element.

    Attributes
    ----------
    problems
        Errors that make the file unusable.
    remarks
        Remarks on what was left out or filled in.
    """

    def __init__(self, root: Element) -> None:
        self.problems = Problems()
        self.remarks: list[str] = []
        self.name = root.get("Name") or _UNNAMED
        self._elements = {kind: _listed(root, name, kind) for name, kind in _LISTS.items()}
        self._index = {kind: self._positions(kind) for kind in self._elements}
        self._survey(root)
        self._survey_meaning()

    def elements(self, kind: str) -> list[Element]:
        """Return the elements of a kind, such as `Pod`, in their order in the file."""
        return self._elements[kind]

    def fields(self, kind: str) -> Iterator[Fields]:
        """Yield the attributes of each element of a kind."""
        return (Fields(element, self.problems) for element in self._elements[kind])

    def has(self, kind: str, name: int) -> bool:
        """Return whether any element of a kind has the id `name`."""
        return name in self._index[kind]

    def position(self, kind: str, name: int, where: str) -> int:
        """Return the index, among the elements of a kind, of the element with the id `name`.

        If there is no such element, an error is added and the result is 0.
        """
        if not self.has(kind, name):
            self.problems.add(f"{where}: there is no {kind} {name}")
        return self._index[kind].get(name, 0)

    def waypoint(self, text: str | None, where: str) -> int:
        """Return the index of the waypoint whose id is `text`.

        If there is no such waypoint, an error is added and the result is 0.
        """
        try:
            name = int(text or "")
        except ValueError:
            self.problems.add(f"{where}: expected the ID of a waypoint (given: {text!r})")
            return 0
        return self.position("Waypoint", name, where)

    def _positions(self, kind: str) -> dict[int, int]:
        """Map the ids of a kind to positions."""
        positions: dict[int, int] = {}
        for position, fields in enumerate(self.fields(kind)):
            name = fields.whole("ID")
            if name in positions:
                self.problems.add(f"{kind} {name}: the ID occurs twice")
            positions[name] = position
        return positions

    def _survey(self, root: Element) -> None:
        """Add remarks on all unknown elements and attributes."""
        unknown = Unknown()
        unknown.attributes(root, ("Name",))
        unknown.children(root, _LISTS)
        for name, kind in _LISTS.items():
            for found in root.findall(name):
                unknown.children(found, (kind,))
            for element in self._elements[kind]:
                unknown.attributes(element, _ATTRIBUTES[kind])
                unknown.children(element, _CHILDREN.get(kind, ()))
                for nested in element:
                    unknown.children(nested, (_ENTRIES.get(nested.tag, ""),))
        self.remarks += unknown.notes()

    def _survey_meaning(self) -> None:
        """Add remarks on known elements and attributes that have no meaning in rmfs."""
        if semaphores := self._elements["Semaphore"]:
            self.remarks.append(
                f"{len(semaphores)} semaphores left out: only RAWSim-O's legacy robots obey them"
            )
        if any("CollisionPenaltyTime" in bot.attrib for bot in self._elements["Bot"]):
            self.remarks.append("Bot.CollisionPenaltyTime left out: robots never collide in rmfs")
        if any(pod.get("Orientation", "0") != "0" for pod in self._elements["Pod"]):
            self.remarks.append("Pod.Orientation left out: pods are discs")
        for name in ("RelativePositionX", "RelativePositionY"):
            if any(tier.get(name, "0") != "0" for tier in self._elements["Tier"]):
                self.remarks.append(
                    f"Tier.{name} left out: in rmfs, tiers lie exactly above each other"
                )


def _listed(root: Element, name: str, kind: str) -> list[Element]:
    return [child for found in root.findall(name) for child in found if child.tag == kind]

"""Kinds of station: classes with everything that distinguishes one kind from the others.

The attributes of a kind include its parts, such as its service and its controller. Each part is
given as a class or as a reference to a class (`module:Class`). References allow a layout, which
contains the kinds of its stations, to be read without importing the simulation modules. Pick and
replenishment stations are kinds like any other. Layout files name all other kinds by
`module:Class`, by `path/to/file.py:Class`, or by a registered name: `charger`, `swap`, or a name
that an installed Python package registers in the entry-point group `rmfs.stations`.
"""

from __future__ import annotations

import hashlib
from functools import cache
from importlib.metadata import entry_points
from typing import TYPE_CHECKING, Any, ClassVar, TypeVar

from rmfs.config import Model, validate
from rmfs.errors import InputError
from rmfs.layout import colours
from rmfs.references import (
    anchored,
    is_reference,
    reference_of,
    require_allowed,
    resolve,
)
from rmfs.sources import sources

if TYPE_CHECKING:
    from collections.abc import Mapping
    from pathlib import Path

GROUP = "rmfs.stations"
"""Entry-point group of third-party kinds of station."""

T = TypeVar("T")


class NoParameters(Model):
    """Model of the parameters of station kinds that have none."""


class StationKind:
    """Base class of kinds of station; a derived class sets the attributes below.

    Parameters
    ----------
    parameters
        Parameters shared by all stations of the kind in a layout, and by their controller.

    Attributes
    ----------
    name
        Name of the kind in files, tables and the viewer.
    letter
        Prefix of a station's number, used where space is short.
    colour
        Colour of the stations, and of robots on their way to them.
    handles
        What the viewer counts at the stations, such as `units picked`.
    parameters_model
        Pydantic model that validates the parameters.
    task
        Class of the tasks that bring robots to the stations; for kinds other than pick and
        replenishment, a subclass of `VisitTask`.
    state
        Class of the state of a station during a run, a subclass of `Station`.
    service
        Class that serves the robot at the head of the queue; it has the interface of `Service`.
    controller
        Class of the controller that decides which pod visits a station and when, a subclass of
        `VisitController`; None if the controllers of the decision problems decide this.
    measures
        Classes of measures. If the layout has stations of the kind, the columns of these measures
        are part of the footprint.
    """

    name: ClassVar[str]
    letter: ClassVar[str]
    colour: ClassVar[str]
    handles: ClassVar[str] = "visits"
    parameters_model: ClassVar[type[Model]] = NoParameters
    task: ClassVar[str | type] = "rmfs.world.tasks:VisitTask"
    state: ClassVar[str | type] = "rmfs.world.stations:Station"
    service: ClassVar[str | type] = "rmfs.simulation.service:VisitService"
    controller: ClassVar[str | type | None] = None
    measures: ClassVar[tuple[str | type, ...]] = ()

    def __init__(self, parameters: Any = None) -> None:
        self.parameters: Any = self.parameters_model() if parameters is None else parameters

    def digested(self) -> tuple[object, ...]:
        """Return what identifies the kind: name, SHA-256 of each source file, and parameters.

        Source files that belong to rmfs are left out.
        """
        files = sources([type(self)]).values()
        written = sorted(hashlib.sha256(path.read_bytes()).hexdigest() for path in files)
        return self.name, written, self.parameters.model_dump(mode="json")

    def part(self, name: str, base: type[T]) -> type[T]:
        """Return the class of a part, such as `service`, and check that it is derived from `base`.

        Raises
        ------
        InputError
            If the class cannot be imported, or is not derived from `base`.
        """
        return resolve(getattr(self, name), base, f"{name} of {self.name} stations")

    def busy_s(self, station: Any) -> float:
        """Return the time in s for which one unit or bundle occupies a station; 0 if not fixed."""
        return 0.0


class PickKind(StationKind):
    """The kind of pick stations, where units are picked from pods for orders."""

    name = "pick"
    letter = "P"
    colour = colours.PICK_STATION
    handles = "units picked"
    task = "rmfs.world.tasks:PickTask"
    state = "rmfs.world.stations:PickStation"
    service = "rmfs.simulation.service:PickService"

    def busy_s(self, station: Any) -> float:
        """Return the time in s for which one unit occupies a station."""
        return float(station.unit_transfer_s)


class ReplenishmentKind(StationKind):
    """The kind of replenishment stations, where bundles are put into pods."""

    name = "replenishment"
    letter = "R"
    colour = colours.REPLENISHMENT_STATION
    handles = "bundles stored"
    task = "rmfs.world.tasks:ReplenishTask"
    state = "rmfs.world.stations:ReplenishmentStation"
    service = "rmfs.simulation.service:ReplenishmentService"

    def busy_s(self, station: Any) -> float:
        """Return the time in s for which one bundle occupies a station."""
        return float(station.bundle_transfer_s)


PICK, REPLENISHMENT = PickKind(), ReplenishmentKind()

TASK_COLOURS = {
    "pick": PICK.colour,
    "replenish": REPLENISHMENT.colour,
    "park": "#56B4E9",
    "reposition": "#CC79A7",
    "rest": "#999999",
}
"""Colours of robots by task. A robot on its way to a station of any other kind has the colour of
that kind."""

_SHIPPED = {
    "charger": "rmfs.layout.charging:Charger",
    "swap": "rmfs.layout.charging:Swap",
}
"""Kinds shipped with rmfs besides pick and replenishment stations."""

_RESERVED = ("pick", "replenish", "replenishment", "elevator", "park", "reposition", "rest")


def find(reference: str) -> type[StationKind]:
    """Return the class of a kind of station, given a registered name or a reference to the class.

    Raises
    ------
    InputError
        If there is no such kind, or its class cannot be imported.
    """
    if not is_reference(reference):
        known = {**_installed(), **_SHIPPED}
        if reference not in known:
            there = f"; valid: {', '.join(sorted(known))}"
            raise InputError(
                f"no kind of station is named {reference}; expected module:Class or "
                f"path/to/file.py:Class{there}"
            )
        reference = known[reference]
    else:
        require_allowed(reference)
    return resolve(reference, StationKind, "kind of station")


def station_kind(
    name: str, reference: str, parameters: Mapping[str, Any], folder: Path | None = None
) -> StationKind:
    """Create a kind of station from its entry in a layout file.

    Parameters
    ----------
    name
        Name of the kind, which is the key of its table below `other_stations`.
    reference
        Reference to the class of the kind, or its registered name, as in the layout file.
    folder
        Folder in which a file named in `reference` is looked for first; the working directory is
        searched next. Default: only the working directory is searched.

    Raises
    ------
    InputError
        If there is no such kind, if `name` is reserved or differs from the attribute `name` of the
        class, if the class has no letter or colour, or if a parameter is invalid.
    """
    key = f"other_stations.{name}"
    try:
        found = find(anchored(reference, folder))
    except InputError as error:
        raise InputError(f"{key}.kind: {error}") from None
    told = getattr(found, "name", None)
    if told != name or name in _RESERVED:
        raise InputError(
            f"{key}: {reference} has the name {told!r}: use the table other_stations.{told}"
            if told != name
            else f"{key}: the name {name} is reserved; the class needs another name"
        )
    for needed in ("letter", "colour"):
        if not isinstance(getattr(found, needed, None), str):
            raise InputError(f"{key}.kind: {reference} has no {needed}")
    return found(validate(found.parameters_model, dict(parameters), f"{key}.parameters"))


def described(kind: StationKind) -> dict[str, Any]:
    """Return the entry of a kind in a layout file: a reference to its class, and its parameters."""
    return {
        "kind": reference_of(type(kind)),
        "parameters": kind.parameters.model_dump(mode="json"),
    }


@cache
def _installed() -> dict[str, str]:
    return {entry.name: entry.value for entry in entry_points(group=GROUP)}

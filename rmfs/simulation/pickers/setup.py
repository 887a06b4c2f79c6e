"""Creates the pickers of a scenario, if it has any."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from rmfs.errors import InputError
from rmfs.random import Stream, generator
from rmfs.simulation.pickers.hands import SPEEDS, Hands
from rmfs.simulation.pickers.roster import RosterClock
from rmfs.simulation.service import PickService
from rmfs.world.pickers import Picker, Staff
from rmfs.world.pod_faces import PodFaces
from rmfs.world.pod_layers import PodLayers

if TYPE_CHECKING:
    from collections.abc import Sequence

    from rmfs.layout.model import Layout
    from rmfs.observer import Observer
    from rmfs.scenario.parameters import Pickers
    from rmfs.simulation.agenda import Agenda
    from rmfs.simulation.service import Service
    from rmfs.world import World


def staffed(
    given: Pickers | None,
    layout: Layout,
    services: Sequence[Service],
    seed: int,
    gone_s: float,
    *,
    agenda: Agenda,
    world: World,
    events: Observer,
) -> tuple[list[Observer], RosterClock | None]:
    """Create the pickers of a scenario, if it has any, and let them work at the pick stations.

    Parameters
    ----------
    gone_s
        Time of day at time zero, in s.

    Returns
    -------
    tuple
        The observers to add to the run, and the clock of the roster; without pickers, an empty list
        and None.

    Raises
    ------
    InputError
        If a shift has more pickers than there are pick stations, or the file of measured times is
        invalid.
    """
    if given is None:
        return [], None
    unit_s = [station.unit_transfer_s for station in layout.pick_stations]
    staff = world.staff = Staff(given, _people(given, len(unit_s), seed), unit_s)
    layers, faces = _layers(given, layout, world), _faces(given, layout, world)
    hands = Hands(staff, layers, faces, seed, world)
    for service in services:
        if isinstance(service, PickService):
            service.hands = hands
    clock = RosterClock(
        given.roster, staff, gone_s, services, agenda=agenda, world=world, events=events
    )
    return [hands], clock


def _people(given: Pickers, stations: int, seed: int) -> list[Picker]:
    """Return all pickers, those of the first shift first."""
    shifts = 1 if given.roster is None else len(given.roster.shifts_s)
    counts = given.roster.pickers if given.roster is not None else ()
    tired = 0.0 if given.fatigue is None else given.fatigue.initial
    people: list[Picker] = []
    for shift in range(shifts):
        number = counts[shift] if counts else stations
        if number > stations:
            raise InputError(
                f"scenario.pickers.roster.pickers: shift {shift} has {number} pickers, but the "
                f"layout only {stations} pick stations"
            )
        for home in range(number):
            index = len(people)
            people.append(Picker(index, shift, home, _speed(given, index, seed), fatigue=tired))
    return people


def _speed(given: Pickers, index: int, seed: int) -> float:
    if given.speeds:
        return given.speeds[index % len(given.speeds)]
    if not given.speed_variation:
        return 1.0
    square = given.speed_variation**2
    rng = generator(seed, Stream.PICKERS, index, SPEEDS)
    # a picker who hardly moves would block a station forever
    return max(float(rng.gamma(1.0 / square, square)), 0.1)


def _layers(given: Pickers, layout: Layout, world: World) -> PodLayers | None:
    """Distribute the initial stock over layers, pod by pod and SKU by SKU."""
    if given.layers is None:
        return None
    skus = world.skus
    layers = PodLayers(given.layers, skus.space_per_unit, skus.popularity, layout.pod_capacity)
    _fill(layers, world)
    return layers


def _faces(given: Pickers, layout: Layout, world: World) -> PodFaces | None:
    """Distribute the initial stock over faces in the same way."""
    if given.faces is None:
        return None
    faces = PodFaces(given.faces, world.skus.space_per_unit, layout.pod_capacity)
    _fill(faces, world)
    return faces


def _fill(places: PodLayers | PodFaces, world: World) -> None:
    contained = world.inventory.contained.T
    for pod, sku in np.argwhere(contained > 0).tolist():
        places.put(pod, sku, int(contained[pod, sku]))

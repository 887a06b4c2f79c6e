"""Determines how long each pick takes and whether it is correct, depending on the picker."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rmfs.observer import Observer
from rmfs.random import Stream, generator
from rmfs.world.pickers import Handled

if TYPE_CHECKING:
    from rmfs.scenario.parameters.pickers import Errors
    from rmfs.world import World
    from rmfs.world.orders import Bundle
    from rmfs.world.pickers import Picker, Staff
    from rmfs.world.pod_faces import PodFaces
    from rmfs.world.pod_layers import PodLayers
    from rmfs.world.tasks import Pick, PickTask

TIMES, ERRORS, SPEEDS = range(3)
"""Random streams of each picker, so that simulating errors does not change the drawn times."""


class Hands(Observer):
    """Determines, for each unit, who picks it, how long this takes, and whether it is correct.

    Parameters
    ----------
    staff
        The pickers.
    layers, faces
        Positions of units in pods, if pods have layers or faces.
    seed
        Seed of the run.
    """

    def __init__(
        self,
        staff: Staff,
        layers: PodLayers | None,
        faces: PodFaces | None,
        seed: int,
        world: World,
    ) -> None:
        self._staff, self._layers, self._faces, self._world = staff, layers, faces, world
        self._seen: dict[int, tuple[int, int]] = {}
        """For each station, the number of its visit, and the face last shown in it."""
        self._times = [generator(seed, Stream.PICKERS, p.index, TIMES) for p in staff.pickers]
        self._errors = [generator(seed, Stream.PICKERS, p.index, ERRORS) for p in staff.pickers]

    def are_at(self, station: int) -> bool:
        """Whether a picker is at a station."""
        return self._staff.at_station[station] is not None

    def first_of(self, station: int, task: PickTask) -> Pick | None:
        """Return the task's first pick from the face that the picker sees; None if there is none.

        Only picks for orders at the station count. Before the first pick of a visit, and if pods
        have no faces, the result is None.
        """
        faces, shown = self._faces, self._shown(station)
        if faces is None or shown < 0:
            return None
        on_face = (
            pick
            for pick in task.picks
            if pick.line.order.station >= 0 and faces.has(task.pod, pick.line.sku, shown)
        )
        return next(on_face, None)

    def handle(self, station: int, pod: int, sku: int, station_s: float, robot_s: float) -> Handled:
        """Let the picker of a station start to pick a unit.

        Parameters
        ----------
        station_s, robot_s
            Times for which the unit occupies station and robot according to the layout, in s.

        Returns
        -------
        Handled
            How the unit is handled, with the times in s for which it occupies picker and robot.
        """
        staff, now_s = self._staff, self._world.now_s
        picker = staff.at_station[station]
        assert picker is not None
        fatigue = staff.fatigue(picker, now_s)
        layer = -1 if self._layers is None else self._layers.take(pod, sku)
        drawn_s = staff.unit_times.draw_s(station_s, self._times[picker.index])
        seconds = drawn_s * staff.factor(picker, now_s)
        if layer >= 0:
            assert staff.given.layers is not None
            seconds *= staff.given.layers.time_factors[layer]
        robot_s = robot_s * (seconds / station_s) if station_s else robot_s
        face, turned = self._turn(station, pod, sku)
        if turned:
            assert staff.given.faces is not None
            seconds += staff.given.faces.turn_face_s
            robot_s += staff.given.faces.turn_face_s
        error, noticed = self._is_wrong(picker, fatigue)
        if noticed:
            assert staff.given.errors is not None
            seconds += staff.given.errors.rework_s
            robot_s += staff.given.errors.rework_s
        staff.begin_unit(picker, now_s, seconds)
        how = (picker.index, seconds, robot_s, layer, fatigue, error, noticed)
        return Handled(*how, face, turned)

    def bundle_stored(self, bundle: Bundle, robot: int) -> None:
        """Assign the units of a stored bundle to layers or faces of their pod."""
        if self._layers is not None:
            self._layers.put(bundle.pod, bundle.sku, bundle.units)
        if self._faces is not None:
            self._faces.put(bundle.pod, bundle.sku, bundle.units)

    def _shown(self, station: int) -> int:
        """Return the face that the picker sees; -1 if nothing of this visit was picked yet."""
        visit, face = self._seen.get(station, (-1, -1))
        return face if visit == self._world.stations[station].visits else -1

    def _turn(self, station: int, pod: int, sku: int) -> tuple[int, bool]:
        """Take a unit from its face; return the face, and whether the pod had to be turned."""
        if self._faces is None:
            return -1, False
        shown = self._shown(station)
        face = self._faces.take(pod, sku, shown)
        self._seen[station] = (self._world.stations[station].visits, face)
        return face, shown not in (-1, face)

    def _is_wrong(self, picker: Picker, fatigue: float) -> tuple[bool, bool]:
        given = self._staff.given.errors
        if given is None:
            return False, False
        rng = self._errors[picker.index]
        wrong, seen = rng.random(), rng.random()
        error = wrong < _error_share(given, fatigue)
        return error, error and seen < given.noticed_share


def _error_share(given: Errors, fatigue: float) -> float:
    tired = given.share if given.at_full_fatigue is None else given.at_full_fatigue
    return given.share + (tired - given.share) * fatigue

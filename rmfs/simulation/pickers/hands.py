"""How long a unit keeps the picker, the station and the robot, and whether it is the right one."""

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
    from rmfs.world.pod_layers import PodLayers

TIMES, ERRORS, SPEEDS = range(3)
"""Random streams of each picker: switching one cause on does not change the draws of another."""


class Hands(Observer):
    """What every pick station asks before it begins with a unit.

    Parameters
    ----------
    staff
        The pickers.
    layers
        Where units lie in pods, if pods have layers.
    seed
        Of the run.
    """

    def __init__(self, staff: Staff, layers: PodLayers | None, seed: int, world: World) -> None:
        self._staff, self._layers, self._world = staff, layers, world
        self._times = [generator(seed, Stream.PICKERS, p.index, TIMES) for p in staff.pickers]
        self._errors = [generator(seed, Stream.PICKERS, p.index, ERRORS) for p in staff.pickers]

    def are_at(self, station: int) -> bool:
        """Whether somebody is there to pick."""
        return self._staff.at_station[station] is not None

    def handle(self, station: int, pod: int, sku: int, station_s: float, robot_s: float) -> Handled:
        """Let the picker of a station begin with a unit.

        Parameters
        ----------
        station_s, robot_s
            For how long it keeps them as the layout says.
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
        error, noticed = self._is_wrong(picker, fatigue)
        if noticed:
            assert staff.given.errors is not None
            seconds += staff.given.errors.rework_s
            robot_s += staff.given.errors.rework_s
        staff.begin_unit(picker, now_s, seconds)
        return Handled(picker.index, seconds, robot_s, layer, fatigue, error, noticed)

    def bundle_stored(self, bundle: Bundle, robot: int) -> None:
        """Lay the units of a bundle into their pod."""
        if self._layers is not None:
            self._layers.put(bundle.pod, bundle.sku, bundle.units)

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

"""ROA random: sends each bundle to a random station with room."""

from __future__ import annotations

from math import inf
from typing import TYPE_CHECKING

from rmfs.control.base import Parameters
from rmfs.control.decisions import SendBundle
from rmfs.control.roa import ReplenishmentOrderAssignment

if TYPE_CHECKING:
    from collections.abc import Iterator

    import numpy as np

    from rmfs.control.view import View
    from rmfs.world.orders import Bundle
    from rmfs.world.stations import ReplenishmentStation


class RandomStationParameters(Parameters):
    """Parameters of ROA random."""

    stick_to_station: bool = True
    """Whether the station chosen for the previous bundle is chosen again as long as it is active
    and has room."""


class RandomStation(ReplenishmentOrderAssignment[RandomStationParameters]):
    """Sends bundles in order of arrival to random active stations with room.

    By default, the station chosen for the previous bundle is chosen again as long as it is active
    and has room. The rule does not wait until RPS has chosen a pod for a bundle. A bundle waits if
    no active station has room for it.
    """

    parameters_model = RandomStationParameters

    def __init__(
        self, parameters: RandomStationParameters, view: View, rng: np.random.Generator
    ) -> None:
        super().__init__(parameters, view, rng)
        self._last: ReplenishmentStation | None = None

    def decide(self) -> Iterator[SendBundle]:
        """Yield assignments until no waiting bundle fits into any active station."""
        if not self.view.bundles.without_station:
            return
        stations = [station for station in self.view.replenishment_stations if station.active]
        # free space only shrinks meanwhile: what did not fit once need not be tried again
        too_large = inf
        for bundle in list(self.view.bundles.without_station.values()):
            if bundle.space >= too_large:
                continue
            station = self._station(bundle, stations)
            if station is None:
                too_large = bundle.space
            else:
                yield SendBundle(bundle, station.index)

    def _station(
        self, bundle: Bundle, stations: list[ReplenishmentStation]
    ) -> ReplenishmentStation | None:
        """Return the previous station or draw a station with room; None if no station has room."""
        space, last = bundle.space, self._last
        if last is not None and last.active and space <= last.free_space:
            return last
        fitting = [station for station in stations if space <= station.free_space]
        if not fitting:
            return None
        drawn = fitting[self.draw(len(fitting))]
        if self.parameters.stick_to_station:
            self._last = drawn
        return drawn

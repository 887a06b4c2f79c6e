"""ROA random: each bundle to any station with room."""

from __future__ import annotations

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
    """Whether the last station is taken again while it has room."""


class RandomStation(ReplenishmentOrderAssignment[RandomStationParameters]):
    """Sends bundles in order of arrival to stations drawn among those active and with room.

    It does not wait for the choice of the pod. A bundle without room anywhere waits.
    """

    parameters_model = RandomStationParameters

    def __init__(
        self, parameters: RandomStationParameters, view: View, rng: np.random.Generator
    ) -> None:
        super().__init__(parameters, view, rng)
        self._last: ReplenishmentStation | None = None

    def decide(self) -> Iterator[SendBundle]:
        """Yield until no bundle fits anywhere."""
        stations = [station for station in self.view.replenishment_stations if station.active]
        room = max((station.free_space for station in stations), default=0.0)
        for bundle in list(self.view.bundles.without_station.values()):
            if bundle.space > room:
                continue
            yield SendBundle(bundle, self._station(bundle, stations).index)
            room = max(station.free_space for station in stations)
            if room <= 0:
                return

    def _station(
        self, bundle: Bundle, stations: list[ReplenishmentStation]
    ) -> ReplenishmentStation:
        last = self._last
        keep = self.parameters.stick_to_station and last is not None
        if keep and last in stations and bundle.space <= last.free_space:
            return last
        fitting = [station for station in stations if bundle.space <= station.free_space]
        self._last = fitting[self.draw(len(fitting))]
        return self._last

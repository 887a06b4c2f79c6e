"""SA all: every station is always on."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rmfs.control.base import NoParameters
from rmfs.control.decisions import SwitchStation
from rmfs.control.sa import StationActivation

if TYPE_CHECKING:
    from collections.abc import Iterator


class AllStations(StationActivation[NoParameters]):
    """Switches every station on at the start."""

    def decide(self) -> Iterator[SwitchStation]:
        """Yield, for each station that is off, a decision to switch it on."""
        for station in self.view.stations:
            if not station.active:
                yield SwitchStation(station.index, active=True)

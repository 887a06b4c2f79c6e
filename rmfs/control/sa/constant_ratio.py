"""SA constant-ratio: a fixed share of the stations is on."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated

import pydantic

from rmfs.control.base import Parameters
from rmfs.control.decisions import SwitchStation
from rmfs.control.sa import StationActivation
from rmfs.control.sa.order import activation_order

if TYPE_CHECKING:
    from collections.abc import Iterator

Share = Annotated[float, pydantic.Field(ge=0, le=1)]


class ConstantRatioParameters(Parameters):
    """Parameters of SA constant-ratio."""

    active_share: Share = 0.5
    """Share of all stations that are on."""
    pick_share: Share = 0.5
    """Share of pick stations among the stations that are on."""


class ConstantRatio(StationActivation[ConstantRatioParameters]):
    """Switches a fixed share of the stations on and the others off, permanently.

    Of n stations, m = floor(`active_share` x n) are to be on: p = floor(`pick_share` x m) pick
    stations and m - p replenishment stations. If one of these two numbers is 0, it is raised to 1.
    If a kind has fewer stations than are to be on, all its stations are on. Otherwise, those of its
    stations are on that have the lowest activation numbers in the layout; ties go to the station
    with the lowest number.
    """

    parameters_model = ConstantRatioParameters

    def decide(self) -> Iterator[SwitchStation]:
        """Yield, for each station that is not in the desired state, a decision to switch it."""
        on = self._on()
        for station in self.view.stations:
            if station.active != (station.index in on):
                yield SwitchStation(station.index, active=station.index in on)

    def _on(self) -> set[int]:
        given = self.parameters
        active = int(len(self.view.stations) * given.active_share + 1e-9)
        pick = int(active * given.pick_share + 1e-9)
        picks = activation_order(self.view, pick=True)[: max(pick, 1)]
        others = activation_order(self.view, pick=False)[: max(active - pick, 1)]
        return {*picks, *others}

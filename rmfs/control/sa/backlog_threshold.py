"""SA backlog-threshold: switches stations according to the amount of waiting work."""

from __future__ import annotations

from math import inf
from typing import TYPE_CHECKING, Annotated

import pydantic

from rmfs.control.base import Parameters
from rmfs.control.decisions import SwitchStation
from rmfs.control.problems import Trigger
from rmfs.control.sa import StationActivation
from rmfs.control.sa.order import activation_order

if TYPE_CHECKING:
    from collections.abc import Iterator

    import numpy as np

    from rmfs.control.view import View

Count = Annotated[int, pydantic.Field(ge=0)]
Share = Annotated[float, pydantic.Field(ge=0, le=1)]


class BacklogThresholdParameters(Parameters):
    """Parameters of SA backlog-threshold."""

    pause_s: Annotated[float, pydantic.Field(ge=0, allow_inf_nan=False)] = 600.0
    """Minimum time, in seconds, between two switches of stations of the same kind, and from the
    start to the first switch."""
    orders_on: Count = 50
    """A pick station is switched on if more orders than this are in the backlog."""
    bundles_on: Count = 50
    """A replenishment station is switched on if more bundles than this are in the backlog."""
    pick_share_off: Share = 0.7
    """A pick station is switched off if the active ones use less than this share of their slots."""
    replenishment_share_off: Share = 0.7
    """A replenishment station is switched off if the active ones use less than this share of their
    space."""


class BacklogThreshold(StationActivation[BacklogThresholdParameters]):
    """Switches stations on when much work waits, and off when the active ones have little work.

    All stations are on at the start. Pick and replenishment stations are considered separately. A
    station is switched only if at least `pause_s` seconds have passed since the start and since the
    last switch of a station of the same kind.

    The backlog of pick stations is long if it contains more than `orders_on` orders. The use of
    pick stations is low if less than the share `pick_share_off` of the slots of active pick
    stations is in use.

    - If the backlog is long and the use is not low, the first pick station that is off is switched
      on.
    - If the use is low and the backlog is not long, the last pick station that is on is switched
      off, unless it is the only one.
    - Otherwise nothing changes.

    Replenishment stations are switched in the same way, according to `bundles_on`,
    `replenishment_share_off` and the space in use; bundles held back by RPS count as backlog.
    Stations are ordered by activation number in the layout, then by number.
    """

    parameters_model = BacklogThresholdParameters
    subscriptions = frozenset(
        {
            Trigger.NEW_ORDER,
            Trigger.ORDER_ASSIGNED,
            Trigger.ORDER_COMPLETED,
            Trigger.NEW_BUNDLE,
            Trigger.BUNDLE_SENT,
            Trigger.BUNDLE_ASSIGNED,
            Trigger.BUNDLE_STORED,
        }
    )

    def __init__(
        self, parameters: BacklogThresholdParameters, view: View, rng: np.random.Generator
    ) -> None:
        super().__init__(parameters, view, rng)
        self._started = False
        self._first: list[int] = []
        self._from_s = {True: 0.0, False: 0.0}
        self._order = {pick: activation_order(view, pick) for pick in (True, False)}

    def decide(self) -> Iterator[SwitchStation]:
        """Switch all stations on at the start; in later calls, switch at most one of each kind."""
        if not self._started:
            self._started = True
            self._from_s = dict.fromkeys(self._from_s, self.view.now_s + self.parameters.pause_s)
            self._first = [station.index for station in self.view.stations]
        while self._first:  # a copy of the run in the middle of a turn goes on from here
            station = self._first.pop(0)
            if not self.view.stations[station].active:
                yield SwitchStation(station, active=True)
        for pick, from_s in self._from_s.items():
            if self.view.now_s < from_s:
                continue
            switch = self._switch(pick)
            if switch is not None:
                self._from_s[pick] = self.view.now_s + self.parameters.pause_s
                yield switch

    def next_event_s(self) -> float:
        """Return the simulated time, in s, at which the next pause ends; inf if there is none."""
        return min((at_s for at_s in self._from_s.values() if at_s > self.view.now_s), default=inf)

    def _switch(self, pick: bool) -> SwitchStation | None:
        active = [s for s in self._order[pick] if self.view.stations[s].active]
        wants_on, wants_off = self._wants_on(pick), self._used_share(pick) < self._share_off(pick)
        if wants_on and not wants_off and len(active) < len(self._order[pick]):
            off = next(s for s in self._order[pick] if s not in active)
            return SwitchStation(off, active=True)
        if wants_off and not wants_on and len(active) > 1:
            return SwitchStation(active[-1], active=False)
        return None

    def _wants_on(self, pick: bool) -> bool:
        if pick:
            return len(self.view.orders) > self.parameters.orders_on
        return len(self.view.bundles) > self.parameters.bundles_on

    def _share_off(self, pick: bool) -> float:
        given = self.parameters
        return given.pick_share_off if pick else given.replenishment_share_off

    def _used_share(self, pick: bool) -> float:
        """Share of slots, or space, in use at the active stations; 1 if there are none."""
        if pick:
            picks = [station for station in self.view.pick_stations if station.active]
            used: float = sum(len(station.orders) for station in picks)
            room: float = sum(station.slots for station in picks)
        else:
            others = [station for station in self.view.replenishment_stations if station.active]
            used = sum(station.used for station in others)
            room = sum(station.capacity for station in others)
        return used / room if room else 1.0

"""Packers, who pack complete orders, first come, first served."""

from __future__ import annotations

from collections import deque
from functools import partial
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import numpy as np

    from rmfs.observer import Observer
    from rmfs.scenario.parameters import Packing
    from rmfs.simulation.agenda import Agenda
    from rmfs.world import World
    from rmfs.world.put_wall import Parcel


class Packers:
    """Identical packers.

    Parameters
    ----------
    given
        Number of packers, and packing times.
    rng
        Random generator of packing times.

    Attributes
    ----------
    waiting
        Parcels that wait for a packer, in the order of their arrival.
    busy
        Number of busy packers.
    """

    def __init__(
        self,
        given: Packing,
        *,
        agenda: Agenda,
        world: World,
        events: Observer,
        rng: np.random.Generator,
    ) -> None:
        self._given = given
        self._agenda, self._world, self._events = agenda, world, events
        self._rng = rng
        self.waiting: deque[Parcel] = deque()
        self.busy = 0

    def add(self, parcel: Parcel) -> None:
        """Pack an order as soon as a packer is free."""
        if self._given.packers is None or self.busy < self._given.packers:
            self._begin(parcel)
        else:
            self.waiting.append(parcel)

    def _begin(self, parcel: Parcel) -> None:
        self.busy += 1
        parcel.packing_s = self._world.now_s
        us = round(self._seconds(parcel) * 1e6)
        if us:
            self._agenda.after(us, partial(self._end, parcel))
        else:
            self._end(parcel)

    def _seconds(self, parcel: Parcel) -> float:
        mean_s = self._given.order_s + self._given.part_s * len(parcel.totes)
        variation = self._given.variation
        if not variation or not mean_s:
            return mean_s
        square = variation**2
        return float(self._rng.gamma(1.0 / square, mean_s * square))

    def _end(self, parcel: Parcel) -> None:
        wall, now_s = self._world.put_wall, self._world.now_s
        assert wall is not None
        self.busy -= 1
        wall.pack(parcel, now_s)
        self._events.order_packed(parcel)
        if self.waiting:
            self._begin(self.waiting.popleft())

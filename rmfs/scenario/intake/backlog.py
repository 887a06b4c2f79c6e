"""Backlogs of constant length."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rmfs.scenario.clock import NEVER_US, US_PER_S, first_us
from rmfs.scenario.intake.intake import BundleArrival, OrderArrival
from rmfs.scenario.top_up import BundleTopUp, OrderTopUp

if TYPE_CHECKING:
    from rmfs.scenario.bundles import BundleSource
    from rmfs.scenario.clock import Openings
    from rmfs.scenario.intake.contents import Contents
    from rmfs.scenario.intake.state import State
    from rmfs.scenario.parameters import BacklogDemand, BacklogReplenishment


class Rest:
    """Blocks a process of an intake in down periods, and for a while after a failed draw.

    A draw fails if stock cannot serve the order drawn, or the bundle drawn would exceed the load
    limit.

    Attributes
    ----------
    until_us
        Time at which the process may continue; `NEVER_US` if it is not blocked.
    """

    def __init__(self, openings: Openings) -> None:
        self._openings = openings
        self._always_open = openings.always
        self._blocked_us = 0
        self.until_us = NEVER_US

    def ends(self, now_us: int) -> bool:
        """Return whether the process may continue at a time, and update `until_us`."""
        until_us = self._blocked_us
        if not self._always_open:
            until_us = self._openings.open_from_us(max(now_us, until_us))
        if until_us > now_us:
            self.until_us = until_us
            return False
        self.until_us = NEVER_US
        return True

    def block(self, now_us: int, until_s: float) -> None:
        """Block the process until a time."""
        self._blocked_us = first_us(until_s)
        self.ends(now_us)


class BacklogOrders:
    """An intake process that tops up a backlog of orders.

    Parameters
    ----------
    config
        The table `demand` of a scenario.
    contents
        Draws the contents of orders.
    capacity
        Total capacity of all pods, in space units.
    openings
        Tells whether a time is outside the down periods, in which nothing is generated.
    """

    def __init__(
        self, config: BacklogDemand, contents: Contents, capacity: float, openings: Openings
    ) -> None:
        self._top_up = OrderTopUp(config, capacity)
        self._contents = contents
        self._rest = Rest(openings)
        self._drawn = 0

    @property
    def next_us(self) -> int:
        """End of the current pause or down period in us; `NEVER_US` if there is none."""
        return self._rest.until_us

    def draw(self, now_us: int, state: State) -> OrderArrival | None:
        """Return an order, or None.

        The result is None in a pause or down period, if the backlog is full, or if stock cannot
        serve the order drawn.
        """
        # called in any case, since it has to observe every change of stock
        wanted = self._top_up.wants(now_us / US_PER_S, state.waiting_orders, state.stored_space)
        if not self._rest.ends(now_us) or not wanted:
            return None
        content = self._contents(self._drawn, state)
        self._drawn += 1
        if content is None:
            self._top_up.failed(now_us / US_PER_S)
            self._rest.block(now_us, self._top_up.blocked_until_s)
            return None
        return OrderArrival.of(content, now_us)


class BacklogBundles:
    """An intake process that tops up a backlog of bundles.

    Parameters
    ----------
    config
        The table `replenishment` of a scenario.
    source
        Draws bundles.
    capacity
        Total capacity of all pods, in space units.
    openings
        Tells whether a time is outside the down periods, in which nothing is generated.
    """

    def __init__(
        self,
        config: BacklogReplenishment,
        source: BundleSource,
        capacity: float,
        openings: Openings,
    ) -> None:
        self._top_up = BundleTopUp(config, capacity)
        self._source = source
        self._rest = Rest(openings)
        self._drawn = 0

    @property
    def next_us(self) -> int:
        """End of the current pause or down period in us; `NEVER_US` if there is none."""
        return self._rest.until_us

    def draw(self, now_us: int, state: State) -> BundleArrival | None:
        """Return a bundle, or None.

        The result is None in a pause or down period, if the backlog is full, or if the bundle drawn
        would exceed the load limit.
        """
        load = state.load
        wanted = self._top_up.wants(now_us / US_PER_S, state.waiting_bundles, load)
        if not self._rest.ends(now_us) or not wanted:
            return None
        content = self._source.draw(self._drawn)
        self._drawn += 1
        if not self._top_up.accepts(load, content.space):
            self._top_up.failed(now_us / US_PER_S)
            self._rest.block(now_us, self._top_up.blocked_until_s)
            return None
        return BundleArrival(now_us, *content)

"""Topping up of a backlog, with pauses that depend on the stock level or follow a failure."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from rmfs.scenario.parameters import BacklogDemand, BacklogReplenishment


class Hysteresis:
    """A switch that turns on above one level and off below another.

    Parameters
    ----------
    on_above, off_below
        The two levels, `off_below` <= `on_above`; at a level itself nothing changes.
    on
        State at the start.
    """

    def __init__(self, on_above: float, off_below: float, *, on: bool) -> None:
        self._on_above = on_above
        self._off_below = off_below
        self.on = on

    def update(self, level: float) -> bool:
        """Update the switch with the current level, and return its state."""
        if level > self._on_above:
            self.on = True
        elif level < self._off_below:
            self.on = False
        return self.on


class _TopUp:
    """A backlog that pauses after something could not be generated.

    Parameters
    ----------
    capacity
        Space units of all pods together.
    retry_s
        Length of the pause.
    switch
        The switch that pauses it.
    """

    def __init__(self, capacity: float, retry_s: float, switch: Hysteresis) -> None:
        self._capacity = capacity
        self._retry_s = retry_s
        self._switch = switch
        self.blocked_until_s = 0.0

    def failed(self, time_s: float) -> None:
        """Start a pause because nothing could be generated."""
        self.blocked_until_s = time_s + self._retry_s


class OrderTopUp(_TopUp):
    """Determines when the next order of a constant backlog is generated.

    Parameters
    ----------
    config
        The table `demand` of a scenario.
    capacity
        Space units of all pods together.
    """

    def __init__(self, config: BacklogDemand, capacity: float) -> None:
        enough = Hysteresis(config.resume_above_share, config.pause_below_share, on=True)
        super().__init__(capacity, config.retry_s, enough)
        self._config = config

    def wants(self, time_s: float, waiting: int, stored: float) -> bool:
        """Return whether an order should be generated now.

        To be called after every change of stock or backlog, since a pause starts when the stock
        falls below a level.

        Parameters
        ----------
        time_s
            Current simulated time.
        waiting
            Number of orders not yet assigned to a station.
        stored
            Space units stored on all pods.
        """
        enough = self._switch.update(stored / self._capacity) or not self._config.pause_by_stock
        return enough and waiting < self._config.orders and time_s >= self.blocked_until_s


class BundleTopUp(_TopUp):
    """Determines when the next bundle of a constant backlog is generated.

    All loads are in space units.

    Parameters
    ----------
    config
        The table `replenishment` of a scenario.
    capacity
        Space units of all pods together.
    """

    def __init__(self, config: BacklogReplenishment, capacity: float) -> None:
        full = Hysteresis(config.pause_above_share, config.resume_below_share, on=False)
        super().__init__(capacity, config.retry_s, full)
        self._config = config

    def wants(self, time_s: float, waiting: int, load: float) -> bool:
        """Return whether a bundle should be generated now; to be called like `OrderTopUp.wants`.

        Parameters
        ----------
        time_s
            Current simulated time.
        waiting
            Number of bundles that lack a station, a pod, or both.
        load
            Space units of stored units, bundles assigned to pods, and waiting bundles.
        """
        full = self._switch.update(load / self._capacity) and self._config.pause_by_stock
        return not full and waiting < self._config.bundles and time_s >= self.blocked_until_s

    def accepts(self, load: float, space: float) -> bool:
        """Return whether a bundle of this size may be added; if not, the caller calls `failed`."""
        return load + space <= self._config.load_limit_share * self._capacity

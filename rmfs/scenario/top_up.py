"""Topping up of a backlog, with pauses that depend on the stock or follow a failed attempt."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from rmfs.scenario.parameters import BacklogDemand, BacklogReplenishment


class Hysteresis:
    """A switch that turns on above one level and off below another.

    Parameters
    ----------
    on_above, off_below
        The two levels, `off_below` <= `on_above`; at exactly one of them, nothing changes.
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
    """Topping up of a backlog, with a pause after an order or bundle could not be generated.

    Parameters
    ----------
    capacity
        Space units of all pods together.
    retry_s
        Length of the pause.
    switch
        The switch that depends on the stock.
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
        self._by_stock, self._most = config.pause_by_stock, config.orders

    def wants(self, time_s: float, waiting: int, stored: float) -> bool:
        """Return whether an order should be generated now.

        Has to be called after every change of the stock or the backlog, so that it notices whenever
        the stock crosses one of the levels at which a pause starts or ends.

        Parameters
        ----------
        time_s
            Current simulated time.
        waiting
            Number of orders not yet assigned to a station.
        stored
            Space taken by the stored units of all pods, in space units.
        """
        enough = self._switch.update(stored / self._capacity) or not self._by_stock
        return enough and waiting < self._most and time_s >= self.blocked_until_s


class BundleTopUp(_TopUp):
    """Determines when the next bundle of a constant backlog is generated.

    The load is the space taken by stored units, by bundles on their way into pods and by waiting
    bundles, in space units.

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
        self._by_stock, self._most = config.pause_by_stock, config.bundles
        self._load_limit_share = config.load_limit_share

    def wants(self, time_s: float, waiting: int, load: float) -> bool:
        """Return whether a bundle should be generated now.

        Has to be called after every change of the load or the backlog, like `OrderTopUp.wants`.

        Parameters
        ----------
        time_s
            Current simulated time.
        waiting
            Number of bundles that lack a station, a pod, or both.
        load
            Current load (see the class).
        """
        full = self._switch.update(load / self._capacity) and self._by_stock
        return not full and waiting < self._most and time_s >= self.blocked_until_s

    def accepts(self, load: float, space: float) -> bool:
        """Return whether the load limit admits a bundle; if not, the caller has to call `failed`.

        Parameters
        ----------
        load
            Load without the bundle.
        space
            Space units of the bundle.
        """
        return load + space <= self._load_limit_share * self._capacity

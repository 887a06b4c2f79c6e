"""Determines when orders and bundles are generated to keep a backlog constant."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from rmfs.scenario.parameters import BacklogDemand, BacklogReplenishment


class Hysteresis:
    """A switch that turns on above one level and off below another.

    Parameters
    ----------
    on_above, off_below
        The two levels, `off_below` <= `on_above`. From `off_below` to `on_above`, both included,
        the switch keeps its state.
    on
        Whether the switch is on initially.
    """

    def __init__(self, on_above: float, off_below: float, *, on: bool) -> None:
        self._on_above = on_above
        self._off_below = off_below
        self.on = on

    def update(self, level: float) -> bool:
        """Update the switch for the current level; return whether it is on."""
        if level > self._on_above:
            self.on = True
        elif level < self._off_below:
            self.on = False
        return self.on


class _TopUp:
    """Tops up a backlog, with a pause whenever an order or bundle could not be generated.

    Parameters
    ----------
    capacity
        Capacity of all pods together, in space units.
    retry_s
        Length of the pause.
    switch
        The switch that pauses and resumes the generation depending on the stock.
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
        Capacity of all pods together, in space units.
    """

    def __init__(self, config: BacklogDemand, capacity: float) -> None:
        enough = Hysteresis(config.resume_above_share, config.pause_below_share, on=True)
        super().__init__(capacity, config.retry_s, enough)
        self._by_stock, self._most = config.pause_by_stock, config.orders

    def wants(self, time_s: float, waiting: int, stored: float) -> bool:
        """Return whether an order should be generated now.

        This method must be called after every change of the stock or the backlog. Otherwise, it
        might miss that the stock has crossed a level at which a pause starts or ends.

        Parameters
        ----------
        time_s
            Current simulated time.
        waiting
            Number of orders not yet assigned to a station.
        stored
            Space taken by the units stored in all pods, in space units.
        """
        enough = self._switch.update(stored / self._capacity) or not self._by_stock
        return enough and waiting < self._most and time_s >= self.blocked_until_s


class BundleTopUp(_TopUp):
    """Determines when the next bundle of a constant backlog is generated.

    The load is the space, in space units, taken by all stored units and by all bundles that have
    arrived and are not stored yet.

    Parameters
    ----------
    config
        The table `replenishment` of a scenario.
    capacity
        Capacity of all pods together, in space units.
    """

    def __init__(self, config: BacklogReplenishment, capacity: float) -> None:
        full = Hysteresis(config.pause_above_share, config.resume_below_share, on=False)
        super().__init__(capacity, config.retry_s, full)
        self._by_stock, self._most = config.pause_by_stock, config.bundles
        self._load_limit_share = config.load_limit_share

    def wants(self, time_s: float, waiting: int, load: float) -> bool:
        """Return whether a bundle should be generated now.

        This method must be called after every change of the load or the backlog (see
        `OrderTopUp.wants`).

        Parameters
        ----------
        time_s
            Current simulated time.
        waiting
            Number of bundles that lack a station, a pod, or both.
        load
            Current load, as defined in the description of the class.
        """
        full = self._switch.update(load / self._capacity) and self._by_stock
        return not full and waiting < self._most and time_s >= self.blocked_until_s

    def accepts(self, load: float, space: float) -> bool:
        """Return whether a bundle fits within the load limit.

        If it does not, the caller must call `failed`.

        Parameters
        ----------
        load
            Load without the bundle.
        space
            Space that the bundle takes, in space units.
        """
        return load + space <= self._load_limit_share * self._capacity

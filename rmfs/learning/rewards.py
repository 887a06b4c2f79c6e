"""Rewards: amounts accumulated since the last decision.

Like a measure, a reward observes the run (`rmfs.observer.Observer`); it is copied with the run.
Rewards are amounts (of units, orders or metres), not rates. The time between decisions varies;
`info["elapsed_s"]` is the time, in s, over which an amount was accumulated.
"""

from __future__ import annotations

from heapq import heappop, heappush
from math import isfinite
from numbers import Real
from typing import TYPE_CHECKING

from rmfs.errors import InputError
from rmfs.observer import Observer
from rmfs.references import is_reference, resolve

if TYPE_CHECKING:
    from collections.abc import Mapping

    from rmfs.observer import Observed
    from rmfs.world.orders import Bundle, Order

    Wanted = str | type["Reward"] | Mapping[str, float]
    """How a reward is selected: a name, a class, a reference to a class, or weights by name."""


class Reward(Observer):
    """Base class of rewards: an amount that accumulates during the run.

    A user-defined reward overrides the callbacks that it needs; these change `self.amount`. The
    reward must contain only plain data, because it is copied and saved with the run. Its class must
    be constructible without arguments.

    Attributes
    ----------
    amount
        Amount accumulated since the last call of `take`.
    """

    amount: float = 0.0

    def take(self) -> float:
        """Return the amount accumulated since the last call, and reset it to 0."""
        amount, self.amount = self.amount, 0.0
        return float(amount)


class Units(Reward):
    """Reward of 1 for every unit picked."""

    def unit_picked(
        self,
        time_s: float,
        order: Order,
        sku: int,
        pod: int,
        robot: int,
        station: int,
        late_bound: bool,
    ) -> None:
        """Add 1."""
        self.amount += 1.0


class Orders(Reward):
    """Reward of 1 for every order completed."""

    def order_completed(self, order: Order) -> None:
        """Add 1."""
        self.amount += 1.0


class Lateness(Reward):
    """Reward of -1 per second of tardiness of each completed order."""

    def order_completed(self, order: Order) -> None:
        """Subtract the tardiness of the order, in s."""
        self.amount -= max(0.0, order.completed_s - order.due_s)


class LateOrders(Reward):
    """Reward of -1 for every order completed after its due time."""

    def order_completed(self, order: Order) -> None:
        """Subtract 1 if the order is late."""
        self.amount -= order.completed_s > order.due_s


class OverdueOrders(Reward):
    """Reward of -1 for every order not completed by its due time, given when this time has passed.

    Unlike `LateOrders`, this reward also counts orders that are never completed.
    """

    def __init__(self) -> None:
        self._open: set[int] = set()
        self._due: list[tuple[float, int]] = []

    def run_started(self, run: Observed) -> None:
        """Keep a reference to the world, which provides the time."""
        self._world = run.world

    def order_created(self, order: Order) -> None:
        """Record the due time of an order."""
        self._open.add(order.index)
        heappush(self._due, (order.due_s, order.index))

    def order_cancelled(self, order: Order) -> None:
        """Count the orders that have become overdue, then remove the cancelled one."""
        self._catch_up()
        self._open.discard(order.index)

    def order_completed(self, order: Order) -> None:
        """Count the orders that have become overdue, then remove the completed one."""
        self._catch_up()
        self._open.discard(order.index)

    def take(self) -> float:
        """Return minus the number of orders that have become overdue since the last call."""
        self._catch_up()
        return super().take()

    def _catch_up(self) -> None:
        due, now_s = self._due, self._world.now_s
        while due and due[0][0] < now_s:
            _, order = heappop(due)
            if order in self._open:
                self._open.discard(order)
                self.amount -= 1.0


class Stored(Reward):
    """Reward of 1 for every unit stored in a pod."""

    def bundle_stored(self, bundle: Bundle, robot: int) -> None:
        """Add the number of units in the bundle."""
        self.amount += bundle.units


class Turnover(Reward):
    """Reward of -1 per second of turnover time of each completed order."""

    def order_completed(self, order: Order) -> None:
        """Subtract the time from the arrival of the order to its completion, in s."""
        self.amount -= order.completed_s - order.created_s


class Distance(Reward):
    """Reward of -1 for every metre that a robot drives."""

    def __init__(self) -> None:
        self._known_m = 0.0

    def run_started(self, run: Observed) -> None:
        """Keep a reference to the traffic model, which counts the distance driven."""
        self._traffic = run.traffic

    def warmup_ended(self, time_s: float) -> None:
        """Subtract the distance driven so far, because the traffic model resets its count to 0."""
        self._catch_up()
        self._known_m = 0.0

    def take(self) -> float:
        """Return minus the distance driven since the last call, in m."""
        self._catch_up()
        return super().take()

    def _catch_up(self) -> None:
        driven_m = float(self._traffic.motion()["distance_m"].sum())
        self.amount -= driven_m - self._known_m
        self._known_m = driven_m


class Weighted(Reward):
    """A weighted sum of rewards.

    Parameters
    ----------
    parts
        Pairs of a reward and its weight. These rewards observe the run; their sum does not.
    """

    def __init__(self, parts: list[tuple[Reward, float]]) -> None:
        self.parts = parts

    def take(self) -> float:
        """Return the weighted sum of the amounts of all parts, and reset these amounts to 0."""
        return sum(weight * part.take() for part, weight in self.parts)


REWARDS: dict[str, type[Reward]] = {
    "units": Units,
    "orders": Orders,
    "lateness": Lateness,
    "late-orders": LateOrders,
    "overdue-orders": OverdueOrders,
    "units-stored": Stored,
    "turnover": Turnover,
    "distance": Distance,
}
"""Rewards by name."""


def reward_of(wanted: Wanted) -> Reward:
    """Create a reward.

    Parameters
    ----------
    wanted
        A name in `REWARDS`; a class derived from `Reward`, or a reference to one
        (`path/to/file.py:Class`); or weights by name, such as `{"units": 1, "distance": 0.01}`.

    Raises
    ------
    InputError
        If a reward does not exist, a weight is not a number, or `wanted` is empty.
    """
    if isinstance(wanted, (str, type)):
        return _one(wanted)
    if not wanted:
        raise InputError("reward: must name at least one reward")
    for name, weight in wanted.items():
        if not isinstance(weight, Real) or not isfinite(weight):
            raise InputError(f"reward {name}: its weight must be a number (given: {weight!r})")
    return Weighted([(_one(name), float(weight)) for name, weight in wanted.items()])


def observers_of(reward: Reward) -> list[Observer]:
    """Return the observers that a reward adds to a run: the reward itself or its weighted parts."""
    return [part for part, _ in reward.parts] if isinstance(reward, Weighted) else [reward]


def _one(wanted: str | type[Reward]) -> Reward:
    if isinstance(wanted, str) and not is_reference(wanted):
        if wanted not in REWARDS:
            raise InputError(
                f"reward {wanted}: must be one of {', '.join(REWARDS)}, or path/to/file.py:Class"
            )
        return REWARDS[wanted]()
    return resolve(wanted, Reward, "reward")()

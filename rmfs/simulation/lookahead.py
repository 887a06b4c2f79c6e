"""Trials of decisions, in copies of a run whose future random events are drawn anew."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Protocol

from rmfs.control.lookahead import Tried
from rmfs.observer import Observer

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from rmfs.control.base import Controller
    from rmfs.control.lookahead import Goal, Trials
    from rmfs.control.problems import Problem
    from rmfs.observer import Observed
    from rmfs.world import World
    from rmfs.world.orders import Bundle, Order


class Trial(Protocol):
    """A copy of a run, with the methods that a trial needs."""

    world: World

    def take_over(
        self, problem: Problem, base: Controller[Any], decision: Any, watch: Observer
    ) -> None:
        """Apply a decision of a problem; the rule `base` makes all later ones of this problem."""
        ...

    def run_until(self, time_s: float) -> Any:
        """Continue the run up to a time in s."""
        ...

    @property
    def instants(self) -> int:
        """Number of instants simulated so far."""
        ...

    def observed(self) -> Observed:
        """Return the parts of the run that observers may see."""
        ...


class Copies(Protocol):
    """Creates copies of a saved state of a run."""

    def __call__(self, path: tuple[int, ...]) -> tuple[Trial, Any]:
        """Return copies of the run and of the object saved with it.

        The copied run uses the random streams of `path`.
        """
        ...


class Forks:
    """Look-ahead for controllers: prepares trials of decisions in copies of the run.

    Parameters
    ----------
    snapshot
        Function that saves the state of the run and, with it, the object given as the argument,
        which may refer to parts of the run.
    """

    def __init__(self, snapshot: Callable[[Any], Copies]) -> None:
        self._snapshot = snapshot
        self._asked = 0

    def __call__(
        self,
        problem: Problem,
        decisions: Sequence[Any],
        base: Controller[Any],
        horizon_s: float,
        goal: Goal,
    ) -> Trials:
        """Prepare trials of some decisions; see `rmfs.control.lookahead.LookAhead`."""
        self._asked += 1
        copies = self._snapshot((list(decisions), base))
        return ForkedTrials(copies, problem, self._asked, horizon_s, goal)


class ForkedTrials:
    """Tries out decisions, each in a new copy of the run."""

    def __init__(
        self, copies: Copies, problem: Problem, number: int, horizon_s: float, goal: Goal
    ) -> None:
        self._copies = copies
        self._problem = problem
        self._number = number
        self._horizon_s = horizon_s
        self._goal = goal

    def __call__(self, which: int, sample: int) -> Tried:
        """Try out decision number `which` in future number `sample`."""
        trial, (decisions, base) = self._copies((self._number, sample))
        earnings = Earnings(self._goal, trial.world.now_s, self._horizon_s)
        earnings.run_started(trial.observed())
        before = trial.instants
        trial.take_over(self._problem, base, decisions[which], earnings)
        trial.run_until(trial.world.now_s + self._horizon_s)
        return Tried(earnings.value(trial.world), trial.instants - before)


class Earnings(Observer):
    """Computes the value of a trial from what is achieved in it."""

    def __init__(self, goal: Goal, begin_s: float, horizon_s: float) -> None:
        self._goal = goal
        self._begin_s, self._end_s = begin_s, begin_s + horizon_s
        self._horizon_s = horizon_s
        self._value = 0.0

    def run_started(self, run: Observed) -> None:
        """Keep a reference to the traffic model, which measures the distance driven."""
        self._traffic = run.traffic
        self._driven_m = self._metres() if self._goal.distance_m else 0.0

    def warmup_ended(self, time_s: float) -> None:
        """Deduct the cost of the metres driven so far, because their count is reset to 0."""
        if self._goal.distance_m:
            self._value -= self._goal.distance_m * (self._metres() - self._driven_m)
            self._driven_m = 0.0

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
        """Add the value of the unit, times the share of the horizon that is left."""
        self._value += self._goal.units * self._left(time_s)

    def order_completed(self, order: Order) -> None:
        """Add the value of the order, times the share of the horizon that is left.

        The cost of the order's overdue time within the horizon is subtracted.
        """
        goal = self._goal
        self._value += goal.orders * self._left(order.completed_s)
        self._value -= goal.overdue_s * self._overdue_s(order, order.completed_s)

    def order_cancelled(self, order: Order) -> None:
        """Subtract the cost of the order's overdue time within the horizon."""
        self._value -= self._goal.overdue_s * self._overdue_s(order, order.cancelled_s)

    def bundle_stored(self, bundle: Bundle, robot: int) -> None:
        """Add the value of the bundle's units, times the share of the horizon that is left."""
        self._value += self._goal.units_stored * bundle.units * self._left(bundle.stored_s)

    def value(self, world: World) -> float:
        """Return the value of the trial, with the costs of distance and overdue orders deducted.

        For an order that is not yet complete, the overdue time is counted up to the present time;
        for a cancelled order, up to its cancellation.
        """
        goal, value = self._goal, self._value
        if goal.overdue_s:
            still = list(world.orders)
            still += [order for one in world.pick_stations for order in one.orders.values()]
            # parts of a split order have the same number, and count as one order
            whole = {order.index: order for order in still}.values()
            value -= goal.overdue_s * sum(self._overdue_s(order, world.now_s) for order in whole)
        if goal.distance_m:
            value -= goal.distance_m * (self._metres() - self._driven_m)
        return value

    def _left(self, time_s: float) -> float:
        """Return the remaining share of the horizon."""
        return (self._end_s - time_s) / self._horizon_s

    def _overdue_s(self, order: Order, until_s: float) -> float:
        return max(0.0, until_s - max(order.due_s, self._begin_s))

    def _metres(self) -> float:
        return float(self._traffic.motion()["distance_m"].sum())

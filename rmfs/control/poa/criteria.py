"""Criteria of POA queue, selected and configured in a controllers file; the highest score wins."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Any, Literal, Protocol

import numpy as np
import pydantic

from rmfs.control.base import Parameters

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from rmfs.control.poa.contest import Contest

    Scores = NDArray[np.float64] | NDArray[np.int64] | NDArray[np.bool_]


class Criterion(Protocol):
    """Rates the orders of a contest; the highest score wins."""

    def score(self, contest: Contest, rng: np.random.Generator) -> Scores:
        """Return the scores of the orders, shape (N,)."""
        ...


class Random(Parameters):
    """Prefers an order drawn at random."""

    criterion: Literal["random"] = "random"

    def score(self, contest: Contest, rng: np.random.Generator) -> Scores:
        """Return scores drawn uniformly from [0, 1)."""
        return rng.random(len(contest))


class FirstCome(Parameters):
    """Prefers the order that arrived first."""

    criterion: Literal["first-come"] = "first-come"

    def score(self, contest: Contest, rng: np.random.Generator) -> Scores:
        """Return the negative of each order's number in the sequence of arrivals."""
        return -contest.view.orders.index[contest.rows]


class DueTime(Parameters):
    """Prefers the order that is due first."""

    criterion: Literal["due-time"] = "due-time"

    def score(self, contest: Contest, rng: np.random.Generator) -> Scores:
        """Return the negative of each order's due time in s."""
        return -contest.view.orders.due_s[contest.rows]


class DueSoon(Parameters):
    """Prefers orders that are late or due soon."""

    criterion: Literal["due-soon"] = "due-soon"
    within_s: Annotated[float, pydantic.Field(ge=0)] = 600.0
    """An order counts as due soon if it is due within this many seconds, or already late."""

    def score(self, contest: Contest, rng: np.random.Generator) -> Scores:
        """Return 1 for orders that are late or due soon, else 0."""
        view = contest.view
        return view.orders.due_s[contest.rows] <= view.now_s + self.within_s


class Weight(Parameters):
    """Prefers the orders whose lateness has the highest weight, which is set per order class."""

    criterion: Literal["weight"] = "weight"

    def score(self, contest: Contest, rng: np.random.Generator) -> Scores:
        """Return the weight of each order's lateness."""
        return contest.view.orders.weight[contest.rows]


class FirstWave(Parameters):
    """Prefers orders of the first wave.

    The wave consists of late orders and of those due at most `wave_s` after the next due time.
    """

    criterion: Literal["wave"] = "wave"
    wave_s: Annotated[float, pydantic.Field(ge=0, allow_inf_nan=False)] = 0.0
    """Orders due within this many seconds after the next due order belong to its wave."""

    def score(self, contest: Contest, rng: np.random.Generator) -> Scores:
        """Return 1 for orders of the first wave, else 0."""
        view = contest.view
        due_s = view.orders.due_s
        coming = due_s[due_s >= view.now_s]
        first_s = coming.min() if len(coming) else view.now_s
        return due_s[contest.rows] <= first_s + self.wave_s


class Size(Parameters):
    """Prefers the largest order."""

    criterion: Literal["size"] = "size"
    count: Literal["units", "lines"] = "units"
    """Whether size is counted in unpicked units or in order lines."""

    def score(self, contest: Contest, rng: np.random.Generator) -> Scores:
        """Return each order's number of unpicked units or, if `count` is `lines`, of its lines."""
        if self.count == "lines":
            sizes = [len(order.lines) for order in contest.orders()]
        else:
            sizes = [order.unpicked_units for order in contest.orders()]
        return np.array(sizes, np.int64)


class Completable(Parameters):
    """Prefers orders that pods at the station, or on their way there, can complete."""

    criterion: Literal["completable"] = "completable"
    by: Literal["nearest-pod", "all-pods"] = "nearest-pod"
    """Which pods must be able to complete the order: the nearest pod alone (`nearest-pod`; no unit
    of the order may then be bound to another pod), or all pods together (`all-pods`)."""

    def score(self, contest: Contest, rng: np.random.Generator) -> Scores:
        """Return 1 for orders that the pods considered (see `by`) can complete, else 0."""
        if self.by == "all-pods":
            return contest.completed_by_all()
        pods, _ = contest.inbound()
        return contest.completed_by(pods[0]) if pods else np.zeros(len(contest), np.bool_)


class InboundMatches(Parameters):
    """Prefers orders with the most SKUs on inbound pods; near pods count more.

    Inbound pods are at the station or on their way there. It is assumed that an order takes its
    units from these pods, nearest first, as far as the pods can spare them. For each pair of a SKU
    and a pod from which units of the SKU are taken, the order scores one point. If the pod counts
    as near, the order scores another point for each inbound pod that is farther away. A pod counts
    as near if the number of units of the SKU taken from it, times the pod's distance from the
    station in m, is at most `near_unit_metres`.
    """

    criterion: Literal["inbound-matches"] = "inbound-matches"
    near_unit_metres: Annotated[float, pydantic.Field(ge=0)] = 10.0
    """A pod counts as near if the units taken from it times its distance in m are at most this."""

    def score(self, contest: Contest, rng: np.random.Generator) -> Scores:
        """Return the points of each order."""
        pods, metres = contest.inbound()
        if not pods:
            return np.zeros(len(contest), np.int64)
        inventory, claimed = contest.view.inventory, contest.claimed()
        spare = inventory.inbound[contest.station.index] - claimed
        # most lines have nothing to take: look at the others only
        row, column = ((spare[contest.sku] > 0) & (contest.units > 0)).nonzero()
        sku = contest.sku[row, column]
        wanted = contest.units[row, column][:, None]
        have = inventory.available[sku[:, None], np.array(pods)]
        covered = have.cumsum(axis=1)
        covered -= claimed[sku][:, None]
        np.minimum(covered, wanted, out=covered)
        np.maximum(covered, 0, out=covered)
        taken = covered.copy()
        taken[:, 1:] -= covered[:, :-1]
        near = np.arange(len(pods), 0, -1)
        is_near = metres <= self.near_unit_metres / np.maximum(taken, 1)
        points = np.where(is_near, near, 1) * (taken > 0)
        # whole numbers, so that the sum is exact
        return np.bincount(row, weights=points.sum(axis=1), minlength=len(contest))


class Related(Parameters):
    """Prefers orders with the largest share of lines for SKUs that are also in other orders.

    The other orders are those in the station's pool when orders compete for a place in the pool,
    and those with a slot at the station when orders compete for a slot.
    """

    criterion: Literal["related"] = "related"

    def score(self, contest: Contest, rng: np.random.Generator) -> Scores:
        """Return, for each order, the share of its lines for SKUs that are also in other orders.

        Of the order's own lines, only those with units not yet bound to a pod count. The other
        orders are those in the pool if the contest is for the pool, else those with a slot.
        """
        is_line = contest.units > 0
        shared = contest.company()[contest.sku] & is_line
        shares: NDArray[np.float64] = shared.sum(axis=1) / np.maximum(is_line.sum(axis=1), 1)
        return shares


def _by_name(value: Any) -> Any:
    """Accept a plain name as a criterion with default parameters."""
    return {"criterion": value} if isinstance(value, str) else value


OrderCriterion = Annotated[
    Random
    | FirstCome
    | DueTime
    | DueSoon
    | Weight
    | FirstWave
    | Size
    | Completable
    | InboundMatches
    | Related,
    pydantic.Field(discriminator="criterion"),
    pydantic.BeforeValidator(_by_name),
]


def best(
    contests: list[Contest],
    criteria: tuple[OrderCriterion, ...],
    rng: np.random.Generator,
    first: list[Scores] | None = None,
) -> tuple[Contest, int] | None:
    """Find the best order by the first criterion; each further criterion breaks remaining ties.

    If all criteria leave a tie, it goes to the order that arrived first, then to the first contest.

    Parameters
    ----------
    first
        For each contest, the scores of its orders by the first criterion, if already known.

    Returns
    -------
    tuple or None
        Contest of the winning order, and the order's row in the backlog; None if there are no
        orders.
    """
    left = [contest for contest in contests if len(contest)]
    for number, criterion in enumerate(criteria):
        if sum(len(contest) for contest in left) < 2:
            break
        if number == 0 and first is not None:
            scores = [s for s in first if len(s)]
        else:
            scores = [criterion.score(contest, rng) for contest in left]
        highest = max(given.max() for given in scores)
        left = [
            contest.narrowed(given == highest)
            for contest, given in zip(left, scores, strict=True)
            if given.max() == highest
        ]
    arrivals = [(contest, contest.view.orders.index[contest.rows]) for contest in left]
    if not arrivals:
        return None
    winner, index = min(arrivals, key=lambda pair: int(pair[1].min()))
    return winner, int(winner.rows[index.argmin()])

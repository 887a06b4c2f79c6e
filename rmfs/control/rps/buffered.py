"""Base classes of RPS rules that hold bundles back until a trip of their pod is worthwhile."""

from __future__ import annotations

from abc import abstractmethod
from math import inf
from typing import TYPE_CHECKING, Annotated, Any, TypeVar

import pydantic

from rmfs.control.base import Parameters
from rmfs.control.decisions import PromiseBundle, ReleasePod
from rmfs.control.problems import Trigger
from rmfs.control.rps import ReplenishmentPodSelection
from rmfs.control.turns import Turn

if TYPE_CHECKING:
    from collections.abc import Iterator

    import numpy as np
    from numpy.typing import NDArray

    from rmfs.control.view import View
    from rmfs.world.orders import Bundle


P = TypeVar("P", bound=Parameters)


class Buffered(ReplenishmentPodSelection[P]):
    """Promises bundles to pods one by one, and releases the bundles of a pod together.

    The bundles of a pod are released when enough of the pod's capacity is used or promised
    (`threshold`), or when a certain time has passed since the last promise to the pod
    (`timeout_s`). If this rule has replaced another rule, bundles that the other rule promised but
    did not release are treated in the same way.
    """

    def __init__(self, parameters: P, view: View, rng: np.random.Generator) -> None:
        super().__init__(parameters, view, rng)
        self._is_new = True

    @abstractmethod
    def choose(self, bundle: Bundle) -> int:
        """Choose a pod with room for the bundle; -1 if there is none."""

    @abstractmethod
    def threshold(self, pod: int) -> float:
        """Return the share of a pod's capacity at which its promised bundles are released.

        The share includes the capacity that is used and the capacity that is promised.
        """

    @abstractmethod
    def timeout_s(self, pod: int) -> float:
        """Return the time, in s, from the last promise to a pod to the release of its bundles."""

    @property
    @abstractmethod
    def shortest_timeout_s(self) -> float:
        """A lower bound of `timeout_s` over all pods, in s."""

    def candidates(self) -> list[Bundle]:
        """List the bundles for which a pod can be chosen now, in order of arrival."""
        return list(self.view.bundles.without_pod.values())

    def fits(self, bundle: Bundle) -> NDArray[np.bool_]:
        """Return whether each of the P pods has room for a bundle, shape (P,)."""
        inventory = self.view.inventory
        return inventory.load + bundle.space <= inventory.capacity

    def best(self, bundle: Bundle, scores: NDArray[Any]) -> int:
        """Find the pod with the lowest score among those with room; -1 if there is none.

        Ties go to the pod with the lowest number.
        """
        fits = self.fits(bundle)
        pod = int(scores.argmin())
        if fits[pod]:
            return pod
        pods = fits.nonzero()[0]
        return int(pods[scores[pods].argmin()]) if len(pods) else -1

    def decide(self) -> Iterator[PromiseBundle | ReleasePod]:
        """Return a promise for each bundle that fits into a pod, and the releases that are due."""
        return Promises(self)

    def next_event_s(self) -> float:
        """Return the simulated time in s at which the next time-out expires, or inf."""
        since = self.view.bundles.unreleased_since_s
        earliest_s = inf
        for pod, time_s in since.items():
            # pods are in order of their last promise
            if time_s + self.shortest_timeout_s >= earliest_s:
                break
            earliest_s = min(earliest_s, time_s + self.timeout_s(pod))
        return earliest_s

    def begins(self) -> bool:
        """Return whether the rule decides for the first time."""
        is_new, self._is_new = self._is_new, False
        return is_new

    def is_full(self, pod: int) -> bool:
        """Return whether a pod has reached the threshold at which its bundles are released."""
        inventory = self.view.inventory
        # a quotient: the product of 0.55 and 100, say, is above 55
        return inventory.load.item(pod) / inventory.capacity.item(pod) >= self.threshold(pod)


class Promises(Turn[PromiseBundle | ReleasePod]):
    """The decisions of one call of a rule.

    Releases of pods that another rule has filled come first, if the rule decides for the first
    time. They are followed by the promises, each with the release of the pod that it fills, and by
    the releases of pods whose time-out has expired.
    """

    def __init__(self, rule: Buffered[Any]) -> None:
        self._rule = rule
        self._pods: Iterator[int] | None = None
        self._bundles: Iterator[Bundle] | None = None
        self._due: Iterator[tuple[int, float]] | None = None
        self._promised = -1
        self._room = inf

    def __next__(self) -> PromiseBundle | ReleasePod:
        decision = self._release_full() or self._promise() or self._release_due()
        if decision is None:
            raise StopIteration
        return decision

    def _release_full(self) -> ReleasePod | None:
        """Release the bundles of the next pod that has reached its threshold."""
        rule = self._rule
        if self._pods is None:
            self._pods = iter(list(rule.view.bundles.unreleased_since_s) if rule.begins() else [])
        for pod in self._pods:
            if rule.is_full(pod):
                return ReleasePod(pod)
        pod, self._promised = self._promised, -1
        return ReleasePod(pod) if pod >= 0 and rule.is_full(pod) else None

    def _promise(self) -> PromiseBundle | None:
        """Promise the next bundle for which there is a pod."""
        rule, inventory = self._rule, self._rule.view.inventory
        if self._bundles is None:
            self._bundles = iter(rule.candidates())
        for bundle in self._bundles:
            # bundles that no pod can take are passed over without a search for each
            if bundle.space > self._room:
                continue
            pod = rule.choose(bundle)
            if pod >= 0:
                self._promised = pod
                return PromiseBundle(bundle, pod)
            self._room = float((inventory.capacity - inventory.load).max())
        return None

    def _release_due(self) -> ReleasePod | None:
        """Release the bundles of the next pod whose time-out has expired."""
        rule = self._rule
        if self._due is None:
            self._due = iter(list(rule.view.bundles.unreleased_since_s.items()))
        for pod, time_s in self._due:
            if time_s + rule.shortest_timeout_s > rule.view.now_s:
                self._due = iter(())
                return None
            if time_s + rule.timeout_s(pod) <= rule.view.now_s:
                return ReleasePod(pod)
        return None


class BufferParameters(Parameters):
    """Parameters of RPS rules that hold bundles back."""

    buffer_threshold: Annotated[float, pydantic.Field(ge=0, le=1)] = 0.8
    """The bundles promised to a pod are released to ROA when at least this share of the pod's
    capacity is used or promised to bundles."""
    buffer_timeout_s: Annotated[float, pydantic.Field(ge=0)] = 1200.0
    """Maximum time in seconds from the last promise to a pod until the bundles promised to the pod
    are released to ROA."""


class StickyParameters(BufferParameters):
    """Parameters of RPS rules that fill one pod after another."""

    stick_to_pod: bool = True
    """Whether the pod chosen for the previous bundle is chosen again, until a bundle does not fit
    or a replenishment station serves the pod."""


B = TypeVar("B", bound=BufferParameters)
S = TypeVar("S", bound=StickyParameters)


class EvenlyBuffered(Buffered[B]):
    """Base class of rules with the same threshold and the same time-out for all pods."""

    def threshold(self, pod: int) -> float:
        """Return `buffer_threshold`: the threshold of every pod, as a share of its capacity."""
        return self.parameters.buffer_threshold

    def timeout_s(self, pod: int) -> float:
        """Return `buffer_timeout_s`: the time-out of every pod, in s."""
        return self.parameters.buffer_timeout_s

    @property
    def shortest_timeout_s(self) -> float:
        """The time-out of every pod, in s (`buffer_timeout_s`)."""
        return self.parameters.buffer_timeout_s


class Sticky(EvenlyBuffered[S]):
    """Base class of rules that fill one pod after another (`stick_to_pod`)."""

    hears = frozenset({Trigger.BUNDLE_STORED})

    def __init__(self, parameters: S, view: View, rng: np.random.Generator) -> None:
        super().__init__(parameters, view, rng)
        self._last = -1

    def choose(self, bundle: Bundle) -> int:
        """Choose the same pod as last time or, if impossible, another; -1 if no pod has room."""
        inventory = self.view.inventory
        last = self._last
        if last >= 0 and inventory.load[last] + bundle.space <= inventory.capacity[last]:
            return last
        pod = self.choose_anew(bundle)
        if self.parameters.stick_to_pod and pod >= 0:
            self._last = pod
        return pod

    @abstractmethod
    def choose_anew(self, bundle: Bundle) -> int:
        """Choose a pod with room for the bundle; -1 if there is none."""

    def hear(self, trigger: Trigger, subject: Any) -> None:
        """Stop choosing the same pod if a bundle has been stored in it."""
        if subject.pod == self._last:
            self._last = -1

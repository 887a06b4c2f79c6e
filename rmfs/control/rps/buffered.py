"""Buffering of RPS decisions until a pod's trip is worth while, for all rules that do so."""

from __future__ import annotations

from abc import abstractmethod
from math import inf
from typing import TYPE_CHECKING, Annotated, Any, TypeVar

import pydantic

from rmfs.control.base import Parameters
from rmfs.control.decisions import PromiseBundle, ReleasePod
from rmfs.control.problems import Trigger
from rmfs.control.rps import ReplenishmentPodSelection

if TYPE_CHECKING:
    from collections.abc import Iterator

    import numpy as np

    from rmfs.control.view import View
    from rmfs.world.orders import Bundle


class BufferParameters(Parameters):
    """Parameters of RPS rules with a buffer."""

    buffer_threshold: Annotated[float, pydantic.Field(ge=0, le=1)] = 0.8
    """Share of a pod's capacity, stored and promised, at which its bundles are released."""
    buffer_timeout_s: Annotated[float, pydantic.Field(ge=0)] = 1200.0
    """They are released at the latest so long after the last bundle was promised to the pod."""


class StickyParameters(BufferParameters):
    """Parameters of RPS rules that fill one pod after the other."""

    stick_to_pod: bool = True
    """Whether the last pod is taken again while it has room and until a station serves it."""


P = TypeVar("P", bound=BufferParameters)
S = TypeVar("S", bound=StickyParameters)


class Buffered(ReplenishmentPodSelection[P]):
    """Promises bundles one by one and releases a pod's bundles together.

    The time-out is an event of its own; RAWSim-O looks at it whenever something else happens.
    """

    @abstractmethod
    def choose(self, bundle: Bundle) -> int:
        """Choose a pod whose load leaves room for the bundle; -1 if there is none."""

    def decide(self) -> Iterator[PromiseBundle | ReleasePod]:
        """Yield a promise for each bundle that fits, and releases as they become due."""
        inventory = self.view.inventory
        load, capacity = inventory.load.item, inventory.capacity.item
        # bundles that no pod can take are passed over without a search for each
        room = inf
        for bundle in list(self.view.bundles.without_pod.values()):
            if bundle.space > room:
                continue
            pod = self.choose(bundle)
            if pod < 0:
                room = float((inventory.capacity - inventory.load).max())
                continue
            yield PromiseBundle(bundle, pod)
            if load(pod) >= self.parameters.buffer_threshold * capacity(pod):
                yield ReleasePod(pod)
        yield from self._due()

    def next_event_s(self) -> float:
        """When the buffer of some pod times out."""
        since = self.view.bundles.unreleased_since_s
        # pods are in order of their last promise
        oldest = next(iter(since.values()), inf)
        return oldest + self.parameters.buffer_timeout_s

    def _due(self) -> Iterator[ReleasePod]:
        """Release the pods whose time is up."""
        since = self.view.bundles.unreleased_since_s
        while since:
            pod, time_s = next(iter(since.items()))
            if time_s + self.parameters.buffer_timeout_s > self.view.now_s:
                return
            yield ReleasePod(pod)


class Sticky(Buffered[S]):
    """Fills the last pod again while it has room and until a station serves it."""

    hears = frozenset({Trigger.BUNDLE_STORED})

    def __init__(self, parameters: S, view: View, rng: np.random.Generator) -> None:
        super().__init__(parameters, view, rng)
        self._last = -1

    def choose(self, bundle: Bundle) -> int:
        """Choose the last pod or, if that is not possible, as the rule says."""
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
        """Forget the last pod when it is served at a replenishment station."""
        if subject.pod == self._last:
            self._last = -1

"""RPS turnover: puts fast-moving SKUs into fast-moving pods, by classes."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Any

import numpy as np
import pydantic

from rmfs.control.problems import Trigger
from rmfs.control.rps.buffered import Buffered
from rmfs.control.trackers.turnover import TurnoverClasses, TurnoverParameters

if TYPE_CHECKING:
    from rmfs.control.view import View
    from rmfs.world.orders import Bundle

Share = Annotated[float, pydantic.Field(ge=0, le=1)]
Seconds = Annotated[float, pydantic.Field(ge=0)]


class TurnoverPodParameters(TurnoverParameters):
    """Parameters of RPS turnover."""

    emptiest: bool = True
    """Whether the pod with the lowest share of its capacity used or promised is chosen within a
    class. If false, a random pod of the class is chosen."""
    buffer_thresholds: tuple[Share, ...] = (0.8, 0.8, 0.8)
    """One value for each class: the bundles promised to a pod of the class are released to ROA when
    at least this share of the pod's capacity is used or promised to bundles."""
    buffer_timeouts_s: tuple[Seconds, ...] = (1200.0, 1200.0, 1200.0)
    """One value for each class: the maximum time in seconds from the last promise to a pod of the
    class until the bundles promised to the pod are released to ROA."""

    @pydantic.model_validator(mode="after")
    def _one_per_class(self) -> TurnoverPodParameters:
        classes = len(self.class_borders)
        for name in ("buffer_thresholds", "buffer_timeouts_s"):
            if len(getattr(self, name)) != classes:
                raise ValueError(f"{name} must have {classes} values, one for each class")
        return self


class Turnover(Buffered[TurnoverPodParameters]):
    """Chooses a pod of the same turnover class as the bundle's SKU.

    Pods and SKUs are classified by units ordered (`rmfs.control.trackers.turnover`). PSA `turnover`
    stores the fastest pods nearest to pick stations; together, the two rules bring fast SKUs close
    to pickers. If no pod of the class has room, other classes are tried: one class slower, one
    faster, two slower, two faster, and so on. All pods are candidates, wherever they are.

    Within a class, the same pod is chosen until a bundle does not fit or a replenishment station
    serves the pod. Then the emptiest pod of the class is chosen (ties go to the lowest number) or,
    if `emptiest` is false, a random pod.
    """

    parameters_model = TurnoverPodParameters
    hears = frozenset({Trigger.BUNDLE_STORED})

    def __init__(
        self, parameters: TurnoverPodParameters, view: View, rng: np.random.Generator
    ) -> None:
        super().__init__(parameters, view, rng)
        self._classes = view.trackers.get(TurnoverClasses, TurnoverParameters.of(parameters))
        self._last = [-1] * self._classes.classes

    def choose(self, bundle: Bundle) -> int:
        """Choose a pod with room, of the SKU's class if possible; -1 if no pod has room."""
        fits = self.fits(bundle)
        if not fits.any():
            return -1
        pod_class = self._classes.pod_class
        for number in outward(int(self._classes.sku_class[bundle.sku]), self._classes.classes):
            last = self._last[number]
            if last >= 0 and fits[last] and pod_class[last] == number:
                return last
            pods = (fits & (pod_class == number)).nonzero()[0]
            if len(pods):
                pod = self._last[number] = self._among(pods)
                return pod
        return -1

    def threshold(self, pod: int) -> float:
        """Return the value of `buffer_thresholds` (share of capacity) for the pod's class."""
        return self.parameters.buffer_thresholds[self._classes.pod_class.item(pod)]

    def timeout_s(self, pod: int) -> float:
        """Return the value of `buffer_timeouts_s` for the pod's class, in s."""
        return self.parameters.buffer_timeouts_s[self._classes.pod_class.item(pod)]

    @property
    def shortest_timeout_s(self) -> float:
        """The smallest value of `buffer_timeouts_s`, in s."""
        return min(self.parameters.buffer_timeouts_s)

    def hear(self, trigger: Trigger, subject: Any) -> None:
        """Forget the last choice of a class if it was the pod in which a bundle has been stored."""
        self._last = [-1 if pod == subject.pod else pod for pod in self._last]

    def _among(self, pods: np.ndarray[Any, np.dtype[np.intp]]) -> int:
        if not self.parameters.emptiest:
            return int(pods[self.draw(len(pods))])
        inventory = self.view.inventory
        return int(pods[(inventory.load[pods] / inventory.capacity[pods]).argmin()])


def outward(middle: int, count: int) -> list[int]:
    """List the numbers from 0 to `count` - 1 by distance from `middle`; in a tie, higher first."""
    steps = [middle]
    for away in range(1, count):
        steps += [number for number in (middle + away, middle - away) if 0 <= number < count]
    return steps

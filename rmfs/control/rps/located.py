"""RPS rules that consider the position of a bundle's station, and therefore wait for ROA."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal, TypeVar

import numpy as np

from rmfs.control.problems import Problem, Trigger
from rmfs.control.rps.buffered import BufferParameters, EvenlyBuffered

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from rmfs.world.orders import Bundle

B = TypeVar("B", bound=BufferParameters)


class Located(EvenlyBuffered[B]):
    """Base class of rules that choose pods only for bundles whose station is known."""

    subscriptions = frozenset({Trigger.BUNDLE_SENT})
    waits_for = frozenset({Problem.ROA})

    def candidates(self) -> list[Bundle]:
        """List the bundles that have a station but no pod yet, in order of arrival."""
        waiting = self.view.bundles.without_pod.values()
        return [bundle for bundle in waiting if bundle.station >= 0]


class Nearest(Located[BufferParameters]):
    """Chooses the pod nearest, in a straight line, to the station that ROA chose for the bundle.

    Stored pods come before carried ones; within each of these groups, pods on the station's tier
    come first. The distance of a carried pod is measured from the waypoint where its robot stands
    or next stops. Ties go to the pod with the lowest number. The rule requires an ROA rule that
    does not wait for the choice of the pod, such as `random`.
    """

    parameters_model = BufferParameters

    def choose(self, bundle: Bundle) -> int:
        """Choose the nearest pod with room, stored pods first; -1 if there is none."""
        storage, waypoint = self.view.storage, self.view.stations[bundle.station].waypoint
        distances = self.view.travel.distances_to(waypoint, "euclidean")
        metres = np.where(storage.is_stored, distances[storage.pod_waypoint], np.inf)
        pod = self.best(bundle, metres)
        if pod < 0 or storage.is_stored[pod]:
            return pod
        # only carried pods have room
        carried = [p for p in self.fits(bundle).nonzero()[0].tolist() if not storage.is_stored[p]]
        return min(carried, key=lambda pod: distances.item(self.view.pod_waypoint(pod)))


class ReactiveParameters(BufferParameters):
    """Parameters of RPS reactive."""

    among_equals: Literal["random", "emptiest"] = "random"
    """Choice among pods that are equally easy to bring: a random pod (`random`), or the pod with
    the lowest share of its capacity used or promised (`emptiest`)."""


class Reactive(Located[ReactiveParameters]):
    """Chooses a pod that is easy to bring to the station that ROA chose for the bundle.

    Pods that are stored on the station's tier come first, then pods that are either carried or on
    another tier, and then pods that are both. The pod is chosen from the first of these groups in
    which a pod has room. The parameter `among_equals` determines whether the choice is random or
    the emptiest pod is chosen; ties go to the lowest number. The rule requires an ROA rule that
    does not wait for the choice of the pod, such as `random`.
    """

    parameters_model = ReactiveParameters

    def choose(self, bundle: Bundle) -> int:
        """Choose a pod with room from the group that comes first; -1 if no pod has room."""
        inventory = self.view.inventory
        if self.parameters.among_equals == "random":
            scores = self.rng.random(len(inventory.capacity))
        else:
            # a share can be 1, but then there is no room
            scores = inventory.load / inventory.capacity
        return self.best(bundle, scores + self._steps(bundle.station))

    def _steps(self, station: int) -> NDArray[np.int64]:
        """Group of each pod: 1 if carried, plus 1 if not on the station's tier, shape (P,)."""
        storage, travel = self.view.storage, self.view.travel
        steps = np.logical_not(storage.is_stored).astype(np.int64)
        if travel.tiers > 1:
            waypoints = storage.pod_waypoint.copy()
            for robot in self.view.robots:
                if robot.pod >= 0:
                    waypoints[robot.pod] = travel.robot_waypoint(robot.index)
            steps += travel.tier[waypoints] != self.view.stations[station].tier
        return steps

"""Storage locations (*places* for short), the pods stored at them, and the robots that keep them.

When a robot is sent to a place, the place is reserved for it. The robot *keeps* the place until it
has a plan to leave; until then, no other robot may be sent there (condition W2 of
`docs/safety.md`). An empty robot may keep a place beneath a stored pod; only a loaded robot needs a
place without a pod.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from rmfs.world.inventory import read_only

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from rmfs.layout.model import Layout
    from rmfs.world.robots import Robot


class Storage:
    """Places, the pods stored at them, and the robots that keep them.

    Parameters
    ----------
    layout
        The warehouse at time zero.
    robots
        All robots: the list `WorldState.robots`.

    Attributes
    ----------
    places
        Waypoints of the L storage locations, ascending, shape (L,).
    place_index
        Index into `places` of each waypoint, -1 if it is not a place.
    pod_at
        Pod stored at each waypoint, or -1.
    place_of
        Waypoint at which each pod is stored, or -1 while it is carried.
    claimed_by
        Robot that carries each pod or has a task with it, or -1.
    kept_by
        Robot that keeps each waypoint, or -1.
    pod_waypoint
        Waypoint at which each pod is stored, or was stored last, shape (P,).
    is_empty
        Whether each place has no pod and no robot keeps it, shape (L,): a pod may be stored there.
    is_restful
        Whether each place has an unclaimed pod and no robot keeps it, shape (L,): a robot may rest
        there, beneath the pod.
    is_stored
        Whether each pod is at a place and not on a robot, shape (P,).
    is_at_hand
        Whether each pod is available, shape (P,): it is stored and unclaimed, and its place is
        kept by no robot or by one without work (`Robot.is_free`).
    version
        Increases whenever a pod becomes available.
    """

    def __init__(self, layout: Layout, robots: list[Robot]) -> None:
        self._robots = robots
        self.places: NDArray[np.int32] = read_only(
            np.flatnonzero(layout.is_storage).astype(np.int32)
        )
        self.place_index = [-1] * layout.waypoints
        for index, place in enumerate(self.places.tolist()):
            self.place_index[place] = index
        self.place_of: list[int] = layout.pod_waypoint.tolist()
        self.pod_at = [-1] * layout.waypoints
        for pod, place in enumerate(self.place_of):
            self.pod_at[place] = pod
        self.claimed_by = [-1] * layout.pods
        self.kept_by = [-1] * layout.waypoints
        self._pod_waypoint = layout.pod_waypoint.astype(np.int32)
        self._is_empty = np.zeros(len(self.places), np.bool_)
        self._is_restful = np.zeros(len(self.places), np.bool_)
        self._is_stored = np.ones(layout.pods, np.bool_)
        self._is_at_hand = np.zeros(layout.pods, np.bool_)
        self.pod_waypoint: NDArray[np.int32] = read_only(self._pod_waypoint)
        self.is_empty: NDArray[np.bool_] = read_only(self._is_empty)
        self.is_restful: NDArray[np.bool_] = read_only(self._is_restful)
        self.is_stored: NDArray[np.bool_] = read_only(self._is_stored)
        self.is_at_hand: NDArray[np.bool_] = read_only(self._is_at_hand)
        self.version = 0
        for place in self.places.tolist():
            self._refresh(place)

    def is_free(self, place: int) -> bool:
        """Whether a place holds no pod and no robot keeps it."""
        return bool(self._is_empty[self.place_index[place]])

    def claim(self, pod: int, robot: int) -> None:
        """Reserve a pod for a robot's task.

        Raises
        ------
        ValueError
            If another robot has claimed the pod.
        """
        if self.claimed_by[pod] not in (-1, robot):
            raise ValueError(f"pod {pod} is claimed by robot {self.claimed_by[pod]}")
        self.claimed_by[pod] = robot
        if self.place_of[pod] >= 0:
            self._refresh(self.place_of[pod])

    def release(self, pod: int) -> None:
        """End the claim on a pod, so that any robot may claim it."""
        self.claimed_by[pod] = -1
        if self.place_of[pod] >= 0:
            self._refresh(self.place_of[pod])

    def keep(self, robot: Robot, place: int) -> None:
        """Reserve a place for a robot; do nothing if the waypoint is not a storage location.

        Raises
        ------
        ValueError
            If another robot keeps the place.
        """
        if self.place_index[place] < 0:
            return
        if self.kept_by[place] not in (-1, robot.index):
            raise ValueError(f"place {place} is kept by robot {self.kept_by[place]}")
        if self.kept_by[place] < 0:
            self.kept_by[place] = robot.index
            robot.places.append(place)
        self._refresh(place)

    def departed(self, robot: Robot, rest: int) -> bool:
        """Release the places that a robot leaves or has left; return whether any were released.

        Three waypoints are not released: `rest`; the place of the robot's task; and the place to
        which the robot has been sent, even if no route there is planned yet.

        Parameters
        ----------
        rest
            Waypoint at which the robot's current plan ends or, without a plan, at which the robot
            stands.
        """
        goal = robot.task.place if robot.task is not None else -1
        left = [place for place in robot.places if place not in (robot.waypoint, rest, goal)]
        for place in left:
            robot.places.remove(place)
            self.kept_by[place] = -1
            self._refresh(place)
        return bool(left)

    def lift(self, pod: int) -> None:
        """Remove a pod from its place."""
        place = self.place_of[pod]
        self.place_of[pod] = -1
        self.pod_at[place] = -1
        self._is_stored[pod] = False
        self._is_at_hand[pod] = False
        self._refresh(place)

    def set_down(self, pod: int, place: int) -> None:
        """Store a pod and release it.

        Raises
        ------
        ValueError
            If a pod is already stored at the place.
        """
        if self.pod_at[place] >= 0:
            raise ValueError(f"pod {self.pod_at[place]} is already stored at {place}")
        self.place_of[pod] = place
        self.pod_at[place] = pod
        self._is_stored[pod] = True
        self._pod_waypoint[pod] = place
        self.claimed_by[pod] = -1
        self._refresh(place)

    def robot_changed(self, robot: Robot) -> None:
        """Update which pods are available, after a robot has got work or become free."""
        for place in robot.places:
            self._refresh(place)

    def _refresh(self, place: int) -> None:
        """Update `is_empty`, `is_restful` and `is_at_hand` for a place."""
        index = self.place_index[place]
        pod = self.pod_at[place]
        keeper = self.kept_by[place]
        if pod < 0:
            self._is_empty[index] = keeper < 0
            self._is_restful[index] = False
            return
        unclaimed = self.claimed_by[pod] < 0
        self._is_empty[index] = False
        self._is_restful[index] = unclaimed and keeper < 0
        at_hand = unclaimed and (keeper < 0 or self._robots[keeper].is_free)
        if at_hand and not self._is_at_hand[pod]:
            self.version += 1
        self._is_at_hand[pod] = at_hand

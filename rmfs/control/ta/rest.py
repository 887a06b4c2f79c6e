"""Where idle robots rest: beneath stored pods, so that empty storage locations stay free."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from rmfs.control.view import View
    from rmfs.world.robots import Robot

RestRule = Literal["middle", "nearest", "random"]


class RestPlaces:
    """Chooses where robots rest: beneath idle pods or, if there are none, at empty locations.

    An idle pod is a stored pod that belongs to no robot's task. A robot beneath it is not in the
    way of robots that carry pods, since these cannot pass there anyway. If the pod is needed, the
    robot beneath it gets the task or is sent away.

    Parameters
    ----------
    rule
        `middle`: the location nearest to the middle of the robot's tier (Merschformann, Xie and Li
        2018, section 3.1.1); `nearest`: the location nearest to the robot by Euclidean distance,
        possibly on another tier (ties go to the waypoint with the lowest number); `random`: a
        location drawn from those on the robot's tier.
    draw
        Function that draws an integer from 0 to n - 1, where n is its argument; called only with
        the rule `random`.
    """

    def __init__(self, view: View, rule: RestRule, draw: Callable[[int], int]) -> None:
        self._storage = view.storage
        self._travel = view.travel
        self._rule = rule
        self._draw = draw
        self._order = [_from_middle(view, tier) for tier in range(view.travel.tiers)]

    def choose(self, robot: Robot) -> int:
        """Choose a storage location (waypoint) for a robot; -1 if there is none."""
        if self._rule == "nearest":
            return self._nearest(robot)
        order = self._order[robot.tier]
        if not len(order):
            return -1
        for mask in (self._storage.is_restful, self._storage.is_empty):
            fit = mask[order]
            if self._rule == "random":
                positions = fit.nonzero()[0]
                if len(positions):
                    return self._place(order[positions[self._draw(len(positions))]])
            else:
                first = int(fit.argmax())
                if fit[first]:
                    return self._place(order[first])
        return -1

    def _nearest(self, robot: Robot) -> int:
        for mask in (self._storage.is_restful, self._storage.is_empty):
            places = self._storage.places[mask]
            if len(places):
                return int(places[self._travel.metres(robot.waypoint, places).argmin()])
        return -1

    def _place(self, index: np.intp) -> int:
        return int(self._storage.places[index])


def _from_middle(view: View, tier: int) -> NDArray[np.intp]:
    """Indices of the places on a tier, those near its middle first, ties by index."""
    layout = view.layout
    places = view.storage.places
    x = layout.x_m[places] - layout.tiers[tier].length_m / 2
    y = layout.y_m[places] - layout.tiers[tier].width_m / 2
    order = np.argsort(x * x + y * y, kind="stable")
    own: NDArray[np.intp] = order[layout.tier[places[order]] == tier]
    return own

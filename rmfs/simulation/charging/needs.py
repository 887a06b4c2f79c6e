"""Upper bound on the energy that a robot needs for a task and the trip to an energy station.

Energy stations are chargers and swap stations. The bound assumes the most distant pods, stations
and storage locations. For each part of the task, the duration of the longest trip without other
robots is multiplied by an upper bound on the mean power. The energy for lifting the pod is added.
For motion from rest to rest, the mean power in W of a robot with a total mass of *m* kg is at most
*m p* plus the power of its electronics. Here *p* is the larger of the following two bounds in W/kg,
divided by the efficiency of the drive:

- Straight motion: *c g v* for the rolling resistance plus *(1 + k) v² / 2 / (v / a + v / b)* for
  the kinetic energy, with the coefficient of rolling resistance *c*, the acceleration of gravity
  *g*, the top speed *v*, the acceleration *a*, the deceleration *b*, and the inertia *k* of
  rotating parts as a share of the mass.
- Turns: *t g w* for the turning resistance plus *(r w)² / 2 / (d / w)* for the kinetic energy, with
  the resisting torque per weight *t* in m, the angular speed *w*, the radius of gyration *r*, and
  the smallest turn *d*, a right angle.

The reserve of the battery covers waiting and the influence of other robots.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from rmfs.control.view import View
    from rmfs.layout.model import RobotKind
    from rmfs.scenario.parameters import Energy

GRAVITY = 9.80665
BEND_RAD = np.pi / 2
"""Smallest turn in rad that the bound assumes: a right angle, as in layouts on a grid."""


def most_w_per_kg(given: Energy, kind: RobotKind) -> float:
    """Return an upper bound on the mean power per kg in motion from rest to rest, in W/kg."""
    v, a, b = kind.top_speed_m_s, kind.acceleration_m_s2, kind.deceleration_m_s2
    roll = given.rolling_resistance * GRAVITY * v
    kinetic = (1 + given.inertia_share) / 2 * v / (1 / a + 1 / b)
    turn_rad_s = 2 * np.pi / kind.full_turn_s
    twist = given.turning_resistance_m * GRAVITY * turn_rad_s
    spin = (given.gyration_m * turn_rad_s) ** 2 / 2 * turn_rad_s / BEND_RAD
    return float(max(roll + kinetic, twist + spin) / given.drive_efficiency)


class Needs:
    """Upper bounds on the energy that a robot needs, in J.

    Attributes
    ----------
    task_j
        For a robot without a pod: fetch any pod, bring it to any station, store it anywhere, and go
        to charge from there.
    store_j
        For a robot with a pod at a station: store the pod anywhere, and go to charge from there.
    visit_j
        For a robot with a pod at a station: bring the pod to any other station, store it anywhere,
        and go to charge from there.
    """

    task_j: float
    store_j: float
    visit_j: float

    def __init__(self, view: View, given: Energy) -> None:
        travel, layout, places = view.travel, view.layout, view.storage.places
        per_kg = max(most_w_per_kg(given, kind) for kind in layout.robot_kinds)
        most_kg = given.pod_kg + given.goods_kg_per_space * float(layout.pod_capacity.max())
        empty_w = given.robot_kg * per_kg + given.standby_w
        loaded_w = (given.robot_kg + most_kg) * per_kg + given.standby_loaded_w
        work = np.array([station.waypoint for station in view.stations])
        energy = [station.waypoint for station in view.recovery_stations]
        bring_s = max(_most(travel.to(at, loaded=True)[places]) for at in work.tolist())
        away_s = max(_most(travel.away(at, loaded=True)[places]) for at in work.tolist())
        between_s = max(_most(travel.to(at, loaded=True)[work]) for at in work.tolist())
        # to the farthest, not the nearest: that may be in use
        energy_s = max((_most(travel.to(at, loaded=False)[places]) for at in energy), default=0.0)
        # from anywhere to anywhere is no farther than by way of a station
        fetch_s = min(
            _most(travel.to(at, loaded=False)) + _most(travel.away(at, loaded=False)[places])
            for at in work.tolist()
        )
        lift_j = most_kg * GRAVITY * given.lift_m / given.lift_efficiency
        transfer_s = max(kind.pod_transfer_s for kind in layout.robot_kinds)
        lift_j += 2 * transfer_s * given.standby_loaded_w
        self.store_j = loaded_w * away_s + lift_j + empty_w * energy_s
        self.visit_j = loaded_w * between_s + self.store_j
        self.task_j = empty_w * fetch_s + loaded_w * bring_s + self.store_j
        self._travel, self._places, self._empty_w = travel, places, empty_w
        self._bring_j: NDArray[np.float64] | None = None
        self._loaded_w, self._work = loaded_w, work

    def task_from_j(self, waypoint: int) -> float:
        """Return a bound on the energy for the same task as `task_j`, from a given waypoint, in J.

        The robot fetches any pod, brings it to the station farthest from the pod, stores it
        anywhere, and goes to charge. The result is never greater than `task_j`.
        """
        if self._bring_j is None:
            each_s = [self._travel.to(at, loaded=True)[self._places] for at in self._work.tolist()]
            reached = np.where(np.isfinite(each_s), each_s, 0.0)
            self._bring_j = self._loaded_w * reached.max(axis=0)
        fetch_s = self._travel.away(waypoint, loaded=False)[self._places]
        known = np.where(np.isfinite(fetch_s), fetch_s, 0.0)
        whole = float((self._empty_w * known + self._bring_j).max(initial=0.0)) + self.store_j
        return min(whole, self.task_j)


def _most(times: NDArray[Any]) -> float:
    """Return the longest finite time."""
    return float(times[np.isfinite(times)].max(initial=0.0))

"""Guards robots against stranding, that is, stopping with a nearly empty battery.

A robot whose energy might not suffice for another task is sent to charge instead. Strandings can
still occur, for example after a long delay or if a charger is out of service. They are counted, and
a stranded robot is rescued after a given time.
"""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

from rmfs.control.ca.places import choose
from rmfs.control.decisions import Charge, Park
from rmfs.control.problems import Problem
from rmfs.simulation.charging.needs import GRAVITY, Needs
from rmfs.world.charging import ChargeTask

if TYPE_CHECKING:
    from rmfs.control.ta import Consult
    from rmfs.control.view import View
    from rmfs.scenario.parameters import Energy
    from rmfs.simulation.agenda import Agenda
    from rmfs.simulation.controller_set import ControllerSet
    from rmfs.simulation.dispatch import Dispatch
    from rmfs.simulation.steps import Due
    from rmfs.traffic import Traffic
    from rmfs.world.batteries import Batteries
    from rmfs.world.robots import Robot

LOOK_US = 60_000_000
"""Time between checks of all levels, in us."""

AGAIN_US = 1_000_000
"""Delay in us before retrying to stop a robot that cannot be stopped now."""


class EnergyGuard:
    """Watches the battery levels of all robots.

    Attributes
    ----------
    needs
        Upper bounds on the energy that a robot needs for another task.
    """

    def __init__(
        self,
        given: Energy,
        batteries: Batteries,
        view: View,
        *,
        agenda: Agenda,
        dispatch: Dispatch,
        fleet: Traffic,
        controllers: ControllerSet,
        due: Due,
    ) -> None:
        self._batteries, self._view = batteries, view
        self._agenda, self._dispatch, self._fleet = agenda, dispatch, fleet
        self._controllers, self._due = controllers, due
        self.needs = Needs(view, given)
        self._most_w = _most_w(given, view)
        least_j = batteries.least_j + batteries.reserve_j + 1.5 * self.needs.task_j
        full_share = batteries.given.full_share
        batteries.enough_share = min(least_j / batteries.capacity_j, full_share)
        self._safe_until_s = [0.0] * len(view.robots)
        self._left: list[Robot] | None = None

    def begin(self) -> None:
        """Schedule the first check of all levels."""
        self._agenda.after(LOOK_US, self._look)

    def secure(self, consult: Consult) -> None:
        """Send free and resting robots to charge if their energy might not suffice for a task.

        This method must be called before tasks are assigned. A robot that carries a pod stores the
        pod first. If `consult` has to wait for an answer, the next call of this method goes on with
        the same robot.
        """
        view = self._view
        if self._left is None:
            self._left = [*view.asking.values(), *view.resting.values()]
        while self._left:
            robot = self._left[0]
            if view.now_s >= self._safe_until_s[robot.index]:
                self._secure(robot, consult)
            del self._left[0]
        self._left = None

    def _secure(self, robot: Robot, consult: Consult) -> None:
        needed_j = self.needs.task_j if robot.pod < 0 else self.needs.visit_j
        usable_j = self._batteries.usable_j(robot.index)
        spare_j = usable_j - needed_j
        if spare_j < 0 and robot.pod < 0:
            # it may still do with less from where it stands
            spare_j = usable_j - self.needs.task_from_j(robot.waypoint)
        if spare_j >= 0:
            self._safe_until_s[robot.index] = self._view.now_s + spare_j / self._most_w
        elif robot.pod >= 0:
            place = consult.place_for(robot)
            if place >= 0:
                self._dispatch.start(Park(robot, place))
        else:
            self._send(robot)

    def _send(self, robot: Robot) -> None:
        station = choose(self._view, robot, "least-queued", full_too=True)
        if station >= 0:
            until = max(self._controllers[Problem.CA].target_share(), self._batteries.enough_share)
            self._dispatch.start(Charge(robot, station, until))

    # --- robots that strand ---------------------------------------------------------------------

    def _look(self) -> None:
        """Check all levels for robots that strand, and for resting robots that must charge."""
        batteries, view = self._batteries, self._view
        levels = batteries.levels_j()
        for robot in (levels < batteries.least_j).nonzero()[0].tolist():
            if robot not in batteries.stranded and not self._is_charging(view.robots[robot]):
                batteries.strand(robot, view.now_s)
                self._hold(robot)
        low_j = batteries.least_j + batteries.reserve_j + self.needs.task_j
        if any(levels[robot] < low_j for robot in view.resting):
            self._due.want(Problem.TA)
        self._agenda.after(LOOK_US, self._look)

    def _is_charging(self, robot: Robot) -> bool:
        task = robot.task
        return isinstance(task, ChargeTask) and robot.station == task.station

    def _hold(self, robot: int) -> None:
        """Stop a robot where it next comes to rest, until it is rescued."""
        lasting_us = round(self._batteries.given.rescue_after_s * 1e6)
        until_us = self._fleet.hold(robot, lasting_us)
        if until_us is None:
            self._agenda.after(AGAIN_US, partial(self._hold, robot))
        else:
            self._agenda.at(until_us, partial(self._rescue, robot))

    def _rescue(self, robot: int) -> None:
        self._batteries.rescue(robot)


def _most_w(given: Energy, view: View) -> float:
    """Return an upper bound on the power of a robot at any moment, in W."""
    layout = view.layout
    mass = given.robot_kg + given.pod_kg
    mass += given.goods_kg_per_space * float(layout.pod_capacity.max())
    force = max(
        given.rolling_resistance * GRAVITY + (1 + given.inertia_share) * kind.acceleration_m_s2
        for kind in layout.robot_kinds
    )
    speed = max(kind.top_speed_m_s for kind in layout.robot_kinds)
    moving = mass * force * speed / given.drive_efficiency
    # a turn begins with a jump of speed, which is over in less than a second of this
    return 2 * moving + given.standby_loaded_w

"""Converts tasks to commands for `rmfs.traffic`, and handles the events that traffic reports."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rmfs.control.problems import Problem
from rmfs.simulation.tasks import end_task
from rmfs.traffic import Step
from rmfs.world.tasks import RestTask

if TYPE_CHECKING:
    from collections.abc import Sequence

    from rmfs.control.asks import Call
    from rmfs.control.decisions import Charge, Prepare, TaskDecision
    from rmfs.control.ta import Consult
    from rmfs.layout.model import Layout
    from rmfs.simulation.controller_set import ControllerSet
    from rmfs.simulation.events import Events
    from rmfs.simulation.fleet import Fleet
    from rmfs.simulation.service import Service
    from rmfs.world import World
    from rmfs.world.robots import Robot
    from rmfs.world.tasks import Task

# plain numbers for the hot path
_DRIVE, _LIFT, _SET_DOWN, _STATION = (
    int(step) for step in (Step.DRIVE, Step.LIFT, Step.SET_DOWN, Step.STATION)
)


class Dispatch:
    """Starts tasks and tracks robots.

    A storage location at which a robot stands, or to which a robot is sent, is reserved for that
    robot until the robot has a plan to leave. Meanwhile, no other robot is sent there. If a robot
    is to fetch a pod whose location is reserved for a robot without work, the robot without work is
    sent elsewhere. The other robot starts as soon as the location is no longer reserved.
    """

    def __init__(
        self,
        layout: Layout,
        world: World,
        fleet: Fleet,
        events: Events,
        controllers: ControllerSet,
        services: Sequence[Service],
    ) -> None:
        self._world = world
        self._storage = world.storage
        self._fleet = fleet
        self._events = events
        self._controllers = controllers
        self._services = services
        self._tier: list[int] = layout.tier.tolist()
        self._held_up: dict[int, Robot] = {}
        self._call_of: dict[Task, Call] = {}

    # --- decisions of TA ------------------------------------------------------------------------

    def start(self, decision: TaskDecision | Charge) -> None:
        """Let a robot start the task that a decision gives it."""
        self._begin(decision.task())

    def _begin(self, planned: Task) -> None:
        task = planned.started(self._world)
        self._events.task_started(self._world.now_s, task.robot, task.kind, task.station)
        robot = self._world.robots[task.robot]
        if task.pod >= 0 and robot.pod < 0:
            self._fetch(robot)
        elif task.station < 0:
            if task.stores or robot.waypoint != task.place:
                self._command(robot, task.place, _way(task))
        elif robot.station == task.station:
            self._services[task.station].go_on()
        else:
            waypoint = self._world.stations[task.station].waypoint
            self._command(robot, waypoint, _way(task))

    def _fetch(self, robot: Robot) -> None:
        """Send a robot to its pod as soon as the location is reserved for no other robot."""
        task = robot.task
        assert task is not None
        place = self._storage.place_of[task.pod]
        keeper = self._storage.kept_by[place]
        if keeper not in (-1, robot.index):
            self._held_up[place] = robot
            self._send_away(self._world.robots[keeper])
            return
        self._storage.keep(robot, place)
        self._command(robot, place, [(_DRIVE, place), (_LIFT, task.pod), *_way(task)])

    def _send_away(self, keeper: Robot) -> None:
        """Make a robot without work leave; if it has nowhere to go, it leaves later."""
        place = self._controllers[Problem.TA].rest_place(keeper)
        if place >= 0:
            self._begin(RestTask(keeper.index, place=place))

    def _command(self, robot: Robot, goal: int, program: list[tuple[int, int]]) -> None:
        if robot.station >= 0:
            self._leave_station(robot)
        robot.waypoint = goal
        robot.tier = self._tier[goal]
        self._fleet.command(robot.index, program)
        self.departed(robot.index)

    def _leave_station(self, robot: Robot) -> None:
        station = self._world.stations[robot.station]
        self._events.visit_ended(self._world.now_s, station.index, robot.pod, robot.index)
        station.robot = -1
        robot.station = -1

    # --- tasks prepared ahead -------------------------------------------------------------------

    def prepare(self, decision: Prepare, call: Call | None = None) -> None:
        """Store the tasks prepared for a robot, and the optimiser call that led to them, if any."""
        robot, tasks = decision
        self.forget_prepared(robot)
        robot.prepared.extend(task.task() for task in tasks)
        if call is not None:
            self._call_of.update(dict.fromkeys(robot.prepared, call))

    def forget_prepared(self, robot: Robot) -> None:
        """Discard the tasks prepared for a robot."""
        for task in robot.prepared:
            self._call_of.pop(task, None)
        robot.prepared.clear()

    def start_prepared(self, robot: Robot, consult: Consult) -> None:
        """Start the first of a robot's prepared tasks that is possible; discard those before it."""
        while robot.prepared:
            task = robot.prepared[0]
            if task.lacks_place and robot.pod >= 0:
                # this may ask the outside; until it is answered, nothing has changed
                task.place = consult.place_for(robot)
            robot.prepared.popleft()
            call = self._call_of.pop(task, None)
            if task.is_possible(self._world, consult.serves):
                self._begin(task)
                if call is not None:
                    call.count()
                return
            self._world.tasks_dropped += 1
            if call is not None:
                call.stale += 1

    # --- reports of traffic ---------------------------------------------------------------------

    def departed(self, index: int, _place: int = -1) -> None:
        """Release storage locations that a robot leaves, and send waiting robots to them."""
        robot = self._world.robots[index]
        if len(robot.places) < 2 and robot.waypoint in robot.places:
            return
        rest = self._fleet.rest_waypoint(index)
        if self._storage.departed(robot, rest):
            self._events.place_left(index)
            self._send_held_up()

    def _send_held_up(self) -> None:
        for place, robot in list(self._held_up.items()):
            keeper = self._storage.kept_by[place]
            if keeper < 0:
                del self._held_up[place]
                self._fetch(robot)
            elif robot is not self._world.robots[keeper] and self._stays(keeper, place):
                self._send_away(self._world.robots[keeper])

    def _stays(self, keeper: int, place: int) -> bool:
        return self._world.robots[keeper].waypoint == place

    def lift_started(self, index: int, pod: int) -> None:
        """Record that a robot starts to lift its pod, to take it to the destination of the task."""
        world = self._world
        robot = world.robots[index]
        assert robot.task is not None
        place, station = robot.waypoint, robot.task.station
        world.lift(robot, pod)
        robot.waypoint = world.stations[station].waypoint if station >= 0 else robot.task.place
        robot.tier = self._tier[robot.waypoint]
        self._events.pod_lifted(world.now_s, pod, index, place)

    def at_head(self, index: int, station: int) -> None:
        """Record that a robot has reached its station, and let the station serve it."""
        world = self._world
        robot, reached = world.robots[index], world.stations[station]
        robot.station = station
        reached.robot = index
        reached.visits += 1
        self._events.visit_started(world.now_s, station, robot.pod, index)
        self._services[station].go_on()

    def set_down(self, index: int, pod: int) -> None:
        """Record that a robot has set down its pod, which is now available."""
        robot = self._world.robots[index]
        self._world.set_down(robot, robot.waypoint)
        self._events.pod_set_down(self._world.now_s, pod, index, robot.waypoint)

    def idle(self, index: int, _waypoint: int) -> None:
        """End a robot's task, all steps of which are done, if the task was to store a pod."""
        task = self._world.robots[index].task
        if task is not None and task.stores:
            end_task(self._world, self._events, index)


def _way(task: Task) -> list[tuple[int, int]]:
    """Return the remaining steps of a task whose pod has been lifted, or that has no pod."""
    if task.station >= 0:
        return [(_STATION, task.station)]
    if task.stores:
        return [(_DRIVE, task.place), (_SET_DOWN, task.pod)]
    return [(_DRIVE, task.place)]

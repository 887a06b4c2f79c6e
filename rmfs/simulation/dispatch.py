"""From tasks to traffic: what robots are commanded, and what follows from what they report."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rmfs.control.decisions import (
    BringForBundles,
    BringForPicks,
    Park,
    Prepare,
    Reposition,
    Rest,
    TaskDecision,
)
from rmfs.control.problems import Problem
from rmfs.simulation.tasks import end_task
from rmfs.traffic import Step
from rmfs.world.tasks import Task, TaskKind

if TYPE_CHECKING:
    from collections.abc import Sequence

    from rmfs.control.asks import Call
    from rmfs.control.ta import Consult
    from rmfs.layout.model import Layout
    from rmfs.simulation.controller_set import ControllerSet
    from rmfs.simulation.events import Events
    from rmfs.simulation.fleet import Fleet
    from rmfs.simulation.service import Service
    from rmfs.world import World
    from rmfs.world.robots import Robot

# plain numbers for the hot path
_DRIVE, _LIFT, _SET_DOWN, _STATION = (
    int(step) for step in (Step.DRIVE, Step.LIFT, Step.SET_DOWN, Step.STATION)
)


class Dispatch:
    """Starts tasks and follows robots.

    A robot is sent to a storage place only if no other keeps it. If one without work stands
    beneath the pod that is wanted, it is sent elsewhere first; the robot that comes for the pod
    sets off when the place has been left.
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
        self._basis: dict[Task, Call] = {}

    # --- decisions of TA ------------------------------------------------------------------------

    def bring_for_picks(self, decision: BringForPicks) -> None:
        """Bring a pod, or go on with the one carried, to a pick station."""
        robot = decision.robot
        task = self._world.start_pick(robot, decision.pod, decision.station)
        self._bring(robot, task)

    def bring_for_bundles(self, decision: BringForBundles) -> None:
        """Bring a pod, or go on with the one carried, to a replenishment station."""
        robot = decision.robot
        task = self._world.start_replenish(robot, decision.pod, decision.station)
        self._bring(robot, task)

    def park(self, decision: Park) -> None:
        """Store the pod a robot carries."""
        robot, place = decision
        task = self._world.start_park(robot, place)
        self._tell(task)
        self._command(robot, place, [(_DRIVE, place), (_SET_DOWN, robot.pod)])

    def reposition(self, decision: Reposition) -> None:
        """Move a stored pod to another place."""
        robot, pod, place = decision
        task = self._world.start_reposition(robot, pod, place)
        self._tell(task)
        self._fetch(robot)

    def rest(self, decision: Rest) -> None:
        """Let a robot wait at a place."""
        robot, place = decision
        task = self._world.start_rest(robot, place)
        self._tell(task)
        if robot.waypoint != place:
            self._command(robot, place, [(_DRIVE, place)])

    def _bring(self, robot: Robot, task: Task) -> None:
        self._tell(task)
        if robot.pod < 0:
            self._fetch(robot)
        elif robot.station == task.station:
            self._services[task.station].go_on()
        else:
            waypoint = self._world.stations[task.station].waypoint
            self._command(robot, waypoint, [(_STATION, task.station)])

    def _fetch(self, robot: Robot) -> None:
        """Send a robot to its pod as soon as nobody else keeps the place."""
        task = robot.task
        assert task is not None
        place = self._storage.place_of[task.pod]
        keeper = self._storage.kept_by[place]
        if keeper not in (-1, robot.index):
            self._held_up[place] = robot
            self._send_away(self._world.robots[keeper])
            return
        self._storage.keep(robot, place)
        program = [(_DRIVE, place), (_LIFT, task.pod)]
        if task.kind is TaskKind.REPOSITION:
            program += [(_DRIVE, task.place), (_SET_DOWN, task.pod)]
        else:
            program.append((_STATION, task.station))
        self._command(robot, place, program)

    def _send_away(self, keeper: Robot) -> None:
        """Let a robot without work make room; with nowhere to go it stays until there is."""
        place = self._controllers[Problem.TA].rest_place(keeper)
        if place >= 0:
            self.rest(Rest(keeper, place))

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

    def _tell(self, task: Task) -> None:
        self._events.task_started(self._world.now_s, task.robot, task.kind.value, task.station)

    # --- tasks prepared ahead -------------------------------------------------------------------

    def prepare(self, decision: Prepare, basis: Call | None = None) -> None:
        """Remember what a robot is to do after its present task, and by whose solution."""
        robot, tasks = decision
        self.forget_prepared(robot)
        robot.prepared.extend(_planned(task) for task in tasks)
        if basis is not None:
            self._basis.update(dict.fromkeys(robot.prepared, basis))

    def forget_prepared(self, robot: Robot) -> None:
        """Forget what a robot was to do after its present task."""
        for task in robot.prepared:
            self._basis.pop(task, None)
        robot.prepared.clear()

    def start_prepared(self, robot: Robot, consult: Consult) -> None:
        """Start the first prepared task of a robot that is possible; pass over those before it."""
        while robot.prepared:
            task = robot.prepared[0]
            if task.kind is TaskKind.PARK and task.place < 0 and robot.pod >= 0:
                # may be asked of somebody outside: until it is answered, nothing has changed
                task.place = consult.place_for(robot)
            robot.prepared.popleft()
            basis = self._basis.pop(task, None)
            if self._is_possible(robot, task, consult):
                self._start(robot, task)
                if basis is not None:
                    basis.count()
                return
            self._world.tasks_dropped += 1
            if basis is not None:
                basis.stale += 1

    def _is_possible(self, robot: Robot, task: Task, consult: Consult) -> bool:
        storage, place, pod = self._storage, task.place, task.pod
        if task.kind is TaskKind.PARK:
            return robot.pod >= 0 and place >= 0 and self._is_empty(place)
        if task.kind is TaskKind.REST:
            free = storage.kept_by[place] in (-1, robot.index)
            return robot.pod < 0 and free
        if pod != robot.pod and (robot.pod >= 0 or not storage.is_at_hand[pod]):
            return False
        if task.kind is TaskKind.REPOSITION:
            return robot.pod < 0 and self._is_empty(place)
        return consult.serves(pod, task.station)

    def _is_empty(self, place: int) -> bool:
        return bool(self._storage.is_empty[self._storage.place_index[place]])

    def _start(self, robot: Robot, task: Task) -> None:
        if task.kind is TaskKind.PICK:
            self.bring_for_picks(BringForPicks(robot, task.pod, task.station))
        elif task.kind is TaskKind.REPLENISH:
            self.bring_for_bundles(BringForBundles(robot, task.pod, task.station))
        elif task.kind is TaskKind.PARK:
            self.park(Park(robot, task.place))
        elif task.kind is TaskKind.REPOSITION:
            self.reposition(Reposition(robot, task.pod, task.place))
        else:
            self.rest(Rest(robot, task.place))

    # --- reports of traffic ---------------------------------------------------------------------

    def departed(self, index: int, _place: int = -1) -> None:
        """Give up the places a robot has left, and send off whoever waited for one of them."""
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
        """A robot lifts its pod; next it goes to the station, or the place, of its task."""
        world = self._world
        robot = world.robots[index]
        assert robot.task is not None
        place, station = robot.waypoint, robot.task.station
        world.lift(robot, pod)
        robot.waypoint = world.stations[station].waypoint if station >= 0 else robot.task.place
        robot.tier = self._tier[robot.waypoint]
        self._events.pod_lifted(world.now_s, pod, index, place)

    def at_head(self, index: int, station: int) -> None:
        """A robot has reached a station: its pod can be served."""
        world = self._world
        robot, reached = world.robots[index], world.stations[station]
        robot.station = station
        reached.robot = index
        reached.visits += 1
        self._events.visit_started(world.now_s, station, robot.pod, index)
        self._services[station].go_on()

    def set_down(self, index: int, pod: int) -> None:
        """A pod stands at its place and may be claimed by anyone."""
        robot = self._world.robots[index]
        self._world.set_down(robot, robot.waypoint)
        self._events.pod_set_down(self._world.now_s, pod, index, robot.waypoint)

    def idle(self, index: int, _waypoint: int) -> None:
        """A robot has done all it was commanded; one that stored a pod needs a task."""
        task = self._world.robots[index].task
        if task is not None and task.kind in (TaskKind.PARK, TaskKind.REPOSITION):
            end_task(self._world, self._events, index)


def _planned(decision: TaskDecision) -> Task:
    """Make of a decision a task that has not begun."""
    robot = decision.robot.index
    match decision:
        case BringForPicks(_, pod, station):
            return Task(TaskKind.PICK, robot, pod, station)
        case BringForBundles(_, pod, station):
            return Task(TaskKind.REPLENISH, robot, pod, station)
        case Park(_, place):
            return Task(TaskKind.PARK, robot, place=place)
        case Reposition(_, pod, place):
            return Task(TaskKind.REPOSITION, robot, pod, place=place)
        case Rest(_, place):
            return Task(TaskKind.REST, robot, place=place)

"""Guides real robots along the plans of the traffic layer, and adapts the plans if robots are late.

In each tick (every 50 ms), the server first processes the messages of the robots. A robot is late
if it has not yet confirmed a step, such as reaching a waypoint, that its plan requires before the
next tick. The rest of its plan is then postponed, together with the plans of robots that use the
same waypoints later. After that, each robot whose next motion is due receives a route order (a
command to turn and to drive over waypoints), and each driving robot receives the number of
waypoints to which it may drive. Therefore, no plan is ahead of its robot, and a robot never enters
a waypoint before all robots that were to use this waypoint earlier have left it.
"""

from __future__ import annotations

import logging
from typing import TYPE_CHECKING

from rmfs.demonstrator.server.pursuit import Pursuit, quarter_turns
from rmfs.demonstrator.server.real import RealRobot
from rmfs.traffic import Traffic

if TYPE_CHECKING:
    from collections.abc import Sequence

    from rmfs.demonstrator.robot.protocol import Message
    from rmfs.layout.model import Layout
    from rmfs.traffic import PlannedMove

_log = logging.getLogger("rmfs.demonstrator")

TICK_US = 50_000
"""Time between two ticks, in microseconds."""
GIVE_UP_US = 30_000_000
"""Time, in microseconds, that a robot may be silent before the others are planned around it."""
MOST_TROUBLES = 2
"""Number of failed attempts at a route order after which others are planned around the robot."""
GONE_US = 3_600_000_000
"""Time, in microseconds, by which a robot's plan is postponed if others are planned around it."""
SETTLE_US = 4_000_000
"""Time, in microseconds, allowed for a robot to stop at the last waypoint granted to it when plans
are made anew."""

COUNTED = (
    *("orders", "delays", "regroupings", "strayed"),
    *("unknown_tags", "given_up", "troubles", "nonsense"),
)


class Guide:
    """Guides real robots along the plans of a traffic layer.

    Parameters
    ----------
    layout
        A layout that `check_floor` accepts.
    traffic
        The traffic layer, which holds the plans of all robots.
    robots
        Indices of the real or emulated robots; the other robots are simulated.
    tags
        The tag of every waypoint.
    """

    def __init__(
        self, layout: Layout, traffic: Traffic, robots: Sequence[int], tags: Sequence[str]
    ) -> None:
        self.layout, self.traffic, self.tags = layout, traffic, list(tags)
        self._waypoint_of = {tag: waypoint for waypoint, tag in enumerate(tags)}
        self.robots = {
            robot: RealRobot(robot, float(layout.robot_heading_rad[robot])) for robot in robots
        }
        self._orders = 0
        self._outbox: list[tuple[int, Message]] = []
        self._regroup_due = False
        self.counts = dict.fromkeys(COUNTED, 0)

    def tick(
        self,
        messages: Sequence[tuple[int, Message]],
        silent: frozenset[int],
        *,
        regroups: bool = True,
    ) -> list[tuple[int, Message]]:
        """Process one tick at the present time of the traffic layer.

        Parameters
        ----------
        messages
            Indices of the senders and their messages, in order of arrival.
        silent
            Indices of robots that have a session but have sent nothing for 3 s.
        regroups
            Whether new plans for all robots may be made in this tick. If false, new plans that are
            due are made in a later tick. Default: True.

        Returns
        -------
        The messages to send, each with the index of the robot that is to receive it.
        """
        for index, message in messages:
            try:
                self._hear(self.robots[index], message)
            except (KeyError, TypeError, ValueError) as error:
                self.counts["nonsense"] += 1
                _log.warning("robot %d: invalid message %s: %r", index, message.get("type"), error)
        self._look_after_silent(silent)
        if self._regroup_due and regroups:
            self._regroup()
        self._delay_late()
        for robot in self.robots.values():
            self._send_off(robot)
        outbox, self._outbox = self._outbox, []
        return outbox

    def forget_strayed(self) -> None:
        """Forget which robots have strayed from their paths.

        If a robot reads a tag outside its path during a route order, it reports again that it has
        strayed.
        """
        for robot in self.robots.values():
            robot.astray = None

    # --- what robots say ------------------------------------------------------------------------

    def _hear(self, robot: RealRobot, message: Message) -> None:
        robot.heard_us = self.traffic.now_us
        kind, pursuit = message.get("type"), robot.pursuit
        if kind == "connected":
            robot.is_present = True
        elif kind == "gone":
            robot.is_present = False
        elif kind == "state":
            self._compare(robot, message)
        elif kind in ("tag", "seen", "astray"):
            self._see(robot, str(message.get("tag")), lost=kind == "astray")
        elif kind == "trouble":
            self.counts["troubles"] += 1
            _log.warning("robot %d: %s", robot.index, message.get("reason"))
            if pursuit is not None and message.get("id") == pursuit.number:
                pursuit.troubles += 1
                if pursuit.troubles < MOST_TROUBLES:
                    self._tell_again(robot)
                else:
                    self._give_up(robot, "in trouble")
        elif pursuit is not None and message.get("id") == pursuit.number:
            if kind == "turned":
                pursuit.turned = True
            elif kind == "done":
                self._finish(robot, pursuit)

    def _finish(self, robot: RealRobot, pursuit: Pursuit) -> None:
        pursuit.done = pursuit.turned = True
        pursuit.passed = len(pursuit.waypoints)
        robot.heading_rad = pursuit.move.heading_rad
        if robot.given_up:
            self._regroup_due = True

    def _see(self, robot: RealRobot, tag: str, *, lost: bool) -> None:
        waypoint = self._waypoint_of.get(tag)
        if waypoint is None:
            self.counts["unknown_tags"] += 1
            _log.warning("robot %d reports tag %s, which is not in the layout", robot.index, tag)
            if lost:
                self._tell_again(robot)
            return
        pursuit = robot.pursuit
        was_given_up = robot.given_up and robot.is_present
        if was_given_up:
            # somebody has put it back on a tag
            robot.given_up, self._regroup_due = False, True
        if pursuit is not None and not pursuit.done and pursuit.pass_waypoint(waypoint):
            pursuit.troubles = 0
            if lost or was_given_up:
                self._tell_again(robot)
            return
        if lost or was_given_up:
            _log.warning("robot %d has lost its way and is at waypoint %d", robot.index, waypoint)
            self.counts["strayed"] += 1
            robot.astray = waypoint
            self._regroup_due = True

    def _compare(self, robot: RealRobot, state: Message) -> None:
        """Process the state that a robot reports at the beginning of a session."""
        pursuit = robot.pursuit
        if pursuit is None or pursuit.done:
            return
        if int(state["last_done"]) >= pursuit.number:
            self._finish(robot, pursuit)
            return
        if state["id"] == pursuit.number:
            pursuit.turned = pursuit.turned or bool(state["turned"])
            pursuit.passed = max(pursuit.passed, min(int(state["passed"]), len(pursuit.waypoints)))
        self._tell_again(robot)

    def _tell_again(self, robot: RealRobot) -> None:
        if robot.pursuit is not None and not robot.pursuit.done:
            self._outbox.append((robot.index, robot.pursuit.order(self.tags)))

    # --- late robots ------------------------------------------------------------------------------

    def _delay_late(self) -> None:
        """Delay plans that require, before the next tick, steps that robots have not confirmed."""
        horizon_us = self.traffic.now_us + TICK_US + 1
        for robot in self.robots.values():
            plan = self.traffic.plan(robot.index)
            if not plan:
                continue
            due_us = self._due_us(robot, plan[0])
            if due_us < horizon_us:
                self.counts["delays"] += 1
                self.traffic.delay(robot.index, horizon_us - due_us, begun=True)

    def _due_us(self, robot: RealRobot, move: PlannedMove) -> int:
        """Return when (us) the plan requires a step that the robot has not confirmed."""
        pursuit = robot.pursuit
        if robot.astray is not None:
            return self.traffic.now_us
        if pursuit is not None and not pursuit.done:
            return (
                pursuit.next_us(move)
                if _is_same(pursuit.move, move)
                else self._begin_us(robot, move)
            )
        if pursuit is not None and _is_same(pursuit.move, move):
            return 1 << 62
        return self._begin_us(robot, move) if not robot.is_present else 1 << 62

    def _begin_us(self, robot: RealRobot, move: PlannedMove) -> int:
        """Return when (us) a robot has to begin a move, including the turn before it."""
        pursuit = robot.pursuit
        heading = pursuit.move.heading_rad if pursuit is not None else robot.heading_rad
        return move.start_us - self._turn_us(robot.index, heading, move.heading_rad)

    def _turn_us(self, robot: int, before_rad: float, after_rad: float) -> int:
        kind = self.layout.robot_kinds[int(self.layout.robot_kind[robot])]
        quarters = quarter_turns(before_rad, after_rad)
        return round(min(quarters, 4 - quarters) / 4 * kind.full_turn_s * 1e6)

    # --- orders -----------------------------------------------------------------------------------

    def _send_off(self, robot: RealRobot) -> None:
        """Send a robot its next route order when this is due, and grant it all clear waypoints."""
        if robot.astray is not None:
            return
        plan = self.traffic.plan(robot.index)
        if robot.is_busy:
            assert robot.pursuit is not None
            if plan and _is_same(robot.pursuit.move, plan[0]):
                self._grant(robot.pursuit, robot.index)
            return
        if not plan or (robot.pursuit is not None and _is_same(robot.pursuit.move, plan[0])):
            return
        if self._begin_us(robot, plan[0]) >= self.traffic.now_us:
            return
        self._orders += 1
        self.counts["orders"] += 1
        pursuit = Pursuit.of(self._orders, plan[0], robot.heading_rad, self.layout, robot.index)
        robot.pursuit = pursuit
        self._grant(pursuit, robot.index)
        self._outbox.append((robot.index, pursuit.order(self.tags)))

    def _grant(self, pursuit: Pursuit, robot: int) -> None:
        if not pursuit.turned:
            return  # it could drive on while its plan has not begun
        clear = set(self.traffic.clearance(robot))
        granted = pursuit.passed
        while granted < len(pursuit.waypoints) and pursuit.waypoints[granted] in clear:
            granted += 1
        if granted > pursuit.granted:
            pursuit.granted = granted
            self._outbox.append(
                (robot, {"type": "grant", "id": pursuit.number, "granted": granted})
            )

    # --- robots that are lost or silent -----------------------------------------------------------

    def _look_after_silent(self, silent: frozenset[int]) -> None:
        now_us = self.traffic.now_us
        for robot in self.robots.values():
            is_silent = not robot.is_present or robot.index in silent
            if is_silent and robot.is_busy and now_us - robot.heard_us > GIVE_UP_US:
                self._give_up(robot, "silent")
            elif not is_silent and robot.given_up and not robot.is_busy:
                robot.given_up = False
                self._regroup_due = True

    def _give_up(self, robot: RealRobot, why: str) -> None:
        if not robot.given_up:
            _log.warning("robot %d is %s; others go around it", robot.index, why)
            robot.given_up = self._regroup_due = True
            self.counts["given_up"] += 1

    def _regroup(self) -> None:
        """Make new plans for all robots, from where each robot is or will stop."""
        rests: list[tuple[int, float, int] | None] = []
        cut = []
        for index in range(self.layout.robots):
            robot = self.robots.get(index)
            if robot is None:
                rests.append(self._rest_of_simulated(index))
            elif robot.given_up and robot.is_busy:
                assert robot.pursuit is not None
                self._grant(robot.pursuit, index)
                self.traffic.delay(index, GONE_US, begun=True)
                rests.append(None)
                cut.append(robot)
            elif self._is_under_way(robot):
                rests.append(None)
                cut.append(robot)
            else:
                rests.append(self._rest_of_real(robot))
                if robot.is_busy and robot.astray is None:
                    cut.append(robot)
        try:
            self.traffic.regroup(rests)
        except ValueError as error:
            _log.debug("new plans cannot be made yet: %s", error)
            return
        self._regroup_due = False
        self.counts["regroupings"] += 1
        for robot in cut:
            self._cut(robot)
        for robot in self.robots.values():
            robot.astray = None

    def _is_under_way(self, robot: RealRobot) -> bool:
        """Return whether a robot is driving as planned, up to the last waypoint granted.

        Such a robot keeps its run, up to this waypoint, when new plans are made.
        """
        pursuit = robot.pursuit
        if pursuit is None or pursuit.done or robot.astray is not None:
            return False
        plan = self.traffic.plan(robot.index)
        if not plan or not _is_same(pursuit.move, plan[0]):
            return False
        self._grant(pursuit, robot.index)
        clear = self.traffic.clearance(robot.index)
        upto = max(pursuit.granted, pursuit.passed)
        if not clear or not upto or clear[-1] != pursuit.waypoints[upto - 1]:
            return False
        # one that strayed onto this way has to leave it first
        strayed = {other.astray for other in self.robots.values() if other.astray is not None}
        return strayed.isdisjoint(pursuit.waypoints[:upto])

    def _rest_of_simulated(self, index: int) -> tuple[int, float, int] | None:
        """Return where and when a simulated robot stops; None if it rests or keeps its run."""
        plan, now_us = self.traffic.plan(index), self.traffic.now_us
        if not plan or plan[0].start_us > now_us or self.traffic.clearance(index):
            return None
        move = plan[0]
        return move.from_waypoint, move.heading_rad, max(move.end_us, now_us)

    def _rest_of_real(self, robot: RealRobot) -> tuple[int, float, int]:
        if robot.astray is not None:
            heading = robot.heading_at(self.layout, robot.astray)
            robot.heading_rad, robot.pursuit = heading, None
            return robot.astray, heading, 0
        pursuit = robot.pursuit
        if pursuit is None or pursuit.done:
            plan = self.traffic.plan(robot.index)
            at = plan[0].from_waypoint if plan else self.traffic.rest_waypoint(robot.index)
            return (at if pursuit is None else pursuit.end), robot.heading_rad, 0
        stop = [
            pursuit.move.from_waypoint,
            *pursuit.waypoints[: max(pursuit.granted, pursuit.passed)],
        ][-1]
        return stop, pursuit.move.heading_rad, self.traffic.now_us + SETTLE_US

    def _cut(self, robot: RealRobot) -> None:
        """Shorten a robot's route order so that it ends at the last waypoint granted."""
        pursuit = robot.pursuit
        assert pursuit is not None
        plan = self.traffic.plan(robot.index)
        kept = plan[0] if plan and plan[0].start_us == pursuit.move.start_us else None
        pursuit.cut()
        if kept is not None and kept.to_waypoint == pursuit.end and pursuit.waypoints:
            pursuit.follow(kept, self.layout, robot.index)
        message = {"type": "cut", "id": pursuit.number, "upto": len(pursuit.waypoints)}
        self._outbox.append((robot.index, message))


def _is_same(known: PlannedMove, move: PlannedMove) -> bool:
    """Return whether a move is the known one, which may have been delayed."""
    return (known.from_waypoint, known.to_waypoint) == (move.from_waypoint, move.to_waypoint) and (
        known.start_us == move.start_us
    )

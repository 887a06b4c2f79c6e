"""Route orders: commands by which robots carry out the moves of their plans."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from rmfs.traffic import Motion

if TYPE_CHECKING:
    from rmfs.demonstrator.robot.protocol import Message
    from rmfs.layout.model import Layout
    from rmfs.traffic import PlannedMove

_TURNS = {0: [], 1: ["left"], 2: ["around"], 3: ["right"]}


@dataclass
class Pursuit:
    """A route order that the server has sent to a robot, and the robot's progress.

    A route order tells the robot to carry out one move of its plan: to turn, if necessary, and then
    to drive straight over waypoints.

    Attributes
    ----------
    number
        Number of the route order.
    move
        The move that the route order carries out, with the times planned when the route order was
        created. If the robot is late, the times in the plan change, but those in `move` do not.
    heading_before_rad
        Heading of the robot, in rad, before the turn.
    waypoints
        Waypoints over which the robot drives, without the first waypoint of the move.
    along_m
        Distance of each of these waypoints from the first waypoint of the move, in m.
    seconds
        Driving time to each of these waypoints, in s, from standstill at the first waypoint.
    passed
        Number of these waypoints that the robot has confirmed.
    turned
        Whether the robot has turned or need not turn.
    done
        Whether the robot has completed the route order.
    granted
        Number of these waypoints to which the robot may drive so far; 0 until it has turned.
    troubles
        Number of times the robot has reported trouble since it last confirmed a waypoint.
    """

    number: int
    move: PlannedMove
    heading_before_rad: float
    waypoints: list[int]
    along_m: list[float]
    seconds: list[float]
    passed: int = 0
    turned: bool = False
    done: bool = False
    granted: int = 0
    troubles: int = 0

    @classmethod
    def of(
        cls, number: int, move: PlannedMove, heading_rad: float, layout: Layout, robot: int
    ) -> Pursuit:
        """Create the route order for a move that has not begun."""
        waypoints, along, seconds = _course(layout, move, robot)
        turned = quarter_turns(heading_rad, move.heading_rad) == 0
        return cls(number, move, heading_rad, waypoints, along, seconds, turned=turned)

    def next_us(self, move: PlannedMove) -> int:
        """Return the planned arrival time, in us, at the next waypoint that is to be confirmed.

        If the robot has confirmed all waypoints, return the planned end of the move.

        Parameters
        ----------
        move
            The move with the times that are planned now.
        """
        if self.passed == len(self.waypoints):
            return move.end_us
        late_us = move.end_us - move.start_us - math.ceil(self.seconds[-1] * 1e6)
        return move.start_us + late_us + math.floor(self.seconds[self.passed] * 1e6)

    def pass_waypoint(self, waypoint: int) -> bool:
        """Record that the robot was at a waypoint; return False if it is not one of `waypoints`."""
        if waypoint not in self.waypoints:
            return False
        self.turned = True
        self.passed = max(self.passed, self.waypoints.index(waypoint) + 1)
        return True

    def cut(self) -> None:
        """End the route order at the last granted waypoint."""
        upto = max(self.granted, self.passed)
        del self.waypoints[upto:], self.along_m[upto:], self.seconds[upto:]

    def follow(self, move: PlannedMove, layout: Layout, robot: int) -> None:
        """Replace the move by its shortened version `move`; update waypoints, distances, times."""
        self.move = move
        self.waypoints, self.along_m, self.seconds = _course(layout, move, robot)

    @property
    def end(self) -> int:
        """The waypoint at which the route order ends."""
        return self.waypoints[-1] if self.waypoints else self.move.from_waypoint

    def order(self, tags: list[str]) -> Message:
        """Return the route order as a message to the robot; a completed turn is left out.

        Parameters
        ----------
        tags
            The floor tag of each waypoint of the layout.
        """
        quarters = quarter_turns(self.heading_before_rad, self.move.heading_rad)
        turn = [] if self.turned else _TURNS[quarters]
        return {
            "type": "go",
            "id": self.number,
            "actions": turn + ["straight"] * len(self.waypoints),
            "start": tags[self.move.from_waypoint],
            "tags": [tags[waypoint] for waypoint in self.waypoints],
            "metres": np.diff(self.along_m, prepend=0.0).round(6).tolist(),
            "granted": self.granted,
            "turned": self.turned,
            "passed": self.passed,
        }


def _course(
    layout: Layout, move: PlannedMove, robot: int
) -> tuple[list[int], list[float], list[float]]:
    """Return the values of `waypoints`, `along_m` and `seconds` for a move (see `Pursuit`)."""
    waypoints = straight_way(layout, move)
    x, y = layout.x_m, layout.y_m
    start = move.from_waypoint
    along = [float(math.hypot(x[w] - x[start], y[w] - y[start])) for w in waypoints]
    kind = layout.robot_kinds[int(layout.robot_kind[robot])]
    motion = Motion(
        kind.acceleration_m_s2, kind.deceleration_m_s2, kind.top_speed_m_s, 0.0, along[-1]
    )
    return waypoints, along, [motion.time_at(distance) for distance in along]


def quarter_turns(before_rad: float, after_rad: float) -> int:
    """Return the anticlockwise turn from one heading (rad) to another, as 0 to 3 quarter turns."""
    return round((after_rad - before_rad) / (math.pi / 2)) % 4


def straight_way(layout: Layout, move: PlannedMove) -> list[int]:
    """Return the waypoints of a straight move, except the first."""
    along = np.array([math.cos(move.heading_rad), math.sin(move.heading_rad)])
    here, way = move.from_waypoint, []
    while here != move.to_waypoint:
        targets = layout.edge_target[layout.edge_start[here] : layout.edge_start[here + 1]]
        step = np.stack(
            [layout.x_m[targets] - layout.x_m[here], layout.y_m[targets] - layout.y_m[here]]
        )
        length = np.hypot(*step)
        straight = (step / length * along[:, None]).sum(axis=0)
        here = int(targets[int(straight.argmax())])
        way.append(here)
    return way

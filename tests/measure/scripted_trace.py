"""Hand-made layouts and traces: what the checker reads, built without the code it checks."""

from __future__ import annotations

import math

import numpy as np

from rmfs.layout.model import Elevator, Layout, RobotKind, Tier

HOLD, TURN, RUN, LIFT_RIDE, LIFT, SET_DOWN, GUIDED = range(7)
COLUMNS = (
    "robot",
    "t0_us",
    "t1_us",
    "kind",
    "from_wp",
    "to_wp",
    "heading0_rad",
    "heading1_rad",
    "pod",
)
KIND = RobotKind(0.35, 0.5, 0.5, 1.5, 2.5, 2.2)


def grid(
    columns: int,
    rows: int,
    robots: list[int],
    *,
    pods: tuple[int, ...] = (),
    storage: tuple[int, ...] = (),
    queue: tuple[int, ...] = (),
    tiers: int = 1,
    elevator: int | None = None,
    kinds: tuple[RobotKind, ...] = (KIND,),
    robot_kind: list[int] | None = None,
) -> Layout:
    """Waypoints 1 m apart, neighbours joined both ways; waypoint = tier, row, column in order."""
    floor = columns * rows
    number = np.arange(floor * tiers)
    column, row, tier = number % columns, number // columns % rows, number // floor
    targets: list[list[int]] = [
        [
            int(v)
            for v in number
            if tier[v] == tier[u] and abs(column[v] - column[u]) + abs(row[v] - row[u]) == 1
        ]
        for u in number
    ]
    elevators = ()
    if elevator is not None:
        doors = tuple(elevator + floor * t for t in range(tiers))
        travel = {(a, b): 10.0 for a in doors for b in doors if a != b}
        elevators = (Elevator(doors, travel, {door: (door,) for door in doors}),)
    is_storage = np.isin(number, storage + pods)
    return Layout(
        name="grid",
        tiers=tuple(Tier(columns, rows) for _ in range(tiers)),
        x_m=column.astype(float),
        y_m=row.astype(float),
        tier=tier.astype(np.int16),
        edge_start=np.cumsum([0, *map(len, targets)]).astype(np.int32),
        edge_target=np.array([v for out in targets for v in out], np.int32),
        is_storage=is_storage,
        is_queue=np.isin(number, queue),
        pick_stations=(),
        replenishment_stations=(),
        elevators=elevators,
        pod_waypoint=np.array(pods, np.int32),
        pod_capacity=np.full(len(pods), 500.0),
        pod_radius_m=0.4,
        robot_waypoint=np.array(robots, np.int32),
        robot_heading_rad=np.zeros(len(robots)),
        robot_kind=np.array(robot_kind or [0] * len(robots), np.int16),
        robot_kinds=kinds,
    )


def run_duration_s(length: float, kind: RobotKind = KIND) -> float:
    """Rest to rest over a length, from the textbook."""
    a, d, v = kind.acceleration_m_s2, kind.deceleration_m_s2, kind.top_speed_m_s
    ramps = v * v / 2 / a + v * v / 2 / d
    if length < ramps:
        v = math.sqrt(2 * length * a * d / (a + d))
        return v / a + v / d
    return v / a + v / d + (length - ramps) / v


class Script:
    """Writes one robot's rows after another."""

    def __init__(self, layout: Layout) -> None:
        self.layout = layout
        self.rows: list[list[float]] = []

    def robot(self, robot: int) -> RobotScript:
        return RobotScript(self, robot)

    def columns(self, until_s: float | None = None) -> dict[str, np.ndarray]:
        """The trace; every robot holds at its last place until the common end."""
        ends = [row[2] for row in self.rows]
        until = max(ends) if until_s is None else round(until_s * 1e6)
        closing = []
        for robot in range(self.layout.robots):
            own = [row for row in self.rows if row[0] == robot]
            if own and own[-1][2] < until:
                last = own[-1]
                pod = -1 if last[3] == SET_DOWN else last[8]
                closing.append(
                    [robot, last[2], until, HOLD, last[5], last[5], last[7], last[7], pod]
                )
        rows = sorted(self.rows + closing, key=lambda row: (row[0], row[1]))
        return {name: np.array([row[k] for row in rows]) for k, name in enumerate(COLUMNS)}


class RobotScript:
    """The motions of one robot, told in the order it makes them; times in s."""

    def __init__(self, script: Script, robot: int) -> None:
        layout = script.layout
        self.script, self.number = script, robot
        self.kind = layout.robot_kinds[layout.robot_kind[robot]]
        self.at = int(layout.robot_waypoint[robot])
        self.heading = float(layout.robot_heading_rad[robot])
        self.now_us = 0
        self.pod = -1

    def _add(self, kind: int, duration_s: float, to: int, heading: float) -> RobotScript:
        end = self.now_us + math.ceil(duration_s * 1e6 - 1e-3)
        self.script.rows.append(
            [self.number, self.now_us, end, kind, self.at, to, self.heading, heading, self.pod]
        )
        self.now_us, self.at, self.heading = end, to, heading
        return self

    def hold(self, seconds: float) -> RobotScript:
        return self._add(HOLD, seconds, self.at, self.heading)

    def turn(self, heading: float) -> RobotScript:
        angle = abs((heading - self.heading + math.pi) % (2 * math.pi) - math.pi)
        return self._add(TURN, angle / 2 / math.pi * self.kind.full_turn_s, self.at, heading)

    def run(self, to: int) -> RobotScript:
        """Turn towards a waypoint if needed and drive there."""
        layout = self.script.layout
        dx, dy = layout.x_m[to] - layout.x_m[self.at], layout.y_m[to] - layout.y_m[self.at]
        heading = math.atan2(dy, dx)
        if abs(heading - self.heading) > 1e-9:
            self.turn(heading)
        return self._add(RUN, run_duration_s(math.hypot(dx, dy), self.kind), to, heading)

    def guided(self, to: int, seconds: float) -> RobotScript:
        """Turn towards a waypoint if needed and be on the way there for so long."""
        layout = self.script.layout
        dx, dy = layout.x_m[to] - layout.x_m[self.at], layout.y_m[to] - layout.y_m[self.at]
        heading = math.atan2(dy, dx)
        if abs(heading - self.heading) > 1e-9:
            self.turn(heading)
        return self._add(GUIDED, seconds, to, heading)

    def ride(self, to: int, seconds: float = 10.0) -> RobotScript:
        return self._add(LIFT_RIDE, seconds, to, self.heading)

    def lift(self, pod: int) -> RobotScript:
        self.pod = pod
        return self._add(LIFT, self.kind.pod_transfer_s, self.at, self.heading)

    def set_down(self) -> RobotScript:
        self._add(SET_DOWN, self.kind.pod_transfer_s, self.at, self.heading)
        self.pod = -1
        return self

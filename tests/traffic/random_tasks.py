"""Random fetch, deliver, store tasks on traffic alone: no orders, no stock, no decisions."""

from __future__ import annotations

import heapq
import random
from dataclasses import dataclass, field

from rmfs.traffic import TIME_WINDOWS, EventKind, PlannerSettings, Step, Traffic


@dataclass
class RandomTasks:
    """Keeps every robot busy with random tasks and counts what each has done.

    A storage location is offered again once the robot that lifts its pod has planned to leave.
    """

    layout: object
    seed: int = 0
    record_trace: bool = True
    planner: PlannerSettings = TIME_WINDOWS
    visits: list[tuple[float, int]] = field(default_factory=list)

    def __post_init__(self):
        self.random = random.Random(self.seed)
        self.traffic = Traffic(self.layout, record_trace=self.record_trace, planner=self.planner)
        self.place = self.layout.pod_waypoint.tolist()
        taken = set(self.place)
        storage = self.layout.is_storage.nonzero()[0].tolist()
        self.free = [place for place in storage if place not in taken]
        self.idle_pods = list(range(self.layout.pods))
        self.task = {}
        self.lifted = set()
        self.bound_for = [0] * len(self.layout.stations)
        self.served = []
        for robot in range(self.layout.robots):
            self.fetch(robot)

    def fetch(self, robot):
        pod = self.idle_pods.pop(self.random.randrange(len(self.idle_pods)))
        room = [
            s for s, n in enumerate(self.bound_for) if n < len(self.layout.stations[s].queue) - 1
        ]
        station = self.random.choice(room)
        self.bound_for[station] += 1
        self.task[robot] = (pod, station)
        steps = [(Step.DRIVE, self.place[pod]), (Step.LIFT, pod), (Step.STATION, station)]
        self.traffic.command(robot, steps)

    def store(self, robot, now_us):
        pod, station = self.task[robot]
        self.bound_for[station] -= 1
        self.visits.append((now_us / 1e6, robot))
        place = self.place[pod] = self.free.pop(self.random.randrange(len(self.free)))
        self.traffic.command(robot, [(Step.DRIVE, place), (Step.SET_DOWN, pod)])

    def run(self, until_s):
        end = round(until_s * 1e6)
        while self.traffic.now_us < end:
            limit = min(self.served[0][0], end) if self.served else end
            for time, kind, robot, value in self.traffic.advance(limit):
                self.handle(time, kind, robot, value)
            while self.served and self.served[0][0] <= self.traffic.now_us:
                now, robot = heapq.heappop(self.served)
                self.store(robot, now)
        return self

    def handle(self, time, kind, robot, value):
        if kind == EventKind.AT_HEAD:
            service_us = self.random.randrange(8_000_000, 14_000_000)
            heapq.heappush(self.served, (time + service_us, robot))
        elif kind == EventKind.LIFT_STARTED:
            self.lifted.add(robot)
        elif kind == EventKind.DEPARTED and robot in self.lifted:
            pod, _ = self.task[robot]
            if self.place[pod] == value and value not in self.free:
                self.free.append(value)
        elif kind == EventKind.SET_DOWN:
            self.lifted.discard(robot)
            self.idle_pods.append(self.task[robot][0])
            self.fetch(robot)

"""Robots that come at random times to plug-in places wait as the formula for M/D/c says.

Places, their service and the rule `soonest` are those of a run; robots come from nowhere, so that
nothing but the queue is measured.
"""

from __future__ import annotations

from collections import deque
from functools import partial
from math import exp, lgamma, log
from types import SimpleNamespace

import numpy as np
import pytest
from scipy.stats import t as student

from rmfs.control.ca.places import choose
from rmfs.layout.charging import Charger
from rmfs.simulation.agenda import Agenda
from rmfs.simulation.charging.service import ChargeService
from rmfs.world.batteries import Batteries
from rmfs.world.charging import ChargeTask, RecoveryStation

CHARGE_S = 600.0


def mean_wait_s(load: float, places: int) -> float:
    """Mean wait of M/D/c (Crommelin 1932), in s, for a load per place below 1."""

    def poisson(mean, number):
        return exp(number * log(mean) - mean - lgamma(number + 1))

    def tail(mean, first):
        """P(N >= first)."""
        return 1.0 - sum(poisson(mean, number) for number in range(first))

    offered, total = load * places, 0.0
    for i in range(1, 400):
        mean = i * offered
        total += tail(mean, i * places) - tail(mean, i * places + 1) / load
    return CHARGE_S * total


def test_the_formula_for_one_place_is_that_of_pollaczek_and_khinchine():
    for load in (0.3, 0.5, 0.7):
        assert mean_wait_s(load, 1) == pytest.approx(CHARGE_S * load / 2 / (1 - load), rel=1e-6)


class Levels:
    """Batteries that are charged at a constant rate while their robot is plugged in."""

    def __init__(self, agenda, power_w):
        self.agenda, self.power_w, self.since = agenda, power_w, {}

    def level_j(self, robot):
        since = self.since.get(robot)
        gone_s = 0.0 if since is None else (self.agenda.now_us - since) / 1e6
        return 0.2 * 3.6e6 + self.power_w * gone_s


class Floor:
    """Places with a queue each, and robots that come and vanish."""

    def __init__(self, places, per_s, seed):
        self.agenda, self.rng, self.per_s = Agenda(), np.random.default_rng(seed), per_s
        power_w = 0.6 * 3.6e6 / CHARGE_S
        self.levels = Levels(self.agenda, power_w)
        given = SimpleNamespace(
            capacity_wh=1000.0, least_share=0, reserve_share=0, taper_from_share=1.0, full_share=1.0
        )
        kind = Charger(Charger.parameters_model(power_w=power_w))
        plan = SimpleNamespace(kind=kind, queue=range(10**6))
        self.world = SimpleNamespace(batteries=Batteries(given, self.levels), robots=[], now_s=0.0)
        self.world.end_task = self.leave
        self.stations = [RecoveryStation(i, i, 0, 0) for i in range(places)]
        travel = SimpleNamespace(robot_waypoint=lambda robot: 0, to=lambda at, loaded: [0.0])
        self.view = SimpleNamespace(
            recovery_stations=self.stations,
            layout=SimpleNamespace(stations=[plan] * places),
            batteries=self.world.batteries,
            travel=travel,
        )
        events = SimpleNamespace(station_busy=lambda *_: None, robot_free=lambda robot: None)
        self.services = [
            ChargeService(station, plan, agenda=self.agenda, world=self.world, events=events)
            for station in self.stations
        ]
        self.queues = [deque() for _ in range(places)]
        self.waits_s = []
        self.come_later()

    def come_later(self):
        self.agenda.after(round(self.rng.exponential(1 / self.per_s) * 1e6), self.come)

    def come(self):
        robot = SimpleNamespace(index=len(self.world.robots), station=-1, came=self.agenda.now_us)
        self.world.robots.append(robot)
        number = choose(self.view, robot, "soonest")
        robot.task = ChargeTask(robot.index, station=number, until_share=0.8)
        self.stations[number].tasks[robot.index] = robot.task
        self.queues[number].append(robot)
        self.serve(number)
        self.come_later()

    def serve(self, number):
        station = self.stations[number]
        if station.robot < 0 and self.queues[number]:
            robot = self.queues[number].popleft()
            station.robot = robot.index
            self.levels.since[robot.index] = self.agenda.now_us
            self.waits_s.append((self.agenda.now_us - robot.came) / 1e6)
            self.services[number].go_on()

    def leave(self, robot):
        number = robot.task.station
        del self.stations[number].tasks[robot.index]
        self.stations[number].robot = -1
        self.agenda.when_settled(partial(self.serve, number))

    def run(self, robots):
        while len(self.waits_s) < robots:
            self.agenda.now_us = self.agenda.next_us
            self.agenda.run_due()
            while self.agenda.run_settled():
                pass
        return self.waits_s


@pytest.mark.parametrize("load", [0.5, 0.7, 0.85])
def test_waits_are_those_of_m_d_c(load):
    places, robots, warm = 3, 2200, 200
    means = [
        np.mean(Floor(places, load * places / CHARGE_S, seed).run(robots)[warm:])
        for seed in range(8)
    ]
    half = student.ppf(0.975, len(means) - 1) * np.std(means, ddof=1) / np.sqrt(len(means))
    assert abs(np.mean(means) - mean_wait_s(load, places)) < half
    assert half < 0.25 * mean_wait_s(load, places)

"""Energy in closed form against numerical integration of the power over the trace."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import quad

from rmfs.layout import load
from rmfs.traffic import Piece, Traffic
from tests.traffic.random_tasks import RandomTasks

ROBOT_KG, ROLLING, INERTIA, EFFICIENCY, BACK = 110.0, 0.02, 0.15, 0.8, 0.3
TURNING_M, GYRATION_M, LIFT_M, LIFT_EFFICIENCY, STANDBY_W = 0.006, 0.35, 0.05, 0.5, (30.0, 45.0)
MODEL = (
    *(ROBOT_KG, ROLLING, INERTIA, EFFICIENCY, BACK, TURNING_M, GYRATION_M),
    *(LIFT_M, LIFT_EFFICIENCY, *STANDBY_W),
)
GRAVITY = 9.80665


class Integrator:
    """Integrates power over pieces of motion, knowing nothing of the compiled core."""

    def __init__(self, layout, pods_kg):
        self.kind = layout.robot_kinds[0]
        self.x, self.y = layout.x_m, layout.y_m
        self.pods_kg = pods_kg
        self.runs = {}

    def mass(self, pod):
        return ROBOT_KG + (self.pods_kg[pod] if pod >= 0 else 0.0)

    def run(self, length, mass):
        """Integrate force times speed, phase by phase, with adaptive quadrature."""
        key = round(length, 9), mass
        if key in self.runs:
            return self.runs[key]
        a, b, top = (
            self.kind.acceleration_m_s2,
            self.kind.deceleration_m_s2,
            self.kind.top_speed_m_s,
        )
        peak = min(top, np.sqrt(2 * a * b * length / (a + b)))
        times = np.cumsum([peak / a, (length - peak**2 / 2 / a - peak**2 / 2 / b) / peak, peak / b])

        def speed(t):
            return min(a * t, peak, b * (times[2] - t))

        def power(t, acceleration):
            force = ROLLING * mass * GRAVITY + (1 + INERTIA) * mass * acceleration
            work = force * speed(t)
            return work / EFFICIENCY if work > 0 else BACK * work

        begins = (0.0, *times[:2])
        parts = zip(begins, times, (a, 0.0, -b), strict=True)
        whole = sum(
            quad(power, begin, end, args=(change,), epsabs=0, epsrel=1e-12)[0]
            for begin, end, change in parts
            if end > begin
        )
        self.runs[key] = whole
        return whole

    def turn(self, heading0, heading1, mass):
        """A turn at constant speed that begins and ends with a jump."""
        angle = abs((heading1 - heading0 + np.pi) % (2 * np.pi) - np.pi)
        speed = 2 * np.pi / self.kind.full_turn_s
        resistance = TURNING_M * mass * GRAVITY
        steady = quad(lambda t: resistance * speed, 0, angle / speed, epsrel=1e-12)[0]
        kinetic = mass * GYRATION_M**2 * speed**2 / 2
        return (steady + kinetic) / EFFICIENCY - BACK * kinetic

    def piece(self, row):
        """J of one row of the trace."""
        standby = STANDBY_W[row["pod"] >= 0] * (row["t1_us"] - row["t0_us"]) / 1e6
        mass = self.mass(row["pod"])
        match row["kind"]:
            case Piece.RUN:
                length = np.hypot(
                    self.x[row["to_wp"]] - self.x[row["from_wp"]],
                    self.y[row["to_wp"]] - self.y[row["from_wp"]],
                )
                return standby + self.run(length, mass)
            case Piece.TURN:
                return standby + self.turn(row["heading0_rad"], row["heading1_rad"], mass)
            case Piece.LIFT:
                return standby + self.pods_kg[row["pod"]] * GRAVITY * LIFT_M / LIFT_EFFICIENCY
        return standby


class Counting(RandomTasks):
    """Random tasks of robots whose energy is counted."""

    def __post_init__(self):
        super().__post_init__()
        self.pods_kg = np.random.default_rng(3).uniform(40, 450, self.layout.pods)
        self.traffic.count_energy(MODEL, self.pods_kg)


@pytest.fixture(scope="module")
def default_layout():
    return load("default", [(["robots"], 24)])


@pytest.fixture(scope="module")
def driven(default_layout):
    tasks = Counting(default_layout, seed=5)
    tasks.run(2600)
    return tasks


def rows_of(traffic):
    trace = traffic.trace()
    columns = [values.tolist() for values in trace.values()]
    return [dict(zip(trace, row, strict=True)) for row in zip(*columns, strict=True)]


def test_the_energy_of_a_thousand_trips_is_the_integral_of_their_power(driven):
    integrator = Integrator(driven.layout, driven.pods_kg)
    by_robot = [[] for _ in range(driven.layout.robots)]
    for row in rows_of(driven.traffic):
        by_robot[row["robot"]].append((row["t0_us"], row["t1_us"], integrator.piece(row)))
    trips = driven.traffic.trips()
    checked = 0
    for i, robot in enumerate(trips["robot"]):
        if trips["kind"][i] == 1:
            continue  # counted to the station, its time ends before
        begin, end = trips["t0_us"][i], trips["t1_us"][i]
        pieces = [one for one in by_robot[robot] if one[1] > begin and one[0] < end]
        cut = sum(
            joules
            if begin <= t0 and t1 <= end
            else joules * (min(t1, end) - max(t0, begin)) / (t1 - t0)
            for t0, t1, joules in pieces
        )  # only standing is cut
        assert trips["energy_j"][i] == pytest.approx(cut, rel=1e-9)
        checked += 1
    assert checked >= 1000


def test_totals_are_those_of_all_pieces_at_any_moment(default_layout):
    tasks = Counting(default_layout, seed=8)
    integrator = Integrator(default_layout, tasks.pods_kg)
    for until_s in (50.0, 50.123457, 77.7, 200.0):
        tasks.run(until_s)
        told = tasks.traffic.energy()
        now_us = tasks.traffic.now_us
        expected = np.zeros(default_layout.robots)
        whole = np.ones(default_layout.robots, bool)
        for row in rows_of(tasks.traffic):
            if row["t1_us"] > now_us:
                whole[row["robot"]] = False  # in the middle of a run
            expected[row["robot"]] += integrator.piece(row)
        assert whole.any()
        assert told["used_j"][whole] == pytest.approx(expected[whole], rel=1e-9)
        assert (told["used_j"][~whole] < expected[~whole] * (1 + BACK)).all()
        assert told["level_j"] == pytest.approx(-told["ever_used_j"], rel=1e-12)


def test_asking_in_between_changes_nothing(default_layout):
    asked, left_alone = Counting(default_layout, seed=2), Counting(default_layout, seed=2)
    for until_s in np.arange(1.0, 120.0, 0.7):
        asked.run(until_s)
        asked.traffic.energy()
    asked.run(120.0)
    left_alone.run(120.0)
    for name, values in left_alone.traffic.energy().items():
        assert np.array_equal(asked.traffic.energy()[name], values), name


def test_a_copy_and_a_saved_one_go_on_alike(default_layout):
    tasks = Counting(default_layout, seed=4)
    tasks.run(60.0)
    saved = Traffic.from_bytes(default_layout, tasks.traffic.to_bytes())
    fork = tasks.traffic.fork()
    for one in (tasks.traffic, saved, fork):
        one.advance(61_000_000)
    for name, values in tasks.traffic.energy().items():
        assert np.array_equal(saved.energy()[name], values)
        assert np.array_equal(fork.energy()[name], values)


def test_levels_begin_anew_with_statistics_but_not_in_the_battery(default_layout):
    tasks = Counting(default_layout, seed=6)
    tasks.run(30.0)
    before = tasks.traffic.energy()
    tasks.traffic.reset_statistics()
    after = tasks.traffic.energy()
    assert (after["used_j"] == 0).all()
    assert np.array_equal(after["level_j"], before["level_j"])


def charged(level, capacity, taper, power, seconds, steps=200_000):
    """Small steps of a battery whose power falls evenly above a share of its capacity."""
    dt = seconds / steps
    for _ in range(steps):
        falls = min(1.0, (capacity - level) / (capacity * (1 - taper)))
        level += power * falls * dt
    return level


def test_a_robot_that_stands_where_there_is_power_is_charged(default_layout):
    robots, capacity, taper, power = default_layout.robots, 1000.0, 0.8, 50.0
    traffic = Traffic(default_layout)
    watts = np.zeros(default_layout.waypoints)
    here = int(default_layout.robot_waypoint[0])
    watts[here] = power
    traffic.count_energy(
        MODEL,
        np.zeros(default_layout.pods),
        initial_j=np.full(robots, 300.0),
        battery=(capacity, taper),
        power_w=watts,
    )
    for until_s in (5, 12, 40):
        traffic.advance(until_s * 1_000_000)
        told = traffic.energy()
        expected = charged(300.0, capacity, taper, power, until_s)
        assert told["level_j"][0] == pytest.approx(expected, rel=1e-4)
        assert told["level_j"][1] == pytest.approx(300.0 - STANDBY_W[0] * until_s, rel=1e-12)
    assert told["charging_s"].tolist() == [40.0] + [0.0] * (robots - 1)
    # the charger fails, and later another battery is put in
    level = traffic.level_j(0)
    traffic.set_power(here, 0.0)
    traffic.advance(41_000_000)
    assert traffic.level_j(0) == pytest.approx(level - STANDBY_W[0], rel=1e-12)
    traffic.exchange_battery(0, 990.0)
    told = traffic.energy()
    assert told["level_j"][0] == pytest.approx(990.0, rel=1e-12)
    left = told["initial_j"] + told["ever_charged_j"] - told["ever_used_j"]
    assert told["level_j"] == pytest.approx(left, rel=1e-12)

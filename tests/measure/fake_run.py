"""A tiny run told by hand: the callbacks of a simulation without one.

Two pick stations (10 s a unit), one replenishment station, two robots, three pods, two SKUs; 100 s
of warm-up and 400 s measured. Every figure the tables should show can be worked out on paper.
"""

from __future__ import annotations

from dataclasses import replace
from math import nan
from types import SimpleNamespace
from typing import ClassVar

import numpy as np
import pydantic
from scripted_trace import Script, grid

from rmfs.control.asks import Answer, Ask, Call, Outcome
from rmfs.control.problems import Problem
from rmfs.layout.model import PickStation, ReplenishmentStation
from rmfs.measure.checker import check
from rmfs.measure.events import EventLog
from rmfs.measure.measures import SHIPPED
from rmfs.measure.recorder import Recorder

WARMUP_S, END_S = 100.0, 500.0


class FakeTraffic:
    """Motion that grows steadily: 1 m/s per robot, a tenth of the time queueing."""

    def __init__(self) -> None:
        self.since_s = 0.0
        self.now_s = 0.0

    def motion(self) -> dict[str, np.ndarray]:
        passed = self.now_s - self.since_s
        shares = {
            "moving": 0.5,
            "turning": 0.1,
            "waiting": 0.1,
            "served": 0.1,
            "transfer": 0.1,
            "riding": 0.0,
            "idle": 0.1,
            "queueing": 0.2,
            "awaiting_plan": 0.05,
        }
        return {
            "distance_m": np.full(2, passed),
            "loaded_distance_m": np.full(2, passed / 2),
            **{f"{name}_s": np.full(2, passed * share) for name, share in shares.items()},
        }

    def heat(self) -> dict[str, np.ndarray]:
        return {
            "visits": np.arange(12),
            "loaded_visits": np.arange(12) // 2,
            "waiting_s": np.linspace(0, 1, 12),
            "loaded_waiting_s": np.zeros(12),
            "stays_waypoint": np.arange(24) % 12,
            "stays_purpose": np.repeat([0, 2], 12),
            "stays_visits": np.concatenate([np.arange(12), np.zeros(12, int)]),
            "stays_waiting_s": np.concatenate([np.zeros(12), np.linspace(0, 1, 12)]),
        }

    def edges(self) -> dict[str, np.ndarray]:
        return {
            "from_wp": np.array([0, 1]),
            "to_wp": np.array([1, 2]),
            "passages": np.array([5, 3]),
            "loaded_passages": np.array([2, 3]),
        }

    def travel_times_to(self, waypoint: int, loaded: bool, robot: int = 0) -> np.ndarray:
        return np.full(12, 5.0)

    travel_times_from = travel_times_to

    def trips(self) -> dict[str, np.ndarray]:
        return {
            "robot": np.array([0, 1, 0]),
            "kind": np.array([0, 1, 2]),
            "t0_us": np.array([120, 130, 200]) * 10**6,
            "t1_us": np.array([130, 150, 230]) * 10**6,
            "from_wp": np.array([0, 1, 2]),
            "to_wp": np.array([3, 4, 5]),
            "loaded": np.array([False, True, True]),
            "distance_m": np.array([3.0, 4.0, 5.0]),
            "energy_j": np.zeros(3),
            "unhindered_s": np.array([10.0, 15.0, 20.0]),
            "awaited_s": np.array([0.0, 2.0, 1.0]),
        }

    def plans(self) -> dict[str, np.ndarray]:
        return {
            "robot": np.array([1, 0]),
            "asked_us": np.array([130, 200]) * 10**6,
            "begun_us": np.array([131, 200]) * 10**6,
            "labels": np.array([12, 5]),
            "took_us": np.array([1, 1]) * 10**6,
            "found": np.array([True, True]),
            "wall_s": np.array([2e-5, 1e-5]),
        }

    def counters(self) -> dict[str, float]:
        return {
            "plans": 7,
            "plan_failures": 2,
            "replans": 1,
            "expansions": 99,
            "cost_tables": 3,
            "planning_charged_s": 2.0,
            "planning_s": 0.25,
            "late_motions": 3,
            "lateness_s": 7.5,
            "repairs": 1,
        }

    def trace(self) -> dict[str, np.ndarray]:
        script = Script(layout())
        script.robot(0).run(3)
        script.robot(1).hold(1.0)
        columns = script.columns(END_S)
        return columns | {"top_speed_m_s": np.full(len(columns["robot"]), 1.5)}


def layout():
    base = grid(4, 3, [0, 8], pods=(1, 2, 3))
    return replace(
        base,
        pick_stations=tuple(
            PickStation(waypoint, (waypoint,), 0.4, 6, 10.0, 3.0, 1) for waypoint in (4, 5)
        ),
        replenishment_stations=(ReplenishmentStation(6, (6,), 0.4, 1000.0, 10.0, 1),),
    )


class Settings(pydantic.BaseModel):
    """Stands for a scenario or a set of controllers."""

    name: str = "fake"
    # a scenario that names no files
    skus: ClassVar = None
    demand: ClassVar = None
    replenishment: ClassVar = None

    def to_table(self) -> dict[str, str]:
        return {"name": self.name}

    def rules(self) -> list[type]:
        return []


def order(index, created, lines, *, due=nan, station=-1, assigned=nan, completed=nan):
    made = tuple(SimpleNamespace(sku=sku, units=units) for sku, units in lines)
    return SimpleNamespace(
        priority=-1,
        index=index,
        created_s=created,
        due_s=due,
        lines=made,
        all_lines=made,
        station=station,
        assigned_s=assigned,
        completed_s=completed,
        cancelled_s=nan,
        units_cut=0,
        in_file=-1,
    )


def bundle(index, created, *, station=-1, pod=-1, assigned=nan, stored=nan):
    return SimpleNamespace(
        index=index,
        sku=1,
        units=4,
        space=8.0,
        created_s=created,
        pod=pod,
        station=station,
        assigned_s=assigned,
        stored_s=stored,
        in_file=-1,
    )


def world():
    inventory = SimpleNamespace(
        unit_space=np.array([1.0, 2.0]),
        capacity=np.full(3, 100.0),
        used=np.array([30.0, 20.0, 10.0]),
        contained=np.array([[10, 0, 10], [10, 10, 0]]),
        total_capacity=300.0,
        stored_space=60.0,
        free_stock=np.array([20, 0]),
    )
    # two orders wait for a station; what the second asks for is not in stock
    waiting = [order(7, 100.0, [(0, 1)]), order(8, 200.0, [(1, 1)])]
    backlog = SimpleNamespace(servable=lambda _: np.array([True, False]), at_row=waiting)
    return SimpleNamespace(
        inventory=inventory,
        orders=backlog,
        skus=Skus(),
        staff=None,
        storage=SimpleNamespace(place_of=np.array([1, -1, 3])),
        order_redraws=5,
        orders_short=2,
        now_s=0.0,
    )


class Skus:
    """Two SKUs; the second is twice as large."""

    popularity = np.array([1.0, 3.0])
    space_per_unit = np.array([1.0, 2.0])
    ids = np.array([0, 1])
    names = ("A", "B")

    def __len__(self) -> int:
        return 2


def simulation(place, traffic):
    """What a recorder asks of a simulation: two disturbances last from begin to end."""
    scenario = SimpleNamespace(energy=None, packing=None, orders=SimpleNamespace(due=None))
    disturbances = SimpleNamespace(within=lambda start_s, end_s: (2, end_s - start_s))
    return SimpleNamespace(
        layout=layout(),
        scenario=scenario,
        world=place,
        traffic=traffic,
        disturbances=disturbances,
        order_stream=None,
        bundle_stream=None,
    )


def recorded() -> Recorder:
    """Tell a recorder the whole story."""
    recorder, traffic, place = Recorder(), FakeTraffic(), world()
    recorder.run_started(simulation(place, traffic))
    # warm-up: order 0 arrives, is assigned and done; order 1 arrives; a unit is picked
    zero, one = order(0, 0.0, [(0, 1)]), order(1, 0.0, [(0, 2), (1, 1)], due=300.0)
    recorder.order_created(zero)
    recorder.order_created(one)
    recorder.task_started(0.0, 0, "pick", 0)
    recorder.task_started(0.0, 1, "rest", -1)
    zero.station, zero.assigned_s = 0, 10.0
    place.now_s = 10.0
    recorder.order_assigned(zero)
    recorder.pod_lifted(20.0, 0, 0, 1)
    recorder.visit_started(50.0, 0, 0, 0)
    recorder.station_busy(0, 50.0, 60.0)
    recorder.unit_picked(53.0, zero, 0, 0, 0, 0, False)
    recorder.line_picked(53.0, zero, 0, 1)
    zero.completed_s = 60.0
    recorder.order_completed(zero)
    place.now_s = 60.0
    recorder.slot_freed(zero)
    recorder.decision("poa", 10.0, 0.5, 1)
    recorder.rule_decided("poa", 10.0)
    _question(recorder, 50.0, 60.0, applied=7)
    one.station, one.assigned_s = 0, 60.0
    recorder.order_assigned(one)
    recorder.station_busy(0, 95.0, 105.0)
    recorder.unit_picked(98.0, one, 0, 0, 0, 0, False)
    # the measured time begins while pod 0 still is at station 0
    place.order_redraws, place.orders_short = 6, 3
    traffic.since_s = traffic.now_s = WARMUP_S
    recorder.warmup_ended(WARMUP_S)
    recorder.station_busy(0, 105.0, 115.0)
    recorder.unit_picked(108.0, one, 0, 0, 0, 0, True)
    recorder.line_picked(108.0, one, 0, 2)
    recorder.visit_ended(110.0, 0, 0, 0)
    recorder.task_started(110.0, 0, "park", -1)
    two = order(2, 150.0, [(1, 3)], due=1000.0)
    place.orders_short += 4
    recorder.order_created(two)
    recorder.decision("poa", 150.0, 0.001, 2)
    recorder.rule_decided("poa", 150.0)
    recorder.rule_decided("poa", 150.0)
    _question(recorder, 160.0, 165.0, applied=2, stale=1)
    _sample(recorder, traffic, 160.0)
    recorder.pod_lifted(170.0, 1, 1, 2)
    recorder.task_started(170.0, 1, "pick", 1)
    recorder.visit_started(200.0, 1, 1, 1)
    recorder.station_busy(1, 200.0, 210.0)
    recorder.unit_picked(203.0, one, 1, 1, 1, 1, True)
    recorder.line_picked(203.0, one, 1, 1)
    one.completed_s = 210.0
    recorder.order_completed(one)
    place.now_s = 210.0
    recorder.slot_freed(one)
    recorder.task_started(210.0, 0, "rest", -1)
    first, second = bundle(0, 120.0), bundle(1, 130.0)
    recorder.bundle_created(first)
    recorder.bundle_created(second)
    _sample(recorder, traffic, 220.0)
    recorder.visit_ended(230.0, 1, 1, 1)
    recorder.task_started(230.0, 1, "replenish", 2)
    first.station, first.pod, first.assigned_s = 2, 1, 240.0
    recorder.visit_started(250.0, 2, 1, 1)
    recorder.station_busy(2, 250.0, 260.0)
    first.stored_s = 250.0
    recorder.bundle_stored(first, 1)
    recorder.station_activated(300.0, 1, False)
    _question(recorder, 300.0, 302.0, fallback=1)
    _question(recorder, 490.0)
    for minute in range(280, 500, 60):
        _sample(recorder, traffic, float(minute))
    # the run ends in a visit without any work, and 40 s after the last full minute
    recorder.station_busy(2, 495.0, 505.0)
    traffic.now_s = END_S
    recorder.run_ended(END_S)
    return recorder


def _question(recorder, asked_s, answered_s=None, **counts):
    """Ask an optimiser; without anything applied, it dies."""
    number = len(recorder.questions)
    ask = Ask(print, None, {"orders": 8, "pods": 3})
    call = Call(number, Problem.POA, None, ask, round(asked_s * 1e6), f"state {number}")
    recorder.optimiser_asked(call)
    for name, count in counts.items():
        setattr(call, name, count)
    if answered_s is None:
        return
    call.completed_us = round(answered_s * 1e6)
    if call.applied:
        found = {"order": np.array([4, 2]), "share": 0.1}
        call.answer = Answer(found, 12.0, 9.0, "feasible", "cp_sat", 3.0, 0.5, 0.125)
        call.outcome = Outcome.SOLUTION
    else:
        call.outcome, call.failure = Outcome.FAILED, "its worker died"
    recorder.optimiser_answered(call)


def _sample(recorder, traffic, time_s):
    traffic.now_s = time_s
    recorder.sampled(time_s)


def run():
    """What `simulate` returns, as far as the measures read it."""
    recorder = recorded()
    place, trace = recorder.layout, FakeTraffic().trace()
    return SimpleNamespace(
        layout=place,
        scenario=Settings(),
        controllers=Settings(),
        names=("fake-layout", "fake-scenario", "fake-controllers"),
        interventions=(),
        idle_rules=(),
        overrides=[(["layout", "robots"], 2)],
        notes={"layout": ["Bot.Colour is unknown and was left out"]},
        seed=3,
        pacing="instant",
        pacing_settings=Settings(),
        warmup_s=WARMUP_S,
        duration_s=END_S - WARMUP_S,
        end_s=END_S,
        wall_s=0.5,
        measures=[kind() for kind in SHIPPED],
        slow_robots=[],
        recorder=recorder,
        trace=trace,
        check=lambda: check(place, trace, until_us=round(END_S * 1e6)),
        events=EventLog(),
    )

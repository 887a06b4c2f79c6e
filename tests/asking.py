"""A controller that asks an optimiser, which may sleep, die, hang, fail, or work so and so much.

POA assigns orders first come, first served. What the optimiser does with the n-th question, the
parameters say.
"""

from __future__ import annotations

import os
import time
from dataclasses import dataclass
from typing import Any

import numpy as np

from rmfs.control.asks import Answer, Ask
from rmfs.control.base import Parameters
from rmfs.control.decisions import AssignOrder
from rmfs.control.poa import PickOrderAssignment


@dataclass(frozen=True)
class Question:
    orders: np.ndarray
    slots: np.ndarray
    deed: str
    seconds: float


def solve(question: Question) -> Answer:
    """Fill the slots of the stations one after the other."""
    begin = time.monotonic()
    if question.deed == "die":
        os._exit(3)
    if question.deed == "raise":
        raise RuntimeError("no idea")
    if question.seconds:
        time.sleep(question.seconds)
    station = np.repeat(np.arange(len(question.slots)), question.slots)[: len(question.orders)]
    solution: dict[str, Any] | None = {"order": question.orders[: len(station)], "station": station}
    if question.deed == "nothing":
        solution = None
    done = time.monotonic()
    return Answer(
        solution,
        objective=-float(len(station)),
        bound=-float(len(question.orders)),
        status="feasible",
        backend="rule",
        work=float(len(question.orders)),
        wall_s=done - begin,
        build_s=0.0,
    )


class AskingParameters(Parameters):
    deeds: tuple[str, ...] = ()
    """What the optimiser does with the first questions: sleep, die, raise, nothing."""
    sleep_s: float = 0.0
    """How long it sleeps."""
    rule_meanwhile: bool = False
    """Whether orders are assigned by the rule while the optimiser thinks."""
    at_once: int = 1
    """How many questions may be open."""


class Asking(PickOrderAssignment[AskingParameters]):
    parameters_model = AskingParameters
    optimisers = ("asking",)

    def __init__(self, parameters, view, rng):
        super().__init__(parameters, view, rng)
        self.asked = 0
        self.told: list[tuple[float, Any]] = []

    def decide(self):
        slots = np.array([station.free_slots for station in self.view.pick_stations])
        orders = list(self.view.orders)
        if len(orders) and slots.sum() and self.in_flight < self.parameters.at_once:
            deeds = self.parameters.deeds
            deed = deeds[self.asked] if self.asked < len(deeds) else "sleep"
            self.asked += 1
            indices = np.array([order.index for order in orders])
            question = Question(indices, slots, deed, self.parameters.sleep_s)
            memo = {order.index: order for order in orders}
            yield Ask(solve, question, {"orders": len(orders)}, memo)
        if self.in_flight and self.parameters.rule_meanwhile:
            yield from self.by_rule()

    def answered(self, call):
        self.told.append((self.view.now_s, call))
        if call.solution is None:
            yield from self.by_rule()
            return
        pairs = zip(call.solution["order"], call.solution["station"], strict=True)
        for index, station in pairs:
            order = call.ask.memo[int(index)]
            target = self.view.pick_stations[int(station)]
            if order.station >= 0 or not target.free_slots:
                call.stale += 1
            else:
                yield AssignOrder(order, target.index)

    def by_rule(self):
        for station in self.view.pick_stations:
            for order in list(self.view.orders)[: station.free_slots]:
                yield AssignOrder(order, station.index)

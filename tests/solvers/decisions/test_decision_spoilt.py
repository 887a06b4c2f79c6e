"""Twenty kinds of spoilt solutions of every family: each is refused, in one line."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from decision_samples import sample

from rmfs.errors import InputError
from rmfs.solvers.decisions.checking import WrongError, check
from rmfs.solvers.decisions.files import Decision, Found, read_solution, write_solution
from rmfs.solvers.decisions.schema import SCHEMAS, Plain
from rmfs.solvers.decisions.solving import methods, solve

Raw = dict[str, Any]
SEEDS = range(30)


def entry(raw: Raw, change: Callable[[Any], Any]) -> bool:
    """Change the first number of the first field that has one."""
    for value in raw["values"].values():
        row = value
        while isinstance(row, list) and row and isinstance(row[0], list):
            row = next((one for one in row if one), row[0])
        if row:
            row[0] = change(row[0])
            return True
    return False


def lengthen(raw: Raw) -> None:
    for value in raw["values"].values():
        value.append(value[-1] if value else 0)


def worse(raw: Raw, by: float) -> None:
    raw["objective"] += by


GENERAL: dict[str, Callable[[Raw], object]] = {
    "other question": lambda raw: raw.update(question="0" * 64),
    "other family": lambda raw: raw.update(family="nobody"),
    "other format": lambda raw: raw.update(format="rmfs-decision-solution/9"),
    "no values": lambda raw: raw.update(values=None),
    "values are a list": lambda raw: raw.update(values=[1, 2]),
    "field missing": lambda raw: raw["values"].pop(next(iter(raw["values"]))),
    "field unknown": lambda raw: raw["values"].update(speed=[1]),
    "entry too many": lengthen,
    "entry missing": lambda raw: [value.pop() for value in raw["values"].values() if value],
    "entry null": lambda raw: entry(raw, lambda one: None),
    "entry text": lambda raw: entry(raw, lambda one: "many"),
    "entry nan": lambda raw: entry(raw, lambda one: float("nan")),
    "entry infinite": lambda raw: entry(raw, lambda one: "inf"),
    "entry far too large": lambda raw: entry(raw, lambda one: 10**9),
    "entry far too small": lambda raw: entry(raw, lambda one: -7),
    "objective too low": lambda raw: worse(raw, -1.0),
    "objective too high": lambda raw: worse(raw, 1.0),
    "objective a text": lambda raw: raw.update(objective="good"),
}
"""What can be wrong with a file of any family; the bound is spoilt below."""

Spoil = Callable[[Decision, Plain], bool]
"""Breaks one rule in an answer; false if it cannot in this one."""


def put(name: str, place: Any, value: Any) -> Spoil:
    """Set an entry, or all of a slice."""

    def spoil(question: Decision, values: Plain) -> bool:
        before = np.array(values[name])
        values[name][place] = value
        return not np.array_equal(before, values[name])

    return spoil


def forbid(name: str, table: str, *, turned: bool = False) -> Spoil:
    """Choose a pair that the table forbids."""

    def spoil(question: Decision, values: Plain) -> bool:
        cost = question.data[table].T if turned else question.data[table]
        pairs = np.argwhere(np.isinf(cost))
        if not len(pairs):
            return False
        row, column = pairs[0]
        values[name][values[name] == column] = -1
        values[name][row] = column
        return True

    return spoil


def call_what_is_there(question: Decision, values: Plain) -> bool:
    gone = np.flatnonzero(question.data["available"] == 0)
    values["pod_station"][gone[:1]] = 0
    return bool(gone.size)


def call_nobody(question: Decision, values: Plain) -> bool:
    """Leave the pods where they are, although lines are covered by them."""
    called = values["pod_station"] >= 0
    inbound = (question.data["inbound"] >= 0).any()
    values["pod_station"][:] = values["pod_robot"][:] = -1
    return bool(called.any() and not inbound and (values["line_station"] >= 0).any())


def cover_without_slot(question: Decision, values: Plain) -> bool:
    free = np.flatnonzero(values["slot"].sum(axis=1) == 0)
    lines = np.flatnonzero(np.isin(question.data["line_order"], free))
    values["line_station"][lines[:1]] = 0
    return bool(lines.size)


def prospect_with_slot(question: Decision, values: Plain) -> bool:
    placed = np.flatnonzero(values["slot"].any(axis=1))
    values["prospect"][placed[:1]] = 0
    return bool(placed.size)


def robots_for_nobody(question: Decision, values: Plain) -> bool:
    stay = np.flatnonzero(values["pod_station"] < 0)
    values["pod_robot"][stay[:1]] = 0
    return bool(stay.size)


def pod_twice(question: Decision, values: Plain) -> bool:
    for pods in values["pods"]:
        if pods:
            values["pods"][0] = [pods[0], *values["pods"][0]]
            return True
    return False


def visit_in_vain(question: Decision, values: Plain) -> bool:
    used = {pod for pods in values["pods"] for pod in pods}
    finite = np.isfinite(question.data["cost"][:, 0])
    free = [pod for pod in np.flatnonzero(finite).tolist() if pod not in used]
    room = len(values["pods"][0]) < question.data["visits"]
    if free and room:
        values["pods"][0].append(free[0])
    return bool(free and room)


def half_an_order(question: Decision, values: Plain) -> bool:
    waits = question.data["order_station"][question.data["line_order"]] < 0
    served = np.flatnonzero(waits & (values["line_visit"] >= 0))
    values["line_visit"][served[:1]] = -1
    return bool(served.size)


def move_an_open_order(question: Decision, values: Plain) -> bool:
    is_open = np.flatnonzero(question.data["order_station"] >= 0)
    values["order_station"][is_open] = 1 - values["order_station"][is_open]
    return bool(is_open.size)


def no_pods(question: Decision, values: Plain) -> bool:
    some = any(values["pods"])
    values["pods"] = [[] for _ in values["pods"]]
    return some


def same_pod_always(question: Decision, values: Plain) -> bool:
    different = len(set(values["pods"].tolist())) > 1
    values["pods"][:] = values["pods"][0]
    return different


def all_at_once(question: Decision, values: Plain) -> bool:
    """Open all orders in the first visit, which completes none of three."""
    first = question.data["holds"][values["pods"][0]].astype(bool)
    passing = (first | ~question.data["needs"].astype(bool)).all(axis=1)
    values["start"][:] = 0
    return not passing.any()


def last_visit_left_out(question: Decision, values: Plain) -> bool:
    values["pods"] = values["pods"][:-1]
    return True


def order_too_many(question: Decision, values: Plain) -> bool:
    left = np.flatnonzero(values["order_station"] < 0)
    values["order_station"][left[:1]] = 0
    return bool(left.size)


def stuff(factor: float) -> Spoil:
    def spoil(question: Decision, values: Plain) -> bool:
        values["standing"] = values["standing"] * factor
        return True

    return spoil


def all_in_the_last_zone(question: Decision, values: Plain) -> bool:
    values["standing"][:] = 0.0
    values["standing"][:, -1] = question.data["pods"]
    return True


def all_in_the_first_zone(question: Decision, values: Plain) -> bool:
    """It has one place where there are three zones; two stays at a time are too many."""
    values["zone"][:] = 0
    begin, end = question.data["begin_s"], question.data["end_s"]
    order = np.argsort(begin)
    overlap = bool((begin[order][1:] < end[order][:-1]).any())
    return question.sizes["Z"] == 3 and overlap


def all_at_the_first_group(question: Decision, values: Plain) -> bool:
    """Everybody who may goes there as soon as the last of them can: it has not that many places."""
    data = question.data
    own = np.flatnonzero((data["here"] == -1) & np.isfinite(data["way_s"][:, 0]))
    first = int(data["ready"][own].max(initial=0))
    if len(own) <= data["places"][0, min(first, data["wanted"].shape[1] - 1)]:
        return False
    values["group"][own], values["begin"][own], values["length"][own] = 0, first, 1
    return first < data["wanted"].shape[1]


def no_stay_but_a_length(question: Decision, values: Plain) -> bool:
    values["group"][1], values["begin"][1], values["length"][1] = -1, 0, 1
    return True


def task_twice(question: Decision, values: Plain) -> bool:
    for tasks in values["tasks"]:
        if tasks:
            values["tasks"][-1 if tasks is not values["tasks"][-1] else 0].append(tasks[0])
            return True
    return False


def task_forgotten(question: Decision, values: Plain) -> bool:
    """Take a task from its robot, but keep the place of its pod."""
    for tasks in values["tasks"]:
        if tasks:
            tasks.pop()
            return True
    return False


def stow(question: Decision, values: Plain) -> bool:
    """Let the robot without a pod store one."""
    used = {*values["place"].tolist(), *values["robot_place"].tolist()}
    free = next(place for place in range(question.sizes["L"]) if place not in used)
    values["robot_place"][1] = free
    return True


def same_place(question: Decision, values: Plain) -> bool:
    both = bool((values["place"] >= 0).all())
    values["place"][:] = values["place"][0]
    return both


def pods_stay(question: Decision, values: Plain) -> bool:
    values["station"][:] = -1
    return bool((values["pod"] >= 0).any())


def all_bundles_in(pod: int) -> Spoil:
    def spoil(question: Decision, values: Plain) -> bool:
        values["pod"][:] = pod
        values["station"][pod] = 0
        return bool(question.data["space"].sum() > question.data["pod_space"][pod])

    return spoil


def more(name: str, by: float) -> Spoil:
    def spoil(question: Decision, values: Plain) -> bool:
        values[name] = values[name] + by
        return True

    return spoil


def less_than_visits(question: Decision, values: Plain) -> bool:
    values["visits"] = values["units"] + 1.0
    return True


SPECIAL: dict[str, dict[str, Spoil]] = {
    "pile_on": {
        "more orders than slots": put("slot", np.s_[:, 0], 1),
        "pod that is there already": call_what_is_there,
        "lines without stock": call_nobody,
        "line without slot": cover_without_slot,
        "prospect with a slot": prospect_with_slot,
        "robot for nobody": robots_for_nobody,
    },
    "planning": {
        "pod twice": pod_twice,
        "visit in vain": visit_in_vain,
        "half an order": half_an_order,
        "open order moved": move_an_open_order,
        "visits left out": no_pods,
    },
    "sequencing": {
        "same pod always": same_pod_always,
        "all at once": all_at_once,
        "last visit left out": last_visit_left_out,
        "open before": put("start", 0, -1),
    },
    "rack_allocation": {
        "station not filled": put("order_station", np.s_[:], -1),
        "order too many": order_too_many,
        "no pods": put("pod_station", np.s_[:], -1),
        "all orders at one": put("order_station", np.s_[:], 0),
    },
    "placement": {
        "two on one place": lambda question, values: put("place", 0, values["place"][1])(
            question, values
        ),
        "all on one place": put("place", np.s_[:], 2),
        "place not allowed": forbid("place", "travel_s"),
        "none": put("place", 1, -1),
    },
    "stays": {
        "zone not allowed": forbid("zone", "cost_s"),
        "all in the first": all_in_the_first_zone,
        "none": put("zone", 0, -1),
        "one beyond": lambda question, values: put("zone", 0, question.sizes["Z"])(
            question, values
        ),
    },
    "zones": {
        "pods missing": stuff(0.99),
        "pods too many": stuff(1.01),
        "negative": put("standing", (0, 0), -0.5),
        "zone too full": all_in_the_last_zone,
    },
    "charging": {
        "one beyond": put("group", 0, 7),
        "too long": put("length", 0, 9),
        "before the beginning": put("begin", 1, -1),
        "all at once": all_at_the_first_group,
        "no stay, but a length": no_stay_but_a_length,
    },
    "matching": {
        "robot twice": put("robot", np.s_[:2], 0),
        "robot everywhere": put("robot", np.s_[:], 1),
        "not allowed": forbid("robot", "travel_s", turned=True),
        "one beyond": put("robot", 0, 3),
    },
    "balance": {
        "robot twice": put("robot", np.s_[:2], 0),
        "no room": put("robot", np.s_[:2], np.array([0, 1])),
        "not allowed": forbid("robot", "arrive_s", turned=True),
        "one beyond": put("robot", 0, 3),
    },
    "sequence": {
        "task twice": task_twice,
        "task forgotten": task_forgotten,
        "pod from nowhere": stow,
        "two on one place": same_place,
    },
    "replenishment": {
        "pods stay": pods_stay,
        "pod too full": all_bundles_in(0),
        "another too full": all_bundles_in(2),
        "not allowed": forbid("pod", "worth_s"),
    },
    "run_bound": {
        "units without end": more("units", 1e4),
        "negative visits": more("visits", -1e4),
        "more visits than units": less_than_visits,
        "bundles without end": more("bundles", 1e4),
    },
}
"""What breaks a rule of each family."""


def answered(family: str, seed: int) -> tuple[Decision, Found]:
    question = sample(family, seed)
    return question, solve(question, methods(family)[0])


@pytest.mark.parametrize("kind", GENERAL)
@pytest.mark.parametrize("family", SCHEMAS)
def test_spoilt_files_are_refused(family: str, kind: str, tmp_path: Path) -> None:
    question, found = answered(family, 1)
    write_solution(question, found, tmp_path / "s.json")
    raw = json.loads((tmp_path / "s.json").read_text())
    GENERAL[kind](raw)
    (tmp_path / "s.json").write_text(json.dumps(raw))
    with pytest.raises((InputError, WrongError)) as caught:
        check(question, read_solution(question, tmp_path / "s.json"))
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    ("family", "kind"), [(family, kind) for family in SCHEMAS for kind in SPECIAL[family]]
)
def test_broken_rules_are_noticed(family: str, kind: str) -> None:
    tried = 0
    for seed in SEEDS:
        question, found = answered(family, seed)
        if found.values is None:
            continue
        values = {
            name: [list(row) for row in value] if isinstance(value, list) else value.copy()
            for name, value in found.values.items()
        }
        if SPECIAL[family][kind](question, values):
            tried += 1
            with pytest.raises(WrongError):
                check(question, Found(values))
        if tried == 3:
            return
    assert tried


@pytest.mark.parametrize("family", SCHEMAS)
def test_bounds_beyond_the_value_are_noticed(family: str) -> None:
    question, found = answered(family, 1)
    check(question, found)
    beyond = found.objective + question.sign * 0.5
    with pytest.raises(WrongError, match="bound"):
        check(question, Found(found.values, found.objective, beyond))


def test_there_are_twenty_kinds() -> None:
    assert set(SPECIAL) == set(SCHEMAS)
    assert min(len(kinds) for kinds in SPECIAL.values()) + len(GENERAL) + 1 >= 20

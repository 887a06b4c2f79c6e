"""Ways to spoil a lawful trace, and a slow look at it that shares nothing with the checker."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from scripted_trace import HOLD, LIFT_RIDE, RUN, TURN

Trace = dict[str, np.ndarray]


def waits(trace: Trace, at_least_s: float) -> list[int]:
    """Rows in which a robot stands at least so long before it drives on, and stands again later."""
    follows = np.append(trace["robot"][1:] == trace["robot"][:-1], False)
    drives = np.isin(np.append(trace["kind"][1:], HOLD), [RUN, TURN])
    long = trace["t1_us"] - trace["t0_us"] >= at_least_s * 1e6
    last = {int(trace["robot"][k]): int(k) for k in np.flatnonzero(trace["kind"] == HOLD)}
    again = np.array([last[robot] for robot in trace["robot"].tolist()]) > np.arange(len(long))
    return np.flatnonzero((trace["kind"] == HOLD) & long & follows & drives & again).tolist()


def started_earlier(trace: Trace, row: int, by_s: float) -> Trace:
    """Shorten one wait; what the robot does until its next wait happens so much earlier."""
    mutant = {name: column.copy() for name, column in trace.items()}
    by = round(by_s * 1e6)
    mutant["t1_us"][row] -= by
    k = row + 1
    while trace["kind"][k] != HOLD:
        mutant["t0_us"][k] -= by
        mutant["t1_us"][k] -= by
        k += 1
    mutant["t0_us"][k] -= by
    return mutant


def swapped(trace: Trace, one: int, other: int, time_s: float) -> Trace:
    """Two robots drive each other's plans from the first row on that begins after a time."""
    mutant = {name: column.copy() for name, column in trace.items()}
    later = trace["t0_us"] >= time_s * 1e6
    mutant["robot"][later & (trace["robot"] == one)] = other
    mutant["robot"][later & (trace["robot"] == other)] = one
    order = np.lexsort((mutant["t0_us"], mutant["robot"]))
    return {name: column[order] for name, column in mutant.items()}


def with_pod_in_the_way(layout, trace: Trace, row: int):
    """A layout in which another pod stands at the end of one loaded run, before it begins."""
    place = int(trace["to_wp"][row])
    storage = layout.is_storage.copy()
    storage[place] = True
    return replace(
        layout,
        is_storage=storage,
        pod_waypoint=np.append(layout.pod_waypoint, place).astype(np.int32),
        pod_capacity=np.append(layout.pod_capacity, 1.0),
    )


def positions(layout, trace: Trace, time_s: np.ndarray) -> np.ndarray:
    """Every robot's (x, y) at every time, shape (R, T, 2); nan in an elevator or after the end."""
    result = np.full((layout.robots, len(time_s), 2), np.nan)
    for robot in range(layout.robots):
        own = {name: column[trace["robot"] == robot] for name, column in trace.items()}
        row = np.searchsorted(own["t0_us"], time_s * 1e6, side="right") - 1
        kind = layout.robot_kinds[layout.robot_kind[robot]]
        origin, target = own["from_wp"][row], own["to_wp"][row]
        begin = np.stack([layout.x_m[origin], layout.y_m[origin]], axis=1)
        end = np.stack([layout.x_m[target], layout.y_m[target]], axis=1)
        length = np.hypot(*(end - begin).T)
        since = time_s - own["t0_us"][row] / 1e6
        way = driven(length, since, kind)
        share = np.divide(way, length, out=np.zeros_like(way), where=length > 0)
        result[robot] = begin + (end - begin) * share[:, None]
        gone = (own["kind"][row] == LIFT_RIDE) | (time_s * 1e6 > own["t1_us"][row])
        result[robot][gone] = np.nan
    return result


def driven(length: np.ndarray, since_s: np.ndarray, kind) -> np.ndarray:
    """Distance driven since the start of a run, summed up from its speed in small steps."""
    steps = 400
    a, d = kind.acceleration_m_s2, kind.deceleration_m_s2
    tau = (np.arange(steps) + 0.5) / steps * since_s[:, None]
    top = np.minimum(kind.top_speed_m_s, np.sqrt(2 * length * a * d / (a + d)))[:, None]
    total = (length[:, None] - top**2 / 2 / a - top**2 / 2 / d) / np.maximum(top, 1e-12)
    total = total + top / a + top / d
    speed = np.minimum(np.minimum(a * tau, top), d * (total - tau))
    return np.maximum(speed, 0.0).mean(axis=1) * since_s


def overlap_m(layout, trace: Trace, begin_s: float, end_s: float, step_s: float = 0.05) -> float:
    """Greatest overlap of two robots' discs in a stretch of time; negative if all keep clear."""
    time_s = np.arange(begin_s, end_s, step_s)
    place = positions(layout, trace, time_s)
    radius, tier = np.zeros(place.shape[:2]), np.zeros(place.shape[:2])
    for robot in range(layout.robots):
        own = trace["robot"] == robot
        row = np.searchsorted(trace["t0_us"][own], time_s * 1e6, side="right") - 1
        empty = layout.robot_kinds[layout.robot_kind[robot]].radius_m
        loaded = max(empty, layout.pod_radius_m)
        radius[robot] = np.where(trace["pod"][own][row] >= 0, loaded, empty)
        tier[robot] = layout.tier[trace["from_wp"][own][row]]
    worst = -np.inf
    for robot in range(layout.robots - 1):
        others = slice(robot + 1, None)
        away = np.hypot(*np.moveaxis(place[robot] - place[others], -1, 0))
        away[tier[others] != tier[robot]] = np.inf
        clear = away - radius[robot] - radius[others]
        worst = max(worst, -float(np.nanmin(clear, initial=np.inf)))
    return worst

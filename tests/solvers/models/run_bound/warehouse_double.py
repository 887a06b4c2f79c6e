"""A warehouse of a few lines that keeps every rule the bound relies on, and nothing more.

Robots fetch pods, wait in line, are served, go on to another station or store their pod; some
refill pods. What they choose is random, or as good as it gets. Everything is written down, so that
units, visits and bundles of any window can be counted.
"""

from __future__ import annotations

import heapq
from dataclasses import dataclass, field

import numpy as np

from rmfs.solvers.models.run_bound import Throughput


@dataclass
class Plant:
    """Stations in one numbering: pick stations first. `pick_s` is the hold of a robot per item."""

    pick_stations: int
    transfer_s: np.ndarray
    pick_s: np.ndarray
    changeover_s: np.ndarray
    from_storage_s: np.ndarray
    to_storage_s: np.ndarray
    between_s: np.ndarray
    lift_s: float
    pods: np.ndarray
    pod_limit: int
    bundle_units: int
    bundles_per_visit: int

    @property
    def cadence_s(self) -> np.ndarray:
        return np.maximum(self.transfer_s, self.pick_s)


@dataclass
class Log:
    """Times of picks and stored bundles, each with station and visit."""

    picks: list[tuple[float, int, int]] = field(default_factory=list)
    bundles: list[tuple[float, int, int]] = field(default_factory=list)

    def counted(self, begin: float, end: float, plant: Plant) -> Throughput:
        """Count what begins in a window."""
        size, split = len(plant.transfer_s), plant.pick_stations
        counts = []
        for rows in (self.picks, self.bundles):
            inside = [(s, v) for t, s, v in rows if begin <= t <= end]
            items = np.bincount([s for s, _ in inside], minlength=size)
            visits = np.bincount([s for s, _ in set(inside)], minlength=size)
            counts.append((items.astype(float), visits.astype(float)))
        (units, visits), (bundles, refills) = counts
        return Throughput(
            units[:split], visits[:split], units[:split], bundles[split:], refills[split:]
        )

    def contents(self, at: float, plant: Plant, owner: dict[int, int]) -> np.ndarray:
        """Count what is in the pods at a time; `owner` names the pod of each visit."""
        units = plant.pods.copy()
        for t, _, visit in self.picks:
            units[owner[visit]] -= t < at
        for t, _, visit in self.bundles:
            units[owner[visit]] += plant.bundle_units * (t < at)
        return units


def operate(
    plant: Plant, robots: int, until: float, rng: np.random.Generator, *, eager: bool
) -> tuple[Log, dict[int, int]]:
    """Run the warehouse; `eager` robots share the stations and empty the fullest pods."""
    log, pod_of = Log(), {}
    stations = len(plant.transfer_s)
    busy_until, head_free = np.zeros(stations), np.zeros(stations)
    contents, idle_pods = plant.pods.copy(), set(range(len(plant.pods)))
    events: list[tuple[float, int, int, int]] = []

    def choose(robot: int, now: float, pod: int, here: int) -> None:
        """Send a robot to a station, with its pod or with a new one."""
        if pod < 0:
            if not idle_pods:
                return
            ordered = sorted(idle_pods, key=lambda p: (-contents[p], p))
            pod = ordered[0] if eager else int(rng.choice(ordered))
            idle_pods.discard(pod)
        empty = contents[pod] == 0
        sites = [s for s in range(stations) if s != here and (s < plant.pick_stations) != empty]
        if not sites:
            idle_pods.add(pod)
            return
        site = sites[robot % len(sites)] if eager else int(rng.choice(sites))
        wait = 0.0 if eager else rng.exponential(2.0)
        drive = (
            plant.lift_s + plant.from_storage_s[site] if here < 0 else plant.between_s[here, site]
        )
        heapq.heappush(events, (now + drive + wait, robot, pod, site))

    for robot in range(robots):
        choose(robot, 0.0 if eager else rng.uniform(0, 20), -1, -1)
    while events:
        now, robot, pod, site = heapq.heappop(events)
        if now > until:
            break
        visit, time = len(pod_of), max(now, head_free[site])
        pod_of[visit] = pod
        picking = site < plant.pick_stations
        room = (plant.pod_limit - contents[pod]) // plant.bundle_units
        most = contents[pod] if picking else min(room, plant.bundles_per_visit)
        count = int(most) if eager else int(rng.integers(0, most + 1))
        leave = time
        for _ in range(count):
            time = max(time, busy_until[site])
            (log.picks if picking else log.bundles).append((time, site, visit))
            contents[pod] += -1 if picking else plant.bundle_units
            busy_until[site] = time + plant.transfer_s[site]
            leave = time + plant.pick_s[site]
            time = leave
        head_free[site] = leave + plant.changeover_s[site]
        if not eager and rng.random() < 0.3:
            choose(robot, leave, pod, site)
        else:
            idle_pods.add(pod)
            choose(robot, leave + plant.to_storage_s[site] + plant.lift_s, -1, -1)
    return log, pod_of

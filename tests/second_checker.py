"""A second checker, written from the pages on the trace format and on layouts alone.

It imports nothing of rmfs and goes another way than the first: positions are worked out at moments,
and between two moments nobody comes further than top speed allows. Where that leaves a doubt about
two bodies, the time between is halved, until it is settled.
"""

from __future__ import annotations

import json
import math
import sys
from collections import defaultdict
from dataclasses import dataclass, field
from itertools import pairwise
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Iterator

HOLD, TURN, RUN, RIDE, LIFT, SET_DOWN = range(6)
STEP_US = 500_000
"""Time between two moments at which all positions are worked out."""
AT_ONCE = 2_000
"""Moments worked out together."""
ROUNDING_US = 2
TOUCH_M = 1e-6
FINEST_US = 64
"""Below this the two are told to touch: they come nearer than 1e-4 m to doing so."""


@dataclass
class Site:
    """A layout file, as far as a trace can break it."""

    x: np.ndarray
    y: np.ndarray
    tier: np.ndarray
    to: list[list[int]]
    storage: np.ndarray
    pods: list[int]
    pod_radius: float
    robots: list[dict[str, Any]]
    kinds: list[dict[str, Any]]
    rides: dict[tuple[int, int], float]
    elevator_of: dict[int, int]
    slow: list[list[float]] = field(default_factory=list)
    straight: dict[tuple[int, int], bool] = field(default_factory=dict)

    @classmethod
    def read(cls, folder: Path) -> Site:
        told = json.loads((folder / "layout.json").read_text("utf-8"))
        run = json.loads((folder / "run.json").read_text("utf-8"))
        points = told["waypoints"]
        rides, elevator_of = {}, {}
        for number, elevator in enumerate(told["elevators"]):
            for ride in elevator["rides"]:
                rides[ride["origin"], ride["destination"]] = ride["travel_s"]
                elevator_of[ride["origin"]] = number
        return cls(
            x=np.array([p["x_m"] for p in points]),
            y=np.array([p["y_m"] for p in points]),
            tier=np.array([p.get("tier", 0) for p in points]),
            to=[p.get("to", []) for p in points],
            storage=np.array([p.get("storage", False) for p in points]),
            pods=[pod["waypoint"] for pod in told["pods"]],
            pod_radius=told["pod_radius_m"],
            robots=told["robots"],
            kinds=told["robot_kinds"],
            rides=rides,
            elevator_of=elevator_of,
            slow=run.get("slow_robots", []),
        )

    def distance(self, a: int, b: int) -> float:
        return math.hypot(self.x[b] - self.x[a], self.y[b] - self.y[a])

    def leads_straight(self, a: int, b: int) -> bool:
        """Whether edges on one straight line lead from a to b; found edge by edge, with memory."""
        if (a, b) not in self.straight:
            length = self.distance(a, b)
            reached, todo = {a}, [a]
            while todo and b not in reached:
                here = todo.pop()
                for there in self.to[here]:
                    detour = self.distance(a, there) + self.distance(there, b) - length
                    ahead = self.distance(there, b) < self.distance(here, b)
                    same = self.tier[there] == self.tier[a]
                    if ahead and same and detour < 1e-9 and there not in reached:
                        reached.add(there)
                        todo.append(there)
            self.straight[a, b] = b in reached
        return self.straight[a, b]


@dataclass
class Rows:
    """The motion of one robot, by columns."""

    t0: np.ndarray
    t1: np.ndarray
    kind: np.ndarray
    a: np.ndarray
    b: np.ndarray
    h0: np.ndarray
    h1: np.ndarray
    pod: np.ndarray
    length: np.ndarray
    top: np.ndarray
    acceleration: float
    braking: float

    def at(self, site: Site, t: np.ndarray) -> tuple[np.ndarray, ...]:
        """Return x, y, tier, speed limit, whether in an elevator, and pod, at times (us)."""
        row = np.clip(np.searchsorted(self.t0, t, side="right") - 1, 0, None)
        a, b, length = self.a[row], self.b[row], self.length[row]
        running = (self.kind[row] == RUN) & (length > 0)
        share = np.zeros(len(t))
        way = travelled(
            (t[running] - self.t0[row[running]]) / 1e6,
            length[running],
            self.top[row[running]],
            self.acceleration,
            self.braking,
        )
        share[running] = way / length[running]
        return (
            site.x[a] + share * (site.x[b] - site.x[a]),
            site.y[a] + share * (site.y[b] - site.y[a]),
            site.tier[a],
            np.where(self.kind[row] == RUN, self.top[row], 0.0),
            self.kind[row] == RIDE,
            self.pod[row],
            row,
        )


def peak(length: np.ndarray, top: np.ndarray, a: float, d: float) -> np.ndarray:
    return np.minimum(top, np.sqrt(2 * length * a * d / (a + d)))


def lasting(length: np.ndarray, top: np.ndarray, a: float, d: float) -> np.ndarray:
    v = peak(length, top, a, d)
    with np.errstate(invalid="ignore", divide="ignore"):
        cruise = (length - v * v / (2 * a) - v * v / (2 * d)) / v
    return np.where(v > 0, v / a + np.maximum(cruise, 0) + v / d, 0.0)


def travelled(t: np.ndarray, length: np.ndarray, top: np.ndarray, a: float, d: float) -> np.ndarray:
    """Return the way from the start of a run, t seconds after it."""
    v = peak(length, top, a, d)
    whole = lasting(length, top, a, d)
    t = np.clip(t, 0.0, whole)
    left = whole - t
    speeding = t < v / a
    braking = left < v / d
    even = v * v / (2 * a) + v * (t - v / a)
    return np.where(speeding, a * t * t / 2, np.where(braking, length - d * left * left / 2, even))


def read_rows(folder: Path, site: Site) -> list[Rows]:
    from pyarrow import parquet

    columns = parquet.read_table(folder / "trace.parquet").to_pydict()
    table = {name: np.asarray(values) for name, values in columns.items()}
    slow = defaultdict(list)
    for robot, begin, end, share in site.slow:
        slow[int(robot)].append((begin, end, share))
    rows = []
    for robot, told in enumerate(site.robots):
        mine = {name: values[table["robot"] == robot] for name, values in table.items()}
        kind = site.kinds[told.get("kind", 0)]
        top = np.full(len(mine["t0_us"]), float(kind["top_speed_m_s"]))
        for begin, end, share in slow[robot]:
            top[(mine["t0_us"] >= begin) & (mine["t0_us"] < end)] *= share
        a, b = mine["from_wp"], mine["to_wp"]
        rows.append(
            Rows(
                mine["t0_us"],
                mine["t1_us"],
                mine["kind"],
                a,
                b,
                mine["heading0_rad"],
                mine["heading1_rad"],
                mine["pod"],
                np.hypot(site.x[b] - site.x[a], site.y[b] - site.y[a]),
                top,
                kind["acceleration_m_s2"],
                kind["deceleration_m_s2"],
            )
        )
    return rows


def angle(one: np.ndarray, other: np.ndarray) -> np.ndarray:
    return np.abs((one - other + np.pi) % (2 * np.pi) - np.pi)


def alone(site: Site, robot: int, rows: Rows, end_us: int) -> Iterator[str]:
    """Yield what is wrong with a robot by itself."""
    told, kind = site.robots[robot], site.kinds[site.robots[robot].get("kind", 0)]
    if len(rows.t0) == 0:
        yield f"robot {robot}: nothing is told"
        return

    def at(wrong: np.ndarray, what: str) -> Iterator[str]:
        for row in np.flatnonzero(wrong)[:3]:
            yield f"robot {robot} at {rows.t0[row] / 1e6:.6f} s: {what}"

    first = rows.t0[0] == 0 and rows.a[0] == told["waypoint"]
    if not first or rows.t1[-1] < end_us:
        yield f"robot {robot}: does not begin at its place at 0 s, or ends before the run"
    yield from at(np.append(False, rows.t0[1:] != rows.t1[:-1]), "a gap")
    yield from at(np.append(False, rows.a[1:] != rows.b[:-1]), "a jump")
    yield from at((rows.a != rows.b) & ~np.isin(rows.kind, (RUN, RIDE)), "moves while it stands")
    before = np.append(told.get("heading_rad", 0.0), rows.h1[:-1])
    yield from at(angle(before, rows.h0) > 1e-5, "heading jumps")
    yield from at((angle(rows.h0, rows.h1) > 1e-5) & (rows.kind != TURN), "turns while it does not")
    way = np.arctan2(site.y[rows.b] - site.y[rows.a], site.x[rows.b] - site.x[rows.a])
    yield from at((rows.kind == RUN) & (angle(way, rows.h0) > 1e-5), "runs sideways")
    needed = np.full(len(rows.t0), np.nan)
    running, turning = rows.kind == RUN, rows.kind == TURN
    needed[running] = lasting(rows.length, rows.top, rows.acceleration, rows.braking)[running]
    needed[turning] = (angle(rows.h0, rows.h1) / (2 * np.pi) * kind["full_turn_s"])[turning]
    needed[np.isin(rows.kind, (LIFT, SET_DOWN))] = kind["pod_transfer_s"]
    for row in np.flatnonzero(rows.kind == RIDE):
        needed[row] = site.rides.get((int(rows.a[row]), int(rows.b[row])), -1.0)
    off = np.abs((rows.t1 - rows.t0) - needed * 1e6) > ROUNDING_US
    yield from at(off & ~np.isnan(needed), "lasts another time than it must")
    pairs = set(zip(rows.a[running].tolist(), rows.b[running].tolist(), strict=True))
    for a, b in sorted(pairs):
        if not site.leads_straight(a, b):
            yield f"robot {robot}: no straight edges lead from {a} to {b}"


def pods(site: Site, rows: list[Rows]) -> Iterator[str]:
    """Yield what is wrong with pods: each is at one place, or on one robot."""
    where: dict[int, int] = dict(enumerate(site.pods))
    stands = {place: pod for pod, place in where.items()}
    happened = []
    for robot, mine in enumerate(rows):
        for row in np.flatnonzero(np.isin(mine.kind, (LIFT, SET_DOWN))):
            lift = mine.kind[row] == LIFT
            time = mine.t0[row] if lift else mine.t1[row]
            # a pod may be lifted in the moment in which it was set down
            happened.append((int(time), int(lift), robot, int(mine.a[row]), int(mine.pod[row])))
        change = np.flatnonzero(mine.pod[1:] != mine.pod[:-1]) + 1
        for row in change:
            begun = mine.kind[row] == LIFT and mine.pod[row - 1] < 0
            ended = mine.kind[row - 1] == SET_DOWN and mine.pod[row] < 0
            handed = mine.kind[row - 1] == SET_DOWN and mine.kind[row] == LIFT
            if not (begun or ended or handed):
                yield f"robot {robot} at {mine.t0[row] / 1e6:.6f} s: pod changes under way"
        if mine.pod[0] >= 0 and mine.kind[0] != LIFT:
            yield f"robot {robot}: has a pod from the start"
    for time, lifted, robot, place, pod in sorted(happened):
        told = f"robot {robot} at {time / 1e6:.6f} s"
        if lifted:
            if stands.pop(place, None) != pod:
                yield f"{told}: lifts pod {pod}, which is not at {place}"
            where.pop(pod, None)
            continue
        if pod in where or place in stands or not site.storage[place]:
            yield f"{told}: sets pod {pod} down at {place}, where it cannot stand"
        where[pod], stands[place] = place, pod


def stays(site: Site, rows: list[Rows], end_us: int) -> dict[int, list[tuple[int, int, int]]]:
    """Return from when until when, and which, pods stand at each place."""
    found: dict[int, list[tuple[int, int, int]]] = defaultdict(list)
    since = {place: (0, pod) for pod, place in enumerate(site.pods)}
    happened = []
    for mine in rows:
        for row in np.flatnonzero(np.isin(mine.kind, (LIFT, SET_DOWN))):
            lift = mine.kind[row] == LIFT
            time = int(mine.t0[row] if lift else mine.t1[row])
            happened.append((time, int(lift), int(mine.a[row]), int(mine.pod[row])))
    for time, lifted, place, pod in sorted(happened):
        if not lifted:
            since[place] = (time, pod)
        elif place in since:
            begin, stood = since.pop(place)
            found[place].append((begin, time, stood))
    for place, (begin, pod) in since.items():
        found[place].append((begin, end_us * 2, pod))
    return found


def crossings(site: Site, rows: list[Rows], end_us: int) -> Iterator[str]:
    """Yield carried pods that run into stored ones."""
    stood = stays(site, rows, end_us)
    near: dict[tuple[int, int], list[int]] = {}
    places = np.flatnonzero(site.storage)
    for robot, mine in enumerate(rows):
        for row in np.flatnonzero((mine.kind == RUN) & (mine.pod >= 0)):
            a, b = int(mine.a[row]), int(mine.b[row])
            if (a, b) not in near:
                near[a, b] = _places_near(site, places, a, b)
            for place in near[a, b]:
                for begin, end, pod in stood.get(place, ()):
                    if pod == mine.pod[row] or begin >= mine.t1[row] or end <= mine.t0[row]:
                        continue
                    t = np.linspace(max(begin, mine.t0[row]), min(end, mine.t1[row]), 200)
                    x, y, *_ = mine.at(site, t)
                    distance = np.hypot(x - site.x[place], y - site.y[place]).min()
                    if distance < 2 * site.pod_radius - TOUCH_M:
                        yield (
                            f"robot {robot} at {mine.t0[row] / 1e6:.6f} s: its pod runs into pod "
                            f"{pod} at {place}"
                        )


def _places_near(site: Site, places: np.ndarray, a: int, b: int) -> list[int]:
    """Return the storage locations of which a pod would be touched on the way from a to b."""
    dx, dy = site.x[b] - site.x[a], site.y[b] - site.y[a]
    px, py = site.x[places] - site.x[a], site.y[places] - site.y[a]
    along = np.clip((px * dx + py * dy) / (dx * dx + dy * dy), 0, 1)
    distance = np.hypot(px - along * dx, py - along * dy)
    close = (distance < 2 * site.pod_radius - TOUCH_M) & (site.tier[places] == site.tier[a])
    return [int(place) for place in places[close]]


def rides(site: Site, rows: list[Rows]) -> Iterator[str]:
    """Yield rides in an elevator that has somebody in it."""
    taken = defaultdict(list)
    for robot, mine in enumerate(rows):
        for row in np.flatnonzero(mine.kind == RIDE):
            elevator = site.elevator_of.get(int(mine.a[row]), -1)
            taken[elevator].append((int(mine.t0[row]), int(mine.t1[row]), robot))
    for elevator, times in taken.items():
        times.sort()
        for (_, end, one), (begin, _, other) in pairwise(times):
            if begin < end:
                yield f"elevator {elevator}: robots {one} and {other} in it at {begin / 1e6:.6f} s"


def meetings(site: Site, rows: list[Rows], end_us: int) -> Iterator[str]:
    """Yield pairs of robots whose bodies overlap."""
    radius = np.array([site.kinds[one.get("kind", 0)]["radius_m"] for one in site.robots])
    moments = np.arange(0, end_us + STEP_US, STEP_US)
    for start in range(0, len(moments), AT_ONCE):
        t = moments[start : start + AT_ONCE] + STEP_US // 2
        at = [mine.at(site, t) for mine in rows]
        x, y, tier = (np.stack([one[k] for one in at]) for k in range(3))
        size = np.where(np.stack([one[5] for one in at]) >= 0, site.pod_radius, radius[:, None])
        # within half a step to each side another row may begin: with a pod, or at top speed
        far = np.stack([_reach(mine, t) for mine in rows])
        widest = np.stack(
            [_widest(mine, t, size[r], site.pod_radius) for r, mine in enumerate(rows)]
        )
        doubts = [np.empty((3, 0), dtype=int)]
        for one in range(len(rows) - 1):
            dx, dy = x[one + 1 :] - x[one], y[one + 1 :] - y[one]
            slack = far[one + 1 :] + far[one] + widest[one + 1 :] + widest[one]
            doubt = (np.abs(dx) < slack) & (np.abs(dy) < slack) & (tier[one + 1 :] == tier[one])
            others, when = np.nonzero(doubt)
            near = np.hypot(dx[others, when], dy[others, when]) < slack[others, when]
            others, centre = others[near] + one + 1, t[when[near]]
            doubts.append(np.stack([np.full(len(others), one), others, centre]))
        found = _first_touch(site, rows, radius, np.concatenate(doubts, axis=1))
        if found is not None:
            time, one, other = found
            yield f"robots {one} and {other} touch at {time / 1e6:.6f} s"
            return


def _reach(mine: Rows, t: np.ndarray) -> np.ndarray:
    """Return how far a robot can be, within half a step, from where it is at each time."""
    low = np.searchsorted(mine.t0, t - STEP_US // 2, side="right") - 1
    high = np.searchsorted(mine.t0, t + STEP_US // 2, side="right") - 1
    moving = np.concatenate([[0], np.cumsum(mine.kind == RUN)])
    runs = moving[np.clip(high, 0, None) + 1] - moving[np.clip(low, 0, None)]
    return np.where(runs > 0, mine.top.max() * STEP_US / 2e6, 0.0)


def _widest(mine: Rows, t: np.ndarray, size: np.ndarray, pod_radius: float) -> np.ndarray:
    low = np.clip(np.searchsorted(mine.t0, t - STEP_US // 2, side="right") - 1, 0, None)
    high = np.clip(np.searchsorted(mine.t0, t + STEP_US // 2, side="right") - 1, 0, None)
    loaded = np.concatenate([[0], np.cumsum(mine.pod >= 0)])
    return np.where(loaded[high + 1] > loaded[low], max(pod_radius, 0.0), size)


def _first_touch(
    site: Site, rows: list[Rows], radius: np.ndarray, doubts: np.ndarray
) -> tuple[int, int, int] | None:
    """Return when, and which, two robots touch within half a step of times; None if none do.

    Parameters
    ----------
    doubts
        Columns of two robots and a time (us) each. All are settled together, span by span.
    """
    one, other, centre = doubts
    begin, end = np.maximum(centre - STEP_US // 2, 0), centre + STEP_US // 2
    touches: list[tuple[int, int, int]] = []
    while len(begin):
        # a span ends where either robot comes to another row; what is left is looked at next
        cut = np.minimum(_next_rows(rows, one, begin), _next_rows(rows, other, begin))
        rest = cut < end
        stop = np.where(rest, cut, end)
        middle = (begin + stop) / 2
        x1, y1, tier1, v1, rides1, pod1 = _at(site, rows, one, middle)
        x2, y2, tier2, v2, rides2, pod2 = _at(site, rows, other, middle)
        size1 = np.where(pod1 >= 0, site.pod_radius, radius[one])
        size2 = np.where(pod2 >= 0, site.pod_radius, radius[other])
        free = np.hypot(x1 - x2, y1 - y2) - (size1 + size2 - TOUCH_M)
        safe = (tier1 != tier2) | (rides1 > 0) | (rides2 > 0)
        safe |= free >= (v1 + v2) * (stop - begin) / 2e6
        meet = ~safe & ((free < 0) | (stop - begin <= FINEST_US))
        touches += zip(middle[meet].astype(int), one[meet], other[meet], strict=True)
        halve = ~safe & ~meet
        half = (begin + stop) // 2
        one, other = (np.concatenate([of[rest], of[halve], of[halve]]) for of in (one, other))
        begin, end = (
            np.concatenate([cut[rest], begin[halve], half[halve]]),
            np.concatenate([end[rest], half[halve], stop[halve]]),
        )
    return min(touches) if touches else None


def _next_rows(rows: list[Rows], robots: np.ndarray, t: np.ndarray) -> np.ndarray:
    """Return when each robot's next row begins after a time; never: the largest number."""
    found = np.full(len(t), np.iinfo(np.int64).max)
    for robot in np.unique(robots):
        mine = robots == robot
        begins = np.append(rows[robot].t0, np.iinfo(np.int64).max)
        found[mine] = begins[np.searchsorted(rows[robot].t0, t[mine], side="right")]
    return found


def _at(site: Site, rows: list[Rows], robots: np.ndarray, t: np.ndarray) -> np.ndarray:
    """Return what `Rows.at` does of many robots, each at a time of its own."""
    found = np.empty((6, len(t)))
    for robot in np.unique(robots):
        mine = robots == robot
        found[:, mine] = rows[robot].at(site, t[mine])[:6]
    return found


def problems(folder: Path) -> list[str]:
    """Return everything that is wrong with the trace in a run folder."""
    site = Site.read(folder)
    told = json.loads((folder / "run.json").read_text("utf-8"))
    end_us = round((told["warmup_s"] + told["duration_s"]) * 1e6)
    rows = read_rows(folder, site)
    found = [what for robot, mine in enumerate(rows) for what in alone(site, robot, mine, end_us)]
    if found:
        return found
    return [
        *pods(site, rows),
        *rides(site, rows),
        *crossings(site, rows, end_us),
        *meetings(site, rows, end_us),
    ]


if __name__ == "__main__":
    for name in sys.argv[1:]:
        print(name, problems(Path(name)) or "safe")

"""Random layouts and random trips: `python -m tests.tools.fuzz`.

A case is a number: it says the planner, the parameters of a layout, what is spoilt in it, and the
trips. What is well-formed must be driven safely, by the default planner without anybody left
behind; what is not must be refused with a reason, or where it is allowed, go on or stop with a
report.
"""

from __future__ import annotations

import argparse
import json
import signal
import sys
import time
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from rmfs import layout as layouts
from rmfs.errors import InputError
from rmfs.experiments.traffic.duel import all_planners, settings
from rmfs.files import write_text
from rmfs.layout.checks import IMPOSSIBLE, check
from rmfs.random import Stream, generator
from rmfs.trips import drive, random_trips

if TYPE_CHECKING:
    from collections.abc import Callable

    from rmfs.layout.model import Layout

FORMAT = "rmfs-fuzz/1"
DURATION_S = 240.0
STALL_S = 120.0
PATIENCE_S = 300
"""Wall time after which a case hangs: the process is ended, and the case is on file."""

OURS = "time-windows"
SWIFT = f"{OURS}:swift=true"
"""The search for large fleets, which small ones would never use."""


class FuzzError(AssertionError):
    """Something that must not happen."""


@dataclass(frozen=True)
class Verdict:
    """How a case ended.

    Attributes
    ----------
    outcome
        `refused`, `driven` or `stopped` (with a report; never if well-formed and planned by ours).
    told
        A few words.
    """

    outcome: str
    told: str


def draw(number: int) -> dict[str, Any]:
    """Return the case of a number."""
    rng = generator(number, Stream.TRIPS, 1_000_000)

    def one(*values: Any) -> Any:
        return values[int(rng.integers(len(values)))]

    tiers = one(1, 1, 1, 2)
    return {
        "format": FORMAT,
        "case": number,
        "planner": one(*all_planners(), OURS, OURS, SWIFT),
        "spoilt": one("nothing", "nothing", "nothing", "an edge", "a queue", "a place", "turned"),
        "layout": {
            "seed": int(rng.integers(1000)),
            "tiers": tiers,
            "robots": int(rng.integers(1, 25)),
            "horizontal_aisles": int(2 * rng.integers(2, 6)),
            "vertical_aisles": int(2 * rng.integers(1, 5)),
            "block_length": one(2, 4, 6),
            "hall_pattern": one("tim", "tim", "highway"),
            "hall_width": one(2, 4, 6),
            "single_lane": one(True, True, False),
            "two_directional_aisles": one(False, False, False, True),
            "counter_clockwise_ring": one(True, False),
            "pod_share": round(0.4 + 0.5 * float(rng.random()), 2),
            "acceleration_m_s2": one(0.5, 1.0, 2.0),
            "top_speed_m_s": one(0.8, 1.5, 3.0),
            "full_turn_s": one(2.5, 6.0),
            "pick_stations": {"west": 0, "east": int(rng.integers(1, 3)), "north": one(0, 0, 1)},
            "replenishment_stations": {"west": 1, "south": one(0, 0, 1)},
            "elevators": {"north" if rng.random() < 0.5 else "south": int(tiers > 1)},
        },
    }


def run(case: dict[str, Any]) -> Verdict:
    """Run a case.

    Raises
    ------
    FuzzError
        If something happened that must not.
    """
    try:
        overrides = [([key], value) for key, value in case["layout"].items()]
        whole = layouts.load("default", overrides)
        layout = spoilt(whole, case["spoilt"], case["case"])
    except InputError as error:
        return Verdict("refused", str(error)[:160])
    violations = check(layout)
    if violations and layout is whole:
        raise FuzzError(f"what the generator made is not well-formed: {violations[0]}")
    if any(one.severity == IMPOSSIBLE for one in violations):
        return Verdict("refused", str(violations[0])[:160])
    return _driven(layout, case, well_formed=not violations)


def _driven(layout: Layout, case: dict[str, Any], *, well_formed: bool) -> Verdict:
    number, name = case["case"], case["planner"]
    try:
        stream = random_trips(layout, number)
    except InputError as error:
        return Verdict("refused", str(error)[:160])
    chosen = settings(name, number, layout)
    done = drive(layout, stream, chosen, duration_s=DURATION_S, proven=True, stall_s=STALL_S)
    assert done.report is not None
    if not done.report.ok:
        raise FuzzError(done.report.summary())
    shape = f"{layout.waypoints} waypoints, {layout.robots} robots, {name}"
    if done.stalled:
        if well_formed and name == OURS:
            raise FuzzError(f"no robot moves any more\n{done.stalled}")
        return Verdict("stopped", f"{shape}: at {done.end_s:.0f} s")
    moved = set(done.traffic.trips()["robot"].tolist())
    left = [r for r in range(layout.robots) if r not in moved and not done.traffic.plan(r)]
    if well_formed and name == OURS and left:
        raise FuzzError(f"robots {left} were left behind\n{done.traffic.state_report()}")
    return Verdict("driven", f"{shape}: {len(done.delays_s)} trips")


def spoilt(layout: Layout, what: str, seed: int) -> Layout:
    """Return a layout with something taken away, turned or put in the way."""
    rng = generator(seed, Stream.TRIPS, 1_000_001)
    match what:
        case "an edge":
            gone = int(rng.integers(len(layout.edge_target)))
            start = layout.edge_start.copy()
            start[np.searchsorted(start, gone, side="right") :] -= 1
            return replace(
                layout, edge_start=start, edge_target=np.delete(layout.edge_target, gone)
            )
        case "a queue":
            station = layout.pick_stations[int(rng.integers(len(layout.pick_stations)))]
            short = replace(station, queue=station.queue[: int(rng.integers(1, 4))])
            others = tuple(short if s is station else s for s in layout.pick_stations)
            return replace(layout, pick_stations=others)
        case "a place":
            storage = layout.is_storage.copy()
            storage[int(rng.choice(np.flatnonzero(~storage & ~layout.is_queue)))] = True
            return replace(layout, is_storage=storage)
        case "turned":
            return _turned(layout, int(rng.integers(len(layout.edge_target))))
    return layout


def _turned(layout: Layout, which: int) -> Layout:
    """Turn one edge round."""
    tails = np.repeat(np.arange(layout.waypoints), np.diff(layout.edge_start))
    pairs = list(zip(tails.tolist(), layout.edge_target.tolist(), strict=True))
    tail, head = pairs.pop(which)
    pairs = sorted({*pairs, (head, tail)})
    start = np.searchsorted([a for a, _ in pairs], np.arange(layout.waypoints + 1))
    return replace(
        layout,
        edge_start=start.astype(np.int32),
        edge_target=np.array([b for _, b in pairs], np.int32),
    )


def fuzz(first: int, seconds: float, out: Path, tell: Callable[[str], None]) -> dict[str, int]:
    """Run case after case for so many seconds of wall time.

    Parameters
    ----------
    first
        Number of the first case.
    out
        Folder for cases that fail; one that hangs is there, too.

    Returns
    -------
    How many cases ended in which way, `failed` among them.
    """
    counts = dict.fromkeys(("driven", "stopped", "refused", "failed"), 0)
    until, number = time.monotonic() + seconds, first
    while time.monotonic() < until:
        case = draw(number)
        path = out / f"case-{number}.json"
        write_text(path, json.dumps(case, indent=2) + "\n")
        signal.alarm(PATIENCE_S)
        try:
            verdict = run(case)
        except Exception as error:
            counts["failed"] += 1
            tell(f"case {number} FAILED: {type(error).__name__}: {error}; see {path}")
        else:
            counts[verdict.outcome] += 1
            path.unlink()
            tell(f"case {number} {verdict.outcome}: {verdict.told}")
        finally:
            signal.alarm(0)
        number += 1
    return counts


def read(path: Path) -> dict[str, Any]:
    """Read the file of a case.

    Raises
    ------
    InputError
        If it is not one.
    """
    try:
        case: dict[str, Any] = json.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError) as error:
        raise InputError(f"{path}: cannot be read ({error})") from None
    if not isinstance(case, dict) or case.get("format") != FORMAT:
        raise InputError(f'{path}: expected an object with "format": "{FORMAT}"')
    return case


def main(arguments: list[str] | None = None) -> int:
    """Fuzz, or run one case again, and return the exit code: 1 if a case failed."""
    parser = argparse.ArgumentParser(prog="python -m tests.tools.fuzz", description=__doc__)
    parser.add_argument("--seconds", type=float, default=600.0, help="wall time to go on for")
    parser.add_argument("--seed", type=int, default=0, help="number of the first case")
    parser.add_argument(
        "--out", type=Path, default=Path("results/fuzz"), help="folder for cases that fail"
    )
    parser.add_argument("--replay", type=Path, help="run the case of a file again")
    given = parser.parse_args(arguments)
    try:
        if given.replay is not None:
            verdict = run(read(given.replay))
            print(f"{given.replay} {verdict.outcome}: {verdict.told}")
            return 0
        counts = fuzz(given.seed, given.seconds, given.out, print)
    except InputError as error:
        print(f"fuzz: {error}", file=sys.stderr)
        return 2
    print(", ".join(f"{number} {name}" for name, number in counts.items()))
    return 1 if counts["failed"] else 0


if __name__ == "__main__":
    sys.exit(main())

"""How the computing time of whole warehouses grows with the fleet: `rmfs traffic warehouses`.

The layouts are generated like the shipped layout `default`, with about ten pods and 1/12 of a pick
station per robot. The backlog is constant, and rules decide. Each run has its own process, because
memory is measured per process. Times are processor times, which equal wall times on an otherwise
idle core. Two windows of simulated time are measured: the rush at the start, and a later window, in
normal operation.
"""

from __future__ import annotations

import json
import multiprocessing
import time
from dataclasses import asdict, dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
import pandas as pd

from rmfs.experiments.provenance import FORMAT, SUFFIX, command
from rmfs.experiments.running.code import code
from rmfs.experiments.traffic.duel import save as save_table
from rmfs.files import write_text
from rmfs.layout import load
from rmfs.measure.memory import peak_rss_mb
from rmfs.measure.provenance import commit
from rmfs.simulation.run import Simulation

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence
    from pathlib import Path

    from numpy.typing import NDArray

    from rmfs.layout.model import Layout

SIDES = ("east", "west", "north", "south")


@dataclass(frozen=True)
class Site:
    """A warehouse for a given number of robots.

    Attributes
    ----------
    horizontal, vertical
        Numbers of aisles.
    picks, replenishments
        Numbers of pick stations and of replenishment stations on each side, in the order east,
        west, north, south.
    """

    robots: int
    horizontal: int
    vertical: int
    picks: tuple[int, int, int, int]
    replenishments: tuple[int, int, int, int]

    def layout(self) -> Layout:
        """Generate the layout, with many aisles between small blocks (2 x 2 storage locations)."""
        values: dict[str, Any] = {
            "robots": self.robots,
            "horizontal_aisles": self.horizontal,
            "vertical_aisles": self.vertical,
            "block_length": 2,
            "pick_stations": dict(zip(SIDES, self.picks, strict=True)),
            "replenishment_stations": dict(zip(SIDES, self.replenishments, strict=True)),
        }
        return load("default", [([key], value) for key, value in values.items()])


SITES = [
    Site(125, 24, 14, (6, 5, 0, 0), (0, 0, 1, 1)),
    Site(250, 32, 22, (11, 10, 0, 0), (0, 0, 2, 2)),
    Site(500, 48, 30, (21, 21, 0, 0), (0, 0, 4, 4)),
    Site(1000, 60, 48, (30, 30, 12, 12), (0, 0, 8, 8)),
    Site(2000, 158, 38, (79, 79, 5, 5), (0, 0, 14, 14)),
]

DECIMALS = {
    **dict.fromkeys(("waypoints", "pods", "pick stations", "replenishment stations"), 0),
    **dict.fromkeys(("faster with the start", "faster", "orders/h", "standing", "peak MB"), 0),
    **dict.fromkeys(("CPU s, start", "CPU s", "decisions %"), 1),
    **dict.fromkeys(("stations busy %", "delay s"), 1),
    "CPU s per robot-hour": 4,
    "collisions": 0,
}

WINDOW_S = 600.0
"""Length of both the initial and the later window, in simulated s."""


def table(
    rules: Sequence[str],
    robots: tuple[int, int],
    later_s: float,
    seed: int = 1,
    *,
    check: bool = False,
    tell: Callable[[str], None] = print,
) -> pd.DataFrame:
    """Measure sites of several fleet sizes; return one row per site and set of rules.

    Parameters
    ----------
    rules
        Sets of rules: controllers files, or names of shipped ones.
    robots
        Sizes of the smallest and the largest fleet.
    later_s
        Start of the later window, in s.
    check
        Whether the motion is recorded and checked; times and memory then include the recording.
    tell
        Function called with the text of each row as soon as the row is measured.
    """
    rows = []
    for site in SITES:
        for rule in rules if robots[0] <= site.robots <= robots[1] else ():
            with multiprocessing.get_context("spawn").Pool(1) as pool:
                rows.append(pool.apply(measure, (asdict(site), rule, later_s, seed, check)))
            tell(", ".join(f"{name} {value}" for name, value in rows[-1].items()))
    return pd.DataFrame(rows).set_index("robots")


def measure(
    site: dict[str, Any], rules: str, later_s: float, seed: int, check: bool
) -> dict[str, Any]:
    """Measure one site under one set of rules.

    The process must have done nothing else before, so that its memory is that of this site.
    """
    made = Site(**site)
    layout = made.layout()
    simulation = Simulation(
        layout,
        "default",
        rules,
        seed=seed,
        set={"scenario.warmup_s": later_s, "scenario.duration_s": WINDOW_S},
        trace=check,
    )
    begin_s = time.process_time()
    simulation.run_until(min(WINDOW_S, later_s))
    start_s = time.process_time() - begin_s
    standing = advance_by_windows(simulation, later_s)
    decided_s = _deciding_s(simulation)
    wall_s, begin_s = simulation.wall_s, time.process_time()
    simulation.run()
    cpu_s, wall_s = time.process_time() - begin_s, simulation.wall_s - wall_s
    peak_mb = peak_rss_mb()
    standing = max(standing, standing_with_work(simulation.traffic.motion()))
    run = simulation.result()
    footprint = run.footprint
    return {
        "robots": made.robots,
        "rules": rules,
        "waypoints": layout.waypoints,
        "pods": layout.pods,
        "pick stations": sum(made.picks),
        "replenishment stations": sum(made.replenishments),
        "CPU s, start": start_s,
        "faster with the start": min(WINDOW_S, later_s) / start_s,
        "CPU s": cpu_s,
        "faster": WINDOW_S / cpu_s,
        "CPU s per robot-hour": cpu_s / (made.robots * WINDOW_S / 3600.0),
        "decisions %": 100.0 * (_deciding_s(simulation) - decided_s) / wall_s,
        "orders/h": float(footprint["orders_per_h"]),
        "stations busy %": 100.0 * (1.0 - float(footprint["pick_station_idle_share"])),
        "delay s": float(footprint["trip_delay_mean_s"]),
        "standing": standing,
        "peak MB": peak_mb,
        "collisions": run.check().collisions if check else np.nan,
    }


def advance_by_windows(simulation: Simulation, until_s: float) -> int:
    """Advance a run window by window, and count the robots that stand still throughout a window.

    Parameters
    ----------
    simulation
        A run before the end of its warm-up.
    until_s
        Simulated time at which to stop, in s; not after the end of the warm-up, as the statistics
        are reset then.

    Returns
    -------
    The largest number of robots that stood still throughout a window (see `standing_with_work`).
    The last window, of at most `WINDOW_S`, is not included.
    """
    most = 0
    motion = simulation.traffic.motion()
    while simulation.world.now_s + WINDOW_S < until_s:
        before = {name: values.copy() for name, values in motion.items()}
        simulation.run_until(simulation.world.now_s + WINDOW_S)
        motion = simulation.traffic.motion()
        passed = {name: values - before[name] for name, values in motion.items()}
        most = max(most, standing_with_work(passed))
    simulation.run_until(until_s)
    return most


def standing_with_work(motion: dict[str, NDArray[Any]]) -> int:
    """Return how many robots had a destination but stood still throughout a window.

    Parameters
    ----------
    motion
        The times of `Traffic.motion` that elapsed in the window.
    """
    moved = motion["moving_s"] + motion["turning_s"] + motion["transfer_s"] + motion["served_s"]
    return int(np.sum((moved <= 1e-6) & (motion["waiting_s"] >= WINDOW_S - 1e-6)))


def _deciding_s(simulation: Simulation) -> float:
    """Return the wall time of all decisions since the end of the warm-up, or since the start."""
    return sum(sum(one.wall_ns) for one in simulation.deciding.statistics.values()) / 1e9


def growth(frame: pd.DataFrame) -> dict[str, float]:
    """Return, for each set of rules, the growth of the processor time per robot-hour.

    The growth is the time with the largest fleet divided by the time with the smallest fleet.
    """
    grown = {}
    for rules, rows in frame.groupby("rules", sort=False):
        work = rows["CPU s per robot-hour"]
        grown[str(rules)] = float(work.iloc[-1] / work.iloc[0])
    return grown


def save(frame: pd.DataFrame, out: Path, **settings: Any) -> list[Path]:
    """Write the table to a folder as CSV and Markdown, each file with its provenance.

    Parameters
    ----------
    settings
        Settings that determine the results, to be recorded in the provenance files.
    """
    paths = [out / f"scale-warehouses.{ending}" for ending in ("csv", "md")]
    for path in paths:
        save_table(frame, path, DECIMALS)
        told = {
            "format": FORMAT,
            "file": path.name,
            "sites": [asdict(site) for site in SITES if site.robots in frame.index],
            "window_s": WINDOW_S,
            **settings,
            "written_by": {**code(), **commit()},
            "command": command(),
        }
        write_text(path.with_name(path.name + SUFFIX), json.dumps(told, indent=1) + "\n")
    return paths

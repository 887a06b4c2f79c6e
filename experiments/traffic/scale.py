"""Growth of computing time and memory with the fleet: `rmfs traffic scale`.

The layouts are generated like the shipped layout `default`, with 28 to 31 waypoints and about 1/16
of a station (with 32 robots, 1/8) per robot. One planner plans random trips. Each size is measured
in a separate process, because memory is measured per process. Times are processor times, which
equal wall times on an otherwise idle core.
"""

from __future__ import annotations

import ctypes
import json
import multiprocessing
import resource
import time
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pandas as pd

from rmfs.experiments.figures.style import saving
from rmfs.experiments.provenance import FORMAT, SUFFIX, command
from rmfs.experiments.running.code import code
from rmfs.experiments.traffic.duel import save as save_table
from rmfs.experiments.traffic.duel import settings
from rmfs.files import write_text
from rmfs.layout import load
from rmfs.measure.memory import peak_rss_mb
from rmfs.measure.provenance import commit
from rmfs.traffic import Traffic
from rmfs.trips import drive, random_trips

if TYPE_CHECKING:
    from collections.abc import Callable

    from rmfs.layout.model import Layout

WARMUP_S = 300.0
"""Simulated warm-up in s, until the initial rush is over and frequently used tables are built."""

ENOUGH_ROBOTS = 1000
"""Number of robots for which the simulator is required to reach `FASTER`."""
FASTER = 60.0
"""Required simulated seconds per processor second, with `ENOUGH_ROBOTS` robots."""


@dataclass(frozen=True)
class Size:
    """A layout for a given number of robots.

    Attributes
    ----------
    horizontal, vertical
        Numbers of aisles.
    long_sides, short_sides
        Numbers of stations on a side: `long_sides` pick stations in the east, `long_sides`
        replenishment stations in the west, `short_sides` pick stations in the north and
        `short_sides` replenishment stations in the south.
    """

    robots: int
    horizontal: int
    vertical: int
    long_sides: int
    short_sides: int

    def layout(self, robots: int | None = None) -> Layout:
        """Generate the layout; `robots`, if given, replaces the number of robots."""
        long_, short = self.long_sides, self.short_sides
        values: dict[str, Any] = {
            "robots": self.robots if robots is None else robots,
            "horizontal_aisles": self.horizontal,
            "vertical_aisles": self.vertical,
            "pick_stations": {"east": long_, "west": 0, "north": short, "south": 0},
            "replenishment_stations": {"east": 0, "west": long_, "north": 0, "south": short},
        }
        return load("default", [([key], value) for key, value in values.items()])


SIZES = [
    Size(32, 4, 4, 1, 1),
    Size(64, 6, 8, 1, 1),
    Size(128, 16, 8, 3, 1),
    Size(256, 22, 14, 5, 3),
    Size(512, 38, 18, 11, 5),
    Size(1000, 48, 30, 19, 12),
    Size(2000, 70, 44, 35, 22),
]

DECIMALS = {
    **dict.fromkeys(("robots", "waypoints", "stations", "trips/h", "km/h", "times faster"), 0),
    **dict.fromkeys(("simulated s", "expansions per trip", "peak MB", "bytes per waypoint"), 0),
    **dict.fromkeys(("delay s", "CPU s per h", "kB per robot"), 1),
    "CPU ms per trip": 2,
}


def table(
    planner: str,
    most: int = 2000,
    duration_s: float = 600.0,
    seed: int = 1,
    tell: Callable[[str], None] = print,
) -> pd.DataFrame:
    """Measure all sizes up to `most` robots; return a table with one row per size.

    Parameters
    ----------
    planner
        The planner as text, as for `rmfs.experiments.traffic.duel.chosen`.
    tell
        Function called with the text of each row as soon as the row is measured.
    """
    rows = []
    for size in SIZES:
        if size.robots <= most:
            with multiprocessing.get_context("spawn").Pool(1) as pool:
                rows.append(pool.apply(measure, (asdict(size), planner, duration_s, seed)))
            tell(", ".join(f"{name} {value:.6g}" for name, value in rows[-1].items()))
    frame = pd.DataFrame(rows).set_index("robots")
    frame.insert(0, "planner", planner)
    return frame


def measure(size: dict[str, int], planner: str, duration_s: float, seed: int) -> dict[str, float]:
    """Measure one size.

    The process must have done nothing else before, so that its memory is that of this size.
    """
    made = Size(**size)
    small, layout = made.layout(1), made.layout()
    before_mb = resident_mb()
    only_network = Traffic(small, cost_table_bytes=0)
    network_mb = resident_mb() - before_mb
    del only_network
    stream, chosen = random_trips(layout, seed), settings(planner, seed, layout)
    marks: list[float] = []

    def noted(traffic: Traffic) -> None:
        if not marks and traffic.now_us >= WARMUP_S * 1e6:
            marks.append(time.process_time())

    run = drive(layout, stream, chosen, duration_s=duration_s, warmup_s=WARMUP_S, each=noted)
    cpu_s = time.process_time() - marks[0]
    hours, trips = duration_s / 3600.0, len(run.delays_s)
    driving_mb = resident_mb() - before_mb - network_mb
    return {
        "robots": layout.robots,
        "waypoints": layout.waypoints,
        "stations": len(layout.stations),
        "simulated s": duration_s,
        "trips/h": run.trips_per_h,
        "delay s": float(np.mean(run.delays_s)),
        "km/h": run.distance_m / 1e3 / hours,
        "CPU s per h": cpu_s / hours,
        "times faster": duration_s / cpu_s,
        "CPU ms per trip": 1e3 * cpu_s / trips,
        "expansions per trip": run.traffic.counters()["expansions"] / trips,
        "peak MB": peak_rss_mb(),
        "bytes per waypoint": 1e6 * network_mb / layout.waypoints,
        "kB per robot": 1e3 * driving_mb / layout.robots,
    }


def resident_mb() -> float:
    """Return the resident memory of this process, in MB (10^6 bytes); nan if unknown."""
    try:
        # what was freed and kept is not in use
        ctypes.CDLL(None).malloc_trim(0)
        pages = int(Path("/proc/self/statm").read_text(encoding="ascii").split()[1])
    except (OSError, ValueError, IndexError, AttributeError):
        return float("nan")
    return pages * resource.getpagesize() / 1e6


def save(frame: pd.DataFrame, out: Path, **settings: Any) -> list[Path]:
    """Write the table (CSV and Markdown) and the plot to a folder, each file with its provenance.

    Parameters
    ----------
    settings
        Settings that determine the results, to be recorded in the provenance files.
    """
    paths = [out / f"scale.{ending}" for ending in ("csv", "md", "png")]
    save_table(frame, paths[0], DECIMALS)
    save_table(frame, paths[1], DECIMALS)
    picture(frame, paths[2])
    for path in paths:
        told = {
            "format": FORMAT,
            "file": path.name,
            "sizes": [asdict(size) for size in SIZES if size.robots in frame.index],
            "warmup_s": WARMUP_S,
            **settings,
            "written_by": {**code(), **commit()},
            "command": command(),
        }
        write_text(path.with_name(path.name + SUFFIX), json.dumps(told, indent=1) + "\n")
    return paths


def exponent(frame: pd.DataFrame, column: str = "trips/h") -> float:
    """Return the exponent b in processor time = a * column^b, from a linear fit of the logarithms.

    An exponent of 1 means linear growth.
    """
    work, cpu = np.log(frame[column].to_numpy()), np.log(frame["CPU s per h"].to_numpy())
    return float(np.polyfit(work, cpu, 1)[0])


def picture(frame: pd.DataFrame, path: Path) -> None:
    """Plot computing time and memory against the number of robots."""
    robots = frame.index.to_numpy()
    with saving(path, 8.0, 3.6) as figure:
        left, right = figure.subplots(1, 2)
        left.loglog(robots, frame["CPU s per h"], marker="o", label="measured")
        for column, dashes, label in (("trips/h", ":", "trips"), ("km/h", "--", "metres driven")):
            linear = frame[column] * (frame["CPU s per h"] / frame[column]).iloc[0]
            left.loglog(robots, linear, linestyle=dashes, color="0.5", label=f"linear in {label}")
        left.axhline(3600.0 / FASTER, linewidth=0.8, color="black")
        left.set_ylabel("CPU seconds per simulated hour")
        left.legend(fontsize=8)
        right.semilogx(robots, frame["peak MB"], marker="o")
        right.set_ylim(bottom=0)
        right.set_ylabel("peak memory (MB)")
        for ax in (left, right):
            ax.set_xlabel("robots")
            ax.set_xticks(robots, [str(n) for n in robots])
            ax.minorticks_off()

"""A comparison of planners on the same trips."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import pandas as pd

from rmfs.config import Table, parse_override
from rmfs.control import registry
from rmfs.control.choices import choose
from rmfs.control.pp import planner_settings
from rmfs.control.problems import Problem
from rmfs.errors import InputError
from rmfs.files import write_text

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from rmfs.control.choices import Choice
    from rmfs.layout.model import Layout
    from rmfs.traffic import PlannerSettings
    from rmfs.trips import TripRun

DECIMALS = {
    "trips/h": 0,
    "delay s": 2,
    "delay s, 95 %": 1,
    "km/h": 1,
    "plans/h": 0,
    "expansions/h": 0,
    "failures/h": 0,
    "planning s/h": 2,
    "ms per call": 3,
    "ms per call, 95 %": 3,
    "sim/wall": 0,
    "idle robots": 0,
    "collisions": 0,
}
"""The columns, and the number of decimal places of each."""


def chosen(text: str) -> Choice:
    """Return the planner named by a text.

    Parameters
    ----------
    text
        A name, or a name with parameters: `far:reroute=false,patience_s=20`.

    Raises
    ------
    InputError
        If there is no such planner or parameter.
    """
    name, _, given = text.partition(":")
    table: Table = {"name": name}
    for part in given.split(",") if given else []:
        path, value = parse_override(part)
        table[".".join(path)] = value
    return choose(Problem.PP, table, f"--planner {text}")


def settings(text: str, seed: int, layout: Layout) -> PlannerSettings:
    """Return the settings, for a layout, of the planner named by a text (see `chosen`)."""
    return planner_settings(chosen(text), seed, layout)


def all_planners() -> list[str]:
    """Return the names of all planners."""
    return registry.names(Problem.PP)


def row(run: TripRun) -> dict[str, float]:
    """Return the table row of a run; `collisions` is nan if the run was not checked."""
    hours = run.duration_s / 3600.0
    counters, delays = run.traffic.counters(), run.delays_s
    calls_ms = 1e3 * run.traffic.call_times_s()
    return {
        "trips/h": run.trips_per_h,
        "delay s": float(delays.mean()) if len(delays) else np.nan,
        "delay s, 95 %": float(np.quantile(delays, 0.95)) if len(delays) else np.nan,
        "km/h": run.distance_m / 1e3 / hours,
        "plans/h": (counters["plans"] + counters["replans"]) / hours,
        "expansions/h": counters["expansions"] / hours,
        "failures/h": counters["plan_failures"] / hours,
        "planning s/h": counters["planning_s"] / hours,
        "ms per call": float(np.median(calls_ms)) if len(calls_ms) else np.nan,
        "ms per call, 95 %": float(np.quantile(calls_ms, 0.95)) if len(calls_ms) else np.nan,
        "sim/wall": max(run.end_s - run.warmup_s, 0.0) / run.wall_s,
        "idle robots": run.idle_robots,
        "collisions": run.report.collisions if run.report is not None else np.nan,
    }


def table(rows: dict[str, dict[str, float]], *, index: str = "planner") -> pd.DataFrame:
    """Return the rows of all planners as a frame; the keys of `rows` are names of planners."""
    frame = pd.DataFrame.from_dict(rows, orient="index")
    frame.index.name = index
    return frame


def markdown(frame: pd.DataFrame, decimals: dict[str, int] | None = None) -> str:
    """Format a frame of numbers as a Markdown table."""
    digits = DECIMALS if decimals is None else decimals
    head = [str(frame.index.name), *frame.columns]
    lines = [f"| {' | '.join(head)} |", f"|---|{'---:|' * len(frame.columns)}"]
    for name, cells in frame.iterrows():
        shown = [_shown(value, digits.get(str(column), 2)) for column, value in cells.items()]
        lines.append(f"| {name} | {' | '.join(shown)} |")
    return "\n".join(lines)


def save(frame: pd.DataFrame, path: Path, decimals: dict[str, int] | None = None) -> None:
    """Write a table in the format given by the file's suffix.

    Raises
    ------
    InputError
        If the suffix is neither .csv nor .md.
    """
    match path.suffix.lower():
        case ".csv":
            write_text(path, frame.to_csv())
        case ".md":
            write_text(path, markdown(frame, decimals) + "\n")
        case _:
            raise InputError(f"{path}: unknown kind of table; valid: .csv, .md")


def check_planners(texts: Sequence[str]) -> None:
    """Raise an error if a planner or one of its parameters is invalid."""
    for text in texts:
        chosen(text)


def _shown(value: Any, digits: int) -> str:
    if isinstance(value, str):
        return value
    return "-" if np.isnan(value) else f"{value:,.{digits}f}"

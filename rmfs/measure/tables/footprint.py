"""The footprint: one row that sums up a run."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Protocol

import pandas as pd

from rmfs.measure.memory import peak_rss_mb
from rmfs.measure.steps import Steps
from rmfs.measure.tables import logs
from rmfs.measure.tables.decisions import decisions
from rmfs.measure.tables.motion import trips
from rmfs.measure.tables.orders import completed, orders
from rmfs.measure.tables.robots import STATES, robots
from rmfs.measure.tables.series import inventory_share
from rmfs.measure.tables.stations import stations
from rmfs.measure.tables.tidy import tidy

if TYPE_CHECKING:
    from rmfs.measure.checker import CheckReport
    from rmfs.measure.recorder import Recorder

NOTHING = float("nan")


class Measured(Protocol):
    """What a footprint is made from: a run that has ended."""

    @property
    def names(self) -> tuple[str, str, str]:
        """Names of layout, scenario and controllers."""

    @property
    def seed(self) -> int:
        """Seed of the run."""

    @property
    def recorder(self) -> Recorder:
        """What was written down."""

    @property
    def wall_s(self) -> float:
        """Wall time of the simulation."""


def footprint(run: Measured, report: CheckReport | None = None) -> pd.DataFrame:
    """Return the table of one row.

    Parameters
    ----------
    report
        What the trace checker found; without it `collisions` stays empty.
    """
    recorder = run.recorder
    at_stations = stations(recorder)
    counted = {**_counts(recorder, at_stations), **_motion(recorder)}
    columns = {
        **_heading(run),
        **counted,
        **_rates(recorder, counted),
        **_visits(recorder, counted),
        **_per_distance(recorder, counted),
        **_shares(recorder, at_stations),
        **_times(recorder),
        **_levels(recorder),
        **_planning(recorder, report),
        **_decisions(recorder),
        **_machine(run),
    }
    return tidy("footprint", {name: [value] for name, value in columns.items()})


def ratio(amount: float, by: float) -> float:
    """Divide; empty where there is nothing to divide by."""
    return amount / by if by else NOTHING


def _heading(run: Measured) -> dict[str, Any]:
    recorder = run.recorder
    layout = recorder.layout
    names = dict(zip(("layout", "scenario", "controllers"), run.names, strict=True))
    return {
        **names,
        "seed": run.seed,
        "warmup_s": recorder.start_s,
        "duration_s": recorder.duration_s,
        "tiers": len(layout.tiers),
        "robots": layout.robots,
        "pods": layout.pods,
        "pick_stations": len(layout.pick_stations),
        "replenishment_stations": len(layout.replenishment_stations),
        "skus": len(recorder.world.skus),
    }


def _counts(recorder: Recorder, at_stations: pd.DataFrame) -> dict[str, Any]:
    """Count what was handled; all of it happens at stations."""
    visits = logs.visits(recorder)
    bundles = logs.measured(recorder, logs.stored(recorder))
    arrived = logs.measured(recorder, logs.orders(recorder), "created_s")
    handled = ("orders_completed", "lines_picked", "units_picked", "bundles_stored")
    return {
        **{name: int(at_stations[name].sum()) for name in handled},
        "pick_visits": int((visits["units"] > 0).sum()),
        "replenishment_visits": int((visits["bundles"] > 0).sum()),
        "units_stored": int(bundles["units"].sum()),
        "orders_created": len(arrived),
        "bundles_created": len(logs.measured(recorder, logs.bundles(recorder), "created_s")),
        "order_redraws": int(recorder.counters["order_redraws"]),
    }


def _motion(recorder: Recorder) -> dict[str, Any]:
    ended = trips(recorder)
    lasted = ended["end_s"] - ended["start_s"]
    delay = (lasted - ended["unhindered_s"])[ended["kind"] != "to_station"]
    return {
        "distance_m": float(recorder.motion["distance_m"].sum()),
        "loaded_distance_m": float(recorder.motion["loaded_distance_m"].sum()),
        "trips": len(ended),
        "trip_time_mean_s": lasted.mean(),
        "trip_delay_mean_s": delay.mean(),
        "pods_lifted": sum(time >= recorder.start_s for time, _, _ in recorder.lifts),
    }


def _rates(recorder: Recorder, counted: dict[str, Any]) -> dict[str, float]:
    hours = recorder.duration_s / 3600.0
    handled = {"orders": "completed", "lines": "picked", "units": "picked", "bundles": "stored"}
    return {
        f"{what}_per_h": ratio(counted[f"{what}_{how}"], hours) for what, how in handled.items()
    }


def _visits(recorder: Recorder, counted: dict[str, Any]) -> dict[str, float]:
    late = logs.measured(recorder, logs.units(recorder))["late_bound"].sum()
    picks = counted["pick_visits"]
    return {
        "units_per_visit": ratio(counted["units_picked"], picks),
        "lines_per_visit": ratio(counted["lines_picked"], picks),
        "orders_per_visit": ratio(counted["orders_completed"], picks),
        "late_bound_units_per_visit": ratio(int(late), picks),
        "bundles_per_visit": ratio(counted["bundles_stored"], counted["replenishment_visits"]),
    }


def _per_distance(recorder: Recorder, counted: dict[str, Any]) -> dict[str, float]:
    return {
        "distance_per_robot_m": ratio(counted["distance_m"], recorder.layout.robots),
        "distance_per_unit_m": ratio(counted["distance_m"], counted["units_picked"]),
    }


def _shares(recorder: Recorder, at_stations: pd.DataFrame) -> dict[str, float]:
    """Shares of stations' and robots' time, and the score against the stations' bound."""
    by_robot = robots(recorder)
    robot_time = recorder.layout.robots * recorder.duration_s
    busy = sum(
        by_robot[f"task_{task}_s"].sum() for task in ("pick", "replenish", "park", "reposition")
    )
    kinds = at_stations.groupby("kind")["idle_share"].mean()
    bound = at_stations["units_per_h_bound"].sum()
    rate = ratio(at_stations["units_picked"].sum() * 3600.0, recorder.duration_s)
    return {
        "units_per_h_bound": bound,
        "units_score": ratio(rate, bound),
        "pick_station_idle_share": kinds.get("pick", NOTHING),
        "replenishment_station_idle_share": kinds.get("replenishment", NOTHING),
        "robot_busy_share": ratio(busy, robot_time),
        **{
            f"robot_{state}_share": ratio(by_robot[f"{state}_s"].sum(), robot_time)
            for state in STATES
        },
    }


def _times(recorder: Recorder) -> dict[str, Any]:
    """How long orders and bundles took, and how many orders were late."""
    done = completed(orders(recorder))
    turnover, throughput = done["turnover_s"], done["throughput_time_s"]
    bundles = logs.measured(recorder, logs.stored(recorder))
    stored = bundles["time_s"] - bundles["created_s"]
    return {
        "order_turnover_mean_s": turnover.mean(),
        "order_turnover_median_s": turnover.median(),
        "order_turnover_lower_quartile_s": turnover.quantile(0.25),
        "order_turnover_upper_quartile_s": turnover.quantile(0.75),
        "order_throughput_time_mean_s": throughput.mean(),
        "order_throughput_time_median_s": throughput.median(),
        "late_share": ratio(int((done["lateness_s"] > 0).sum()), len(done)),
        "bundle_turnover_mean_s": stored.mean(),
        "bundle_turnover_median_s": stored.median(),
    }


def _levels(recorder: Recorder) -> dict[str, Any]:
    """Time averages of what waits and what is in stock."""
    every = logs.orders(recorder)
    begin, end = recorder.start_s, recorder.end_s
    backlog = Steps.between(every["created_s"], every["assigned_s"])
    return {
        "backlog_orders_mean": backlog.mean(begin, end),
        "backlog_orders_end": int(backlog.at(end)),
        "open_orders_mean": Steps.between(every["assigned_s"], every["completed_s"]).mean(
            begin, end
        ),
        "inventory_share_mean": inventory_share(recorder).mean(begin, end),
    }


def _planning(recorder: Recorder, report: CheckReport | None) -> dict[str, Any]:
    counters = recorder.counters
    return {
        **{
            name: int(counters[name])
            for name in ("plans", "plan_failures", "replans", "expansions")
        },
        "planning_wall_s": counters["planning_s"],
        "collisions": pd.NA if report is None else report.collisions,
    }


def _decisions(recorder: Recorder) -> dict[str, Any]:
    frame = decisions(recorder)
    return {
        "decisions": int(frame["decisions"].sum()),
        "decision_wall_s": float(frame["wall_s"].sum()),
        "optimiser_calls": 0,
        "optimiser_gap_mean": NOTHING,
        "paced_s": 0.0,
    }


def _machine(run: Measured) -> dict[str, float]:
    return {
        "wall_s": run.wall_s,
        "sim_per_wall": ratio(run.recorder.end_s, run.wall_s),
        "peak_rss_mb": peak_rss_mb(),
    }

"""The footprint: one row that sums up a run."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Protocol

import pandas as pd

from rmfs.measure.bound import units_per_h_bound, warn_if_exceeded
from rmfs.measure.memory import peak_rss_mb
from rmfs.measure.recorder import TASKS
from rmfs.measure.steps import Steps
from rmfs.measure.tables.orders import completed
from rmfs.measure.tables.robots import STATES
from rmfs.measure.tables.series import inventory_share
from rmfs.measure.tables.tidy import tidy

if TYPE_CHECKING:
    from collections.abc import Mapping

    from rmfs.measure.checker import CheckReport
    from rmfs.measure.recorder import Recorder
    from rmfs.measure.tables.logs import Logs

    Tables = Mapping[str, pd.DataFrame]

NOTHING = float("nan")

BUSY = ("pick", "replenish", "park", "reposition")
"""The tasks in which a robot counts as busy."""


class Measured(Protocol):
    """What a footprint is made from: a run that has ended."""

    @property
    def names(self) -> tuple[str, str, str]:
        """Names of layout, scenario and controllers."""

    @property
    def seed(self) -> int:
        """Seed of the run."""

    @property
    def warmup_s(self) -> float:
        """Simulated time before the measured time."""

    @property
    def duration_s(self) -> float:
        """Measured time."""

    @property
    def recorder(self) -> Recorder:
        """What was written down."""

    @property
    def wall_s(self) -> float:
        """Wall time of the simulation."""


def footprint(
    run: Measured, logs: Logs, tables: Tables, report: CheckReport | None = None
) -> pd.DataFrame:
    """Return the table of one row.

    Parameters
    ----------
    logs, tables
        What happened, and the other tables made from it: what they count is not counted again.
    report
        What the trace checker found; without it `collisions` stays empty.
    """
    counted = {**_counts(logs, tables["stations"]), **_motion(logs, tables["trips"])}
    columns = {
        **_heading(run, logs),
        **counted,
        **_rates(logs, counted),
        **_possible(logs, counted, tables["stations"]),
        **_per_visit(logs, counted),
        **_per_distance(logs, counted),
        **_shares(logs, tables["stations"], tables["robots"]),
        **_times(logs, tables["orders"]),
        **_spreads(logs, tables["orders"]),
        **_tasks(tables["robots"]),
        **_levels(logs),
        **_planning(logs, report),
        **_decisions(logs, tables["decisions"], tables["controllers"]),
        **_machine(run, logs),
    }
    return tidy("footprint", {name: [value] for name, value in columns.items()})


def ratio(amount: float, by: float) -> float:
    """Divide; empty where there is nothing to divide by."""
    return amount / by if by else NOTHING


def _heading(run: Measured, logs: Logs) -> dict[str, Any]:
    layout = logs.layout
    names = dict(zip(("layout", "scenario", "controllers"), run.names, strict=True))
    return {
        **names,
        "seed": run.seed,
        "warmup_s": run.warmup_s,
        "duration_s": run.duration_s,
        "tiers": len(layout.tiers),
        "robots": layout.robots,
        "pods": layout.pods,
        "pick_stations": len(layout.pick_stations),
        "replenishment_stations": len(layout.replenishment_stations),
        "skus": len(logs.world.skus),
    }


def _counts(logs: Logs, stations: pd.DataFrame) -> dict[str, Any]:
    """Count what arrived and what was handled, which happens at stations."""
    handled = ("orders_completed", "lines_picked", "units_picked", "bundles_stored")
    return {
        **{name: int(stations[name].sum()) for name in handled},
        "pick_visits": int((logs.visits["units"] > 0).sum()),
        "replenishment_visits": int((logs.visits["bundles"] > 0).sum()),
        "units_stored": int(logs.stored_now["units"].sum()),
        "orders_created": int((logs.orders["created_s"] >= logs.start_s).sum()),
        "bundles_created": int((logs.bundles["created_s"] >= logs.start_s).sum()),
        **{name: int(logs.recorder.counters[name]) for name in ("order_redraws", "orders_short")},
    }


def _motion(logs: Logs, trips: pd.DataFrame) -> dict[str, Any]:
    motion = logs.recorder.motion
    lasted = trips["end_s"] - trips["start_s"]
    delay = (lasted - trips["unhindered_s"])[trips["kind"] != "to_station"]
    return {
        "distance_m": float(motion["distance_m"].sum()),
        "loaded_distance_m": float(motion["loaded_distance_m"].sum()),
        "trips": len(trips),
        "trip_time_mean_s": lasted.mean(),
        "trip_delay_mean_s": delay.mean(),
        "pods_lifted": len(logs.lifts_now),
    }


def _rates(logs: Logs, counted: dict[str, Any]) -> dict[str, float]:
    hours = logs.duration_s / 3600.0
    handled = {"orders": "completed", "lines": "picked", "units": "picked", "bundles": "stored"}
    return {
        f"{what}_per_h": ratio(counted[f"{what}_{how}"], hours) for what, how in handled.items()
    }


def _possible(logs: Logs, counted: dict[str, Any], stations: pd.DataFrame) -> dict[str, float]:
    """Compare with what no run can exceed, and with stations that never wait."""
    bound = units_per_h_bound(logs.layout, logs.world.skus, logs.recorder.traffic, logs.duration_s)
    rate = ratio(counted["units_picked"] * 3600.0, logs.duration_s)
    warn_if_exceeded(rate, bound)
    return {
        "units_per_h_bound": bound,
        "units_score": ratio(rate, bound),
        "units_per_h_at_pile_on": stations["units_per_h_at_pile_on"].sum(),
    }


def _per_visit(logs: Logs, counted: dict[str, Any]) -> dict[str, float]:
    picks = counted["pick_visits"]
    return {
        "units_per_visit": ratio(counted["units_picked"], picks),
        "lines_per_visit": ratio(counted["lines_picked"], picks),
        "orders_per_visit": ratio(counted["orders_completed"], picks),
        "late_bound_units_per_visit": ratio(int(logs.units_now["late_bound"].sum()), picks),
        "bundles_per_visit": ratio(counted["bundles_stored"], counted["replenishment_visits"]),
    }


def _per_distance(logs: Logs, counted: dict[str, Any]) -> dict[str, float]:
    return {
        "distance_per_robot_m": ratio(counted["distance_m"], logs.layout.robots),
        "distance_per_unit_m": ratio(counted["distance_m"], counted["units_picked"]),
    }


def _shares(logs: Logs, stations: pd.DataFrame, robots: pd.DataFrame) -> dict[str, float]:
    """Shares of stations' and robots' time."""
    robot_time = logs.layout.robots * logs.duration_s
    busy = sum(robots[f"task_{task}_s"].sum() for task in BUSY)
    idle = {kind: own["idle_share"].mean() for kind, own in stations.groupby("kind")}
    active = {kind: own["active_share"].mean() for kind, own in stations.groupby("kind")}
    return {
        "pick_station_idle_share": idle.get("pick", NOTHING),
        "replenishment_station_idle_share": idle.get("replenishment", NOTHING),
        "pick_station_active_share": active.get("pick", NOTHING),
        "replenishment_station_active_share": active.get("replenishment", NOTHING),
        "robot_busy_share": ratio(busy, robot_time),
        **{f"robot_{one}_share": ratio(robots[f"{one}_s"].sum(), robot_time) for one in STATES},
    }


def _times(logs: Logs, orders: pd.DataFrame) -> dict[str, Any]:
    """How long orders and bundles took, and how many orders were late."""
    done = completed(orders)
    turnover, throughput = done["turnover_s"], done["throughput_time_s"]
    stored = logs.stored_now["time_s"] - logs.stored_now["created_s"]
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


def _spreads(logs: Logs, orders: pd.DataFrame) -> dict[str, Any]:
    """Quartiles of what `_times` has no room for, and lateness."""
    done, stored = completed(orders), logs.stored_now
    lateness = done["lateness_s"]
    late = lateness[lateness > 0]
    told = {
        "order_lateness": lateness,
        "late_by": late,
        "bundle_throughput_time": stored["time_s"] - stored["assigned_s"],
    }
    return {
        "orders_late": len(late),
        **{f"{name}_mean_s": values.mean() for name, values in told.items()},
        **{f"{name}_median_s": values.median() for name, values in told.items()},
        **{
            f"{name}_{which}_quartile_s": values.quantile(share)
            for name, values in {
                **told,
                "order_throughput_time": done["throughput_time_s"],
                "bundle_turnover": stored["time_s"] - stored["created_s"],
            }.items()
            for which, share in (("lower", 0.25), ("upper", 0.75))
        },
    }


def _tasks(robots: pd.DataFrame) -> dict[str, int]:
    return {f"tasks_{task}": int(robots[f"tasks_{task}"].sum()) for task in TASKS}


def _levels(logs: Logs) -> dict[str, Any]:
    """Time averages of what waits and what is in stock."""
    orders, measured = logs.orders, (logs.start_s, logs.end_s)
    bundles = Steps.between(logs.bundles["created_s"], logs.bundles["assigned_s"])
    backlog = Steps.between(orders["created_s"], orders["assigned_s"])
    at_stations = Steps.between(orders["assigned_s"], orders["completed_s"])
    return {
        "backlog_orders_mean": backlog.mean(*measured),
        "backlog_orders_end": int(backlog.at(logs.end_s)),
        "open_orders_mean": at_stations.mean(*measured),
        "backlog_bundles_mean": bundles.mean(*measured),
        "backlog_bundles_end": int(bundles.at(logs.end_s)),
        "inventory_share_mean": inventory_share(logs).mean(*measured),
    }


def _planning(logs: Logs, report: CheckReport | None) -> dict[str, Any]:
    counters = logs.recorder.counters
    names = ("plans", "plan_failures", "replans", "expansions")
    return {
        **{name: int(counters[name]) for name in names},
        "planning_wall_s": counters["planning_s"],
        "disturbances": int(counters["disturbances"]),
        "disturbed_s": counters["disturbed_s"],
        "collisions": pd.NA if report is None else report.collisions,
    }


def _decisions(logs: Logs, decisions: pd.DataFrame, controllers: pd.DataFrame) -> dict[str, Any]:
    by_optimiser = decisions[decisions["source"] == "optimiser"]
    sources = ("optimiser", "heuristic", "stale", "failed")
    counts = {source: int(controllers[f"{source}_decisions"].sum()) for source in sources}
    total = sum(counts.values())
    return {
        "decisions": int(decisions["decisions"].sum()),
        "decision_wall_s": sum(wall_s for _, wall_s in logs.recorder.asked.values()),
        "optimiser_calls": len(by_optimiser),
        "optimiser_gap_mean": by_optimiser["gap"].mean(),
        "paced_s": by_optimiser["paced_s"].sum(),
        "optimiser_failures": int((by_optimiser["outcome"] == "failed").sum()),
        "optimiser_wall_s": by_optimiser["wall_s"].sum(),
        "optimiser_wall_median_s": by_optimiser["wall_s"].median(),
        **{f"{source}_decision_share": ratio(counts[source], total) for source in sources},
    }


def _machine(run: Measured, logs: Logs) -> dict[str, float]:
    return {
        "wall_s": run.wall_s,
        "sim_per_wall": ratio(logs.end_s, run.wall_s),
        "peak_rss_mb": peak_rss_mb(),
    }

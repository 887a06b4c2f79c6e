"""The footprint of a real run once more, from its written tables alone and by other means."""

from __future__ import annotations

import numpy as np
import pandas as pd
import pytest

from rmfs.measure import load_run, write_run
from rmfs.measure.columns import TEXT
from rmfs.measure.dictionary import TABLES
from rmfs.measure.measures.energy import Batteries, Energy
from rmfs.measure.measures.packing import Packing
from rmfs.measure.measures.pickers import Pickers
from rmfs.simulation.run import simulate

WARMUP_S, DURATION_S = 300.0, 1500.0
BEGIN, END = WARMUP_S, WARMUP_S + DURATION_S


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    overrides = [
        (["scenario", "warmup_s"], WARMUP_S),
        (["scenario", "duration_s"], DURATION_S),
    ]
    target = tmp_path_factory.mktemp("runs") / "run"
    write_run(simulate("basic", "basic", "default", seed=2, overrides=overrides), target)
    return load_run(target)


def level(begin: pd.Series, end: pd.Series) -> float:
    """Mean number of open intervals, from what each contributes to the measured time."""
    return ((end.fillna(END).clip(BEGIN, END) - begin.clip(BEGIN)).clip(0).sum()) / DURATION_S


def spread(name: str, values: pd.Series) -> dict[str, float]:
    return {
        f"{name}_mean_s": values.mean(),
        f"{name}_median_s": values.median(),
        f"{name}_lower_quartile_s": values.quantile(0.25),
        f"{name}_upper_quartile_s": values.quantile(0.75),
    }


NOT_IN_TABLES = {
    **dict.fromkeys(
        ("orders_stuck_end", "oldest_stuck_end_s"), "tests/simulation/test_short_orders.py"
    ),
    "units_per_h_bound": "not of the run but of its warehouse: tests/solvers/test_run_bounds.py",
    "collisions": "found by the checker: tests/measure/test_checker_*.py",
    **dict.fromkeys(("plans", "plan_failures", "replans", "expansions"), "counted by traffic"),
    **dict.fromkeys(
        ("planning_charged_s", "plan_wait_s"), "0 here; tests/simulation/test_planning_time.py"
    ),
    **dict.fromkeys(("order_redraws", "orders_short"), "counted when an order is drawn, or comes"),
    **dict.fromkeys(("disturbances", "disturbed_s"), "tests/simulation/test_disturbances.py"),
    **dict.fromkeys(
        ("late_motions", "lateness_s", "plans_repaired"), "tests/simulation/test_late_motions.py"
    ),
    **dict.fromkeys(
        (column.name for column in (*Energy.columns, *Batteries.columns)),
        "empty here; tests/simulation/test_energy_use.py",
    ),
    **dict.fromkeys(
        (column.name for column in Packing.columns), "empty here; tests/simulation/test_packing.py"
    ),
    **dict.fromkeys(
        (column.name for column in Pickers.columns),
        "empty here; tests/simulation/test_pickers_in_runs.py",
    ),
    **dict.fromkeys(("planning_wall_s", "wall_s", "peak_rss_mb"), "of the machine, measured once"),
}
"""Numbers of the footprint that no table tells again, and why."""


def sizes(run) -> dict[str, float]:
    """What was simulated."""
    stations = run.table("stations")["kind"]
    return {
        "seed": run.parameters["seed"],
        "warmup_s": run.parameters["scenario"]["parameters"]["warmup_s"],
        "duration_s": run.parameters["scenario"]["parameters"]["duration_s"],
        "tiers": run.table("heat")["tier"].nunique(),
        "robots": len(run.table("robots")),
        "pods": len(run.table("pods")),
        "skus": len(run.table("skus")),
        "pick_stations": (stations == "pick").sum(),
        "replenishment_stations": (stations == "replenishment").sum(),
    }


def inventory(run) -> dict[str, float]:
    """The level at the end, and what each pick and bundle of the measured time changed before."""
    picks, bundles, pods = run.table("picks"), run.table("bundles"), run.table("pods")
    space = run.table("skus").set_index("sku")["space"]
    stored = bundles[bundles["stored_s"] >= BEGIN]
    picked = (space.loc[picks["sku"]].to_numpy() * (picks["time_s"] - BEGIN)).sum()
    put = (
        space.loc[stored["sku"]].to_numpy() * stored["units"] * (stored["stored_s"] - BEGIN)
    ).sum()
    used = pods["used_end"].sum() + (picked - put) / DURATION_S
    return {"inventory_share_mean": used / pods["capacity"].sum()}


def decided(run) -> dict[str, float]:
    """Who decided, and what optimisers took."""
    decisions, controllers = run.table("decisions"), run.table("controllers")
    asked = decisions[decisions["source"] == "optimiser"]
    kinds = ("optimiser", "heuristic", "stale", "failed")
    total = sum(controllers[f"{kind}_decisions"].sum() for kind in kinds)
    return {
        "decisions": decisions["decisions"].sum(),
        "decision_wall_s": controllers["wall_s"].sum(),
        "optimiser_calls": len(asked),
        "optimiser_gap_mean": asked["gap"].mean(),
        "optimiser_gap_abs_mean": asked["gap_abs"].mean(),
        "paced_s": asked["paced_s"].sum(),
        "optimiser_failures": (asked["outcome"] == "failed").sum(),
        "optimiser_wall_s": asked["wall_s"].sum(),
        "optimiser_wall_median_s": asked["wall_s"].median(),
        **{
            f"{kind}_decision_share": controllers[f"{kind}_decisions"].sum() / total
            if total
            else np.nan
            for kind in kinds
        },
    }


def delayed(run, whole_s: float) -> dict[str, float]:
    """Shares of the orders' time: a line counts with the reciprocal of its order's lines."""
    lines = run.table("delays")
    weight = 1 / lines.groupby("order")["sku"].transform("size")
    parts = [name for name in lines if name.split("_")[0] in ("wait", "drive", "queue", "service")]
    return {
        f"{part.removesuffix('_s')}_share": (weight * lines[part]).sum() / whole_s for part in parts
    }


def served(orders) -> dict[str, float]:
    """Who was done in time, order by order; urgent orders have half an hour, others two hours."""
    told = {"urgent": [], "ordinary": []}
    for row in orders.itertuples():
        if row.completed_s == row.completed_s or row.due_s < END:
            offset_s = round(row.due_s - row.created_s, 5)
            kind = {1800.0: "urgent", 7200.0: "ordinary"}[offset_s]
            told[kind].append(row.completed_s <= row.due_s)
    late = sorted((orders["completed_s"] - orders["due_s"]).dropna())
    at = 0.95 * (len(late) - 1)
    below = int(at)
    waiting = orders[orders["completed_s"].isna()]
    return {
        "on_time_share": np.mean(told["urgent"] + told["ordinary"]),
        "on_time_urgent_share": np.mean(told["urgent"]),
        "on_time_ordinary_share": np.mean(told["ordinary"]),
        "on_time_weighted_share": np.mean(told["urgent"] + told["ordinary"]),  # all of weight 1
        "lateness_p95_s": late[below] + (at - below) * (late[below + 1] - late[below]),
        "lateness_max_s": late[-1],
        "orders_overdue_end": (waiting["due_s"] < END).sum(),
        "oldest_order_end_s": END - waiting["created_s"].min(),
    }


def recomputed(run) -> dict[str, float]:
    """Figures from `orders`, `trips` and `stations`, and where these say nothing from others."""
    orders, trips, stations = run.table("orders"), run.table("trips"), run.table("stations")
    bundles, robots = run.table("bundles"), run.table("robots")
    done = orders[orders["completed_s"].notna()]
    picks = stations[stations["kind"] == "pick"]
    others = stations[stations["kind"] != "pick"]
    hours = DURATION_S / 3600
    units, visits = picks["units_picked"].sum(), picks["visits"].sum()
    turnover = done["completed_s"] - done["created_s"]
    lateness = done["completed_s"] - done["due_s"]
    trip_s = trips["end_s"] - trips["start_s"]
    delay = (trip_s - trips["unhindered_s"])[trips["kind"] != "to_station"]
    stored = bundles[bundles["stored_s"].notna()]
    distance = robots["distance_m"].sum()
    return {
        **sizes(run),
        **inventory(run),
        **decided(run),
        **served(orders),
        "pods_lifted": robots["pods_lifted"].sum(),
        "robot_queueing_share": robots["queueing_s"].mean() / DURATION_S,
        "sim_per_wall": END / run.footprint["wall_s"],
        "orders_completed": len(done),
        "orders_created": (orders["created_s"] >= BEGIN).sum(),
        "lines_picked": picks["lines_picked"].sum(),
        "units_picked": units,
        "bundles_stored": len(stored),
        "units_stored": stored["units"].sum(),
        "bundles_created": (bundles["created_s"] >= BEGIN).sum(),
        "orders_per_h": len(done) / hours,
        "lines_per_h": picks["lines_picked"].sum() / hours,
        "units_per_h": units / hours,
        "bundles_per_h": len(stored) / hours,
        "units_per_h_at_pile_on": picks["units_per_h_at_pile_on"].sum(),
        "units_score": units / hours / run.footprint["units_per_h_bound"],
        "pick_visits": visits,
        "replenishment_visits": others["visits"].sum(),
        "units_per_visit": units / visits,
        "lines_per_visit": picks["lines_picked"].sum() / visits,
        "orders_per_visit": len(done) / visits,
        "late_bound_units_per_visit": picks["late_bound_units"].sum() / visits,
        "bundles_per_visit": len(stored) / others["visits"].sum(),
        "trips": len(trips),
        "trip_time_mean_s": trip_s.mean(),
        "trip_delay_mean_s": delay.mean(),
        "distance_m": distance,
        "distance_per_robot_m": distance / len(robots),
        "distance_per_unit_m": distance / units,
        "loaded_distance_m": robots["loaded_distance_m"].sum(),
        "pick_station_idle_share": 1 - picks["busy_s"].mean() / DURATION_S,
        "replenishment_station_idle_share": 1 - others["busy_s"].mean() / DURATION_S,
        "pick_station_active_share": picks["active_share"].mean(),
        "replenishment_station_active_share": others["active_share"].mean(),
        "robot_busy_share": sum(
            robots[f"task_{task}_s"].mean() for task in ("pick", "replenish", "park", "reposition")
        )
        / DURATION_S,
        **{
            f"robot_{state}_share": robots[f"{state}_s"].mean() / DURATION_S
            for state in ("moving", "turning", "waiting", "served", "transfer", "riding", "idle")
        },
        **{
            f"tasks_{task}": robots[f"tasks_{task}"].sum()
            for task in ("pick", "replenish", "park", "reposition", "rest")
        },
        **spread("order_turnover", turnover),
        **delayed(run, turnover.sum()),
        **spread("order_throughput_time", done["completed_s"] - done["assigned_s"]),
        **spread("order_lateness", lateness),
        **spread("late_by", lateness[lateness > 0]),
        **spread("bundle_turnover", stored["stored_s"] - stored["created_s"]),
        **spread("bundle_throughput_time", stored["stored_s"] - stored["assigned_s"]),
        "late_share": (lateness > 0).mean(),
        "orders_late": (lateness > 0).sum(),
        "backlog_orders_mean": level(orders["created_s"], orders["assigned_s"]),
        "backlog_orders_end": orders["assigned_s"].isna().sum(),
        "backlog_bundles_mean": level(bundles["created_s"], bundles["assigned_s"]),
        "backlog_bundles_end": bundles["assigned_s"].isna().sum(),
        "orders_cancelled": orders["cancelled_s"].notna().sum(),
        "orders_partial": (orders["units_cut"] > 0).sum(),
        "units_not_delivered": orders["units_cut"].sum(),
        "open_orders_mean": level(
            orders["assigned_s"].fillna(END), orders["completed_s"].fillna(END)
        ),
    }


def test_the_footprint_agrees_with_the_tables(run):
    footprint = run.footprint
    told = recomputed(run)
    numbers = {column.name for column in TABLES["footprint"] if column.dtype != TEXT}
    assert numbers == told.keys() | NOT_IN_TABLES.keys()
    assert not told.keys() & NOT_IN_TABLES.keys()
    wrong = {
        name: (value, footprint[name])
        for name, value in told.items()
        if footprint[name] != pytest.approx(value, rel=1e-9, abs=1e-9, nan_ok=True)
    }
    assert wrong == {}
    assert 0 < footprint["units_score"] <= 1


def test_tables_agree_with_each_other(run):
    picks, visits, bundles = run.table("picks"), run.table("visits"), run.table("bundles")
    stations, orders, trips = run.table("stations"), run.table("orders"), run.table("trips")
    connections = run.table("connections")
    by_station = picks.groupby("station").size()
    own = stations.set_index("station")
    assert (by_station == own["units_picked"].loc[by_station.index]).all()
    assert visits["units"].sum() == len(picks)
    assert visits["bundles"].sum() == bundles["stored_s"].notna().sum()
    complete = orders[orders["completed_s"].notna() & (orders["assigned_s"] >= BEGIN)]
    pods = picks.groupby("order")["pod"].nunique()
    assert (complete.set_index("order")["pods"] == pods.loc[complete["order"]]).all()
    assert (
        picks.groupby("order").size().loc[complete["order"]].to_numpy() == complete["units"]
    ).all()
    assert connections["trips"].sum() == len(trips)
    grouped = trips.assign(time_s=trips["end_s"] - trips["start_s"]).groupby(
        ["from_waypoint", "to_waypoint"]
    )["time_s"]
    wanted = connections.set_index(["from_waypoint", "to_waypoint"])
    assert grouped.mean().to_numpy() == pytest.approx(wanted["time_mean_s"].to_numpy())
    assert grouped.var(ddof=0).to_numpy() == pytest.approx(
        wanted["time_variance_s2"].to_numpy(), abs=1e-6
    )
    to_station = trips["kind"] == "to_station"
    assert (trips["station"][to_station] >= 0).all()
    assert (trips["station"][~to_station] == -1).all()
    assert set(connections[connections["to_kind"] == "pick"]["to_waypoint"]) <= set(
        stations[stations["kind"] == "pick"]["waypoint"]
    )


def test_heat_adds_up(run):
    heat, edges, robots = run.table("heat"), run.table("edges"), run.table("robots")
    tasks = ("pick", "replenish", "store", "rest")
    assert (sum(heat[f"{task}_visits"] for task in tasks) == heat["visits"]).all()
    waiting = sum(heat[f"{task}_waiting_s"] for task in tasks)
    assert waiting.to_numpy() == pytest.approx(heat["waiting_s"].to_numpy())
    # a waypoint is visited by driving an edge to it
    arrived = edges.groupby("to_waypoint")["passages"].sum()
    assert arrived.reindex(heat["waypoint"], fill_value=0).tolist() == heat["visits"].tolist()
    loaded = edges.groupby("to_waypoint")["loaded_passages"].sum()
    assert loaded.reindex(heat["waypoint"], fill_value=0).tolist() == heat["loaded_visits"].tolist()
    stood = robots["waiting_s"].sum() + robots["served_s"].sum()
    assert heat["waiting_s"].sum() == pytest.approx(stood, abs=1e-3)
    # nobody without a pod stands at a station, and every visitor of a head is bound for it
    stations = run.table("stations").set_index("waypoint")
    heads = heat.set_index("waypoint").loc[stations.index]
    picks = stations["kind"] == "pick"
    assert heads["waiting_s"].to_numpy() == pytest.approx(heads["loaded_waiting_s"].to_numpy())
    assert (heads["pick_visits"][picks] == heads["visits"][picks]).all()
    assert (heads["replenish_visits"][~picks] == heads["visits"][~picks]).all()


def test_controllers_agree_with_decisions(run):
    controllers = run.table("controllers").set_index("problem")
    decisions = run.table("decisions").groupby("problem")["decisions"].sum()
    assert (controllers["decisions"].loc[decisions.index] == decisions).all()
    assert controllers["decisions"].sum() == run.footprint["decisions"]
    assert controllers["wall_s"].sum() == pytest.approx(run.footprint["decision_wall_s"])
    assert (controllers["calls"] > 0).all()

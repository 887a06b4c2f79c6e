"""The data dictionary: every column a run writes, with its unit and its meaning.

The tables are brought into this order and these types before they are written (`tables.tidy`), and
the documentation page is generated from here, so nothing is written that is not described.

"The measured time" means the time after the warm-up, `duration_s` long. Unless a meaning says
otherwise, counts, means and rates cover the measured time only.
"""

from __future__ import annotations

from rmfs.measure.columns import COUNT_OR_EMPTY as COUNT_OR_EMPTY
from rmfs.measure.columns import FLAG as FLAG
from rmfs.measure.columns import INTEGER as INTEGER
from rmfs.measure.columns import REAL as REAL
from rmfs.measure.columns import TEXT as TEXT
from rmfs.measure.columns import Column as Column
from rmfs.measure.footprint_columns import FOOTPRINT as FOOTPRINT

SERIES = (
    Column("time_s", REAL, "s", "End of the interval, since the start of the run"),
    Column(
        "interval_s", REAL, "s", "Length of the interval: a minute, the last one may be shorter"
    ),
    Column("units_picked", INTEGER, "units", "Units picked in the interval"),
    Column("lines_picked", INTEGER, "lines", "Lines finished in the interval"),
    Column("orders_created", INTEGER, "orders", "Orders that arrived in the interval"),
    Column("orders_completed", INTEGER, "orders", "Orders completed in the interval"),
    Column("bundles_created", INTEGER, "bundles", "Bundles that arrived in the interval"),
    Column("bundles_stored", INTEGER, "bundles", "Bundles stored in the interval"),
    Column("distance_m", REAL, "m", "Distance driven in the interval"),
    Column("backlog_orders", INTEGER, "orders", "Orders that wait for a station, at the end"),
    Column("open_orders", INTEGER, "orders", "Orders open at stations, at the end"),
    Column(
        "backlog_bundles", INTEGER, "bundles", "Bundles not yet given pod and station, at the end"
    ),
    Column("inventory_share", REAL, "share", "Space used / capacity of all pods, at the end"),
    Column("pick_station_busy_share", REAL, "share", "Pick stations' time spent handling units"),
    Column(
        "replenishment_station_busy_share",
        REAL,
        "share",
        "Replenishment stations' time spent handling bundles",
    ),
    *(
        Column(f"robots_task_{task}", INTEGER, "robots", f"Robots with the task {task}, at the end")
        for task in ("pick", "replenish", "park", "reposition", "rest")
    ),
    *(
        Column(f"robots_{state}", REAL, "robots", f"Mean number of robots {what} in the interval")
        for state, what in {
            "moving": "driving",
            "turning": "turning",
            "waiting": "standing with a way to go",
            "served": "standing at a station",
            "transfer": "lifting or setting down",
            "riding": "in an elevator",
            "idle": "with nothing to do",
            "queueing": "in queue zones (overlaps with the others)",
        }.items()
    ),
)

STATIONS = (
    Column("station", INTEGER, "", "Number in the common numbering: pick stations come first"),
    Column("kind", TEXT, "", "pick or replenishment"),
    Column("waypoint", INTEGER, "", "Where the robot stands while its pod is served"),
    Column("tier", INTEGER, "", "Floor"),
    Column("x_m", REAL, "m", "Position"),
    Column("y_m", REAL, "m", "Position"),
    Column(
        "queue_places", INTEGER, "places", "Places in the queue, the one at the station included"
    ),
    Column("visits", INTEGER, "visits", "Stays of a pod in which something was handled"),
    Column("visit_time_mean_s", REAL, "s", "Mean length of the visits that ended"),
    Column("units_picked", INTEGER, "units", "Units picked"),
    Column("late_bound_units", INTEGER, "units", "Of these, bound after the robot got its task"),
    Column("lines_picked", INTEGER, "lines", "Lines finished"),
    Column("orders_completed", INTEGER, "orders", "Orders completed"),
    Column("bundles_stored", INTEGER, "bundles", "Bundles stored"),
    Column("busy_s", REAL, "s", "Time spent handling units or bundles"),
    Column("idle_share", REAL, "share", "1 - busy_s / duration"),
    Column("active_share", REAL, "share", "Time switched on / duration"),
    Column(
        "units_per_h_at_pile_on", REAL, "1/h", "See footprint; empty for replenishment stations"
    ),
    Column("units_per_visit", REAL, "units", "Pile-on: units_picked / visits"),
    Column("orders_per_visit", REAL, "orders", "orders_completed / visits"),
    Column("bundles_per_visit", REAL, "bundles", "bundles_stored / visits"),
    Column("order_slots", INTEGER, "orders", "Orders open at once; 0 for replenishment stations"),
    Column("capacity", REAL, "space units", "Bundles assigned at once; empty for pick stations"),
    Column(
        "without_work_share",
        REAL,
        "share",
        "Share of the time in which no order (bundle) was assigned to it",
    ),
)

ORDERS = (
    Column("order", INTEGER, "", "Ordinal of arrival, from the start of the run"),
    Column("station", INTEGER, "", "Pick station, -1 while waiting for one"),
    Column("lines", INTEGER, "lines", "Order lines"),
    Column("units", INTEGER, "units", "Units ordered"),
    Column("created_s", REAL, "s", "Arrival"),
    Column("due_s", REAL, "s", "Due time"),
    Column("assigned_s", REAL, "s", "Assignment to the station; empty if not yet"),
    Column("completed_s", REAL, "s", "Completion; empty if not yet"),
    Column("turnover_s", REAL, "s", "completed_s - created_s"),
    Column("throughput_time_s", REAL, "s", "completed_s - assigned_s"),
    Column("lateness_s", REAL, "s", "completed_s - due_s; negative if early"),
    Column("pods", INTEGER, "pods", "Pods from which units were picked for it so far"),
)

PICKS = (
    Column("time_s", REAL, "s", "When the unit left the pod"),
    Column("order", INTEGER, "", "Order, as in the table of orders"),
    Column("sku", INTEGER, "", "SKU"),
    Column("pod", INTEGER, "", "Pod"),
    Column("robot", INTEGER, "", "Robot that brought the pod"),
    Column("station", INTEGER, "", "Pick station"),
    Column("late_bound", FLAG, "", "Whether it was bound after the robot got its task"),
)

BUNDLES = (
    Column("sku", INTEGER, "", "SKU"),
    Column("units", INTEGER, "units", "Units"),
    Column("space", REAL, "space units", "Space they need together"),
    Column("created_s", REAL, "s", "Arrival"),
    Column("assigned_s", REAL, "s", "When pod and station were both decided; empty if not yet"),
    Column("stored_s", REAL, "s", "Storage; empty if not yet"),
    Column("pod", INTEGER, "", "Pod, -1 while undecided"),
    Column("station", INTEGER, "", "Replenishment station, -1 while undecided"),
    Column("robot", INTEGER, "", "Robot that brought the pod, -1 before"),
    Column("turnover_s", REAL, "s", "stored_s - created_s"),
    Column("throughput_time_s", REAL, "s", "stored_s - assigned_s"),
)

VISITS = (
    Column("station", INTEGER, "", "Station"),
    Column("pod", INTEGER, "", "Pod"),
    Column("robot", INTEGER, "", "Robot"),
    Column("begin_s", REAL, "s", "When the robot stood at the station; may lie in the warm-up"),
    Column("end_s", REAL, "s", "When it was told to leave; empty if not yet"),
    Column("units", INTEGER, "units", "Units picked in the measured time"),
    Column("bundles", INTEGER, "bundles", "Bundles stored in the measured time"),
)

TRIPS = (
    Column("robot", INTEGER, "", "Robot"),
    Column("kind", TEXT, "", "to_pod, to_station, to_storage or to_rest"),
    Column("from_waypoint", INTEGER, "", "Where it began"),
    Column("to_waypoint", INTEGER, "", "Where it led"),
    Column("start_s", REAL, "s", "When the robot was told to drive"),
    Column("end_s", REAL, "s", "Arrival (for a station: at its queue zone)"),
    Column("station", INTEGER, "", "Station it led to, -1 for another kind"),
    Column("loaded", FLAG, "", "Whether the robot carried a pod"),
    Column("distance_m", REAL, "m", "Distance driven"),
    Column(
        "unhindered_s",
        REAL,
        "s",
        "Lower bound of the time without other robots (for a station: to its queue zone)",
    ),
)

CONNECTIONS = (
    Column("from_waypoint", INTEGER, "", "Where trips began"),
    Column("to_waypoint", INTEGER, "", "Where they led"),
    Column("from_kind", TEXT, "", "pick, replenishment, storage, elevator, queue or road"),
    Column("to_kind", TEXT, "", "Likewise"),
    Column("trips", INTEGER, "trips", "Trips between the two, in this direction"),
    Column("time_mean_s", REAL, "s", "Mean trip time"),
    Column("time_variance_s2", REAL, "s²", "Population variance of the trip time"),
    Column("time_min_s", REAL, "s", "Shortest trip time"),
    Column("time_max_s", REAL, "s", "Longest trip time"),
    Column("distance_mean_m", REAL, "m", "Mean distance driven"),
)

EDGES = (
    Column("from_waypoint", INTEGER, "", "Where the edge begins"),
    Column("to_waypoint", INTEGER, "", "Where it ends"),
    Column("ride", FLAG, "", "Whether it is an elevator ride to another tier"),
    Column("passages", INTEGER, "passages", "Robots that drove it"),
    Column("loaded_passages", INTEGER, "passages", "Of these, with a pod"),
)

ROBOTS = (
    Column("robot", INTEGER, "", "Robot"),
    Column("kind", INTEGER, "", "Robot kind of the layout"),
    Column("distance_m", REAL, "m", "Distance driven"),
    Column("loaded_distance_m", REAL, "m", "Distance driven with a pod"),
    *(
        Column(f"{state}_s", REAL, "s", f"Time {what}")
        for state, what in {
            "moving": "driving",
            "turning": "turning on the spot",
            "waiting": "standing with a way to go",
            "served": "standing at a station",
            "transfer": "lifting or setting down",
            "riding": "in an elevator",
            "idle": "standing without anything to do",
            "queueing": "from a queue zone's border to its station (overlaps with the others)",
        }.items()
    ),
    *(
        column
        for task in ("pick", "replenish", "park", "reposition", "rest")
        for column in (
            Column(f"tasks_{task}", INTEGER, "tasks", f"Tasks {task} started"),
            Column(f"task_{task}_s", REAL, "s", f"Time with a task {task}"),
        )
    ),
    Column("pods_lifted", INTEGER, "lifts", "Pods lifted"),
    Column("units_picked", INTEGER, "units", "Units picked from pods it brought"),
    Column("bundles_stored", INTEGER, "bundles", "Bundles stored in pods it brought"),
)

PODS = (
    Column("pod", INTEGER, "", "Pod"),
    Column("capacity", REAL, "space units", "Capacity"),
    Column("used_end", REAL, "space units", "Space used by stored units at the end"),
    Column("waypoint_end", INTEGER, "", "Where it stands at the end; -1 if carried"),
    Column("lifts", INTEGER, "lifts", "How often it was lifted"),
    Column("pick_visits", INTEGER, "visits", "Visits to pick stations with units picked"),
    Column("replenishment_visits", INTEGER, "visits", "Visits with bundles stored"),
    Column("units_picked", INTEGER, "units", "Units picked from it"),
    Column("bundles_stored", INTEGER, "bundles", "Bundles stored in it"),
)

SKUS = (
    Column("sku", INTEGER, "", "SKU"),
    Column("popularity", REAL, "", "Weight in the scenario"),
    Column("space", REAL, "space units", "Space of one unit"),
    Column("lines_picked", INTEGER, "lines", "Order lines finished"),
    Column("units_picked", INTEGER, "units", "Units picked"),
    Column("bundles_stored", INTEGER, "bundles", "Bundles stored"),
    Column("units_end", INTEGER, "units", "Units on pods at the end"),
    Column("pods_end", INTEGER, "pods", "Pods that hold it at the end"),
)

_PURPOSES = {
    "pick": "bound for a pick station (fetching its pod included), or at one",
    "replenish": "bound for a replenishment station (fetching its pod included), or at one",
    "store": "otherwise carrying a pod or fetching one",
    "rest": "without a pod to care for",
}

HEAT = (
    Column("waypoint", INTEGER, "", "Waypoint"),
    Column("tier", INTEGER, "", "Floor"),
    Column("x_m", REAL, "m", "Position"),
    Column("y_m", REAL, "m", "Position"),
    Column("visits", INTEGER, "visits", "Robots that passed or stopped"),
    Column("loaded_visits", INTEGER, "visits", "Robots that passed or stopped with a pod"),
    *(
        Column(f"{task}_visits", INTEGER, "visits", f"Robots that passed or stopped, {what}")
        for task, what in _PURPOSES.items()
    ),
    Column("waiting_s", REAL, "s", "Time that robots stood here, idle ones not counted"),
    Column("loaded_waiting_s", REAL, "s", "Time that robots stood here with a pod"),
    *(
        Column(f"{task}_waiting_s", REAL, "s", f"Time that robots stood here, {what}")
        for task, what in _PURPOSES.items()
    ),
)

DECISIONS = (
    Column(
        "time_s",
        REAL,
        "s",
        "When a controller was asked that came to a decision, or when it asked an optimiser, since "
        "the start of the run",
    ),
    Column("problem", TEXT, "", "Decision problem: roa, poa, rps, pps, psa, ta, sa, mm"),
    Column(
        "source",
        TEXT,
        "",
        "rule: one call of a controller, with the decisions it took by itself; optimiser: one "
        "question to an optimiser, with the decisions based on the answer. What follows after "
        "`wall_s` is empty for rules",
    ),
    Column("decisions", INTEGER, "decisions", "Decisions given; for optimisers applied + fallback"),
    Column("wall_s", REAL, "s", "Wall time it took", measured=True),
    Column("call", COUNT_OR_EMPTY, "", "Number of the question, from the start of the run"),
    Column("sizes", TEXT, "", "How large the question was"),
    Column("outcome", TEXT, "", "solution, nothing, failed, abandoned, or waiting at the end"),
    Column("failure", TEXT, "", "Why it failed"),
    Column("completed_s", REAL, "s", "When the answer took effect"),
    Column("paced_s", REAL, "s", "completed_s - time_s"),
    Column("backend", TEXT, "", "Who solved it"),
    Column("status", TEXT, "", "How the solver ended: optimal, feasible, infeasible, limit"),
    Column("objective", REAL, "", "Value of the solution, in the model's own unit"),
    Column("bound", REAL, "", "What is proven about the best value"),
    Column("gap", REAL, "share", "abs(objective - bound) / abs(objective)"),
    Column("work", REAL, "", "Deterministic work, in the unit of the back end"),
    Column("build_s", REAL, "s", "Wall time in which the solver's model was built", measured=True),
    Column("solve_s", REAL, "s", "Wall time of the solver without that", measured=True),
    Column("applied", COUNT_OR_EMPTY, "decisions", "Decisions of the solution that were applied"),
    Column("stale", COUNT_OR_EMPTY, "decisions", "Decisions of it that no longer held"),
    Column(
        "fallback",
        COUNT_OR_EMPTY,
        "decisions",
        "Decisions by the controller's rule because there was no solution",
    ),
)

ANSWERS = (
    Column("call", INTEGER, "", "Number of the question, from the start of the run"),
    Column("problem", TEXT, "", "Decision problem of the controller that asked"),
    Column("state", TEXT, "", "Hash of the question and of the state it was asked in"),
    Column("requested_us", INTEGER, "µs", "Simulated time at which it was asked"),
    Column("completed_us", INTEGER, "µs", "Simulated time at which it took effect; -1: not yet"),
    Column("outcome", TEXT, "", "As in `decisions`"),
    Column("failure", TEXT, "", "Why it failed"),
    Column("backend", TEXT, "", "Who solved it; empty without an answer"),
    Column("status", TEXT, "", "How the solver ended; empty without an answer"),
    Column("objective", REAL, "", "Value of the solution"),
    Column("bound", REAL, "", "What is proven about the best value"),
    Column("work", REAL, "", "Deterministic work, in the unit of the back end"),
    Column("wall_s", REAL, "s", "Wall time of solver and building", measured=True),
    Column("build_s", REAL, "s", "Wall time of building", measured=True),
    Column("solution", TEXT, "", "The solution as JSON; empty without one"),
)

CONTROLLERS = (
    Column("problem", TEXT, "", "Decision problem"),
    Column("calls", INTEGER, "calls", "How often its controller was asked"),
    Column("decisions", INTEGER, "decisions", "Decisions given"),
    Column("wall_s", REAL, "s", "Wall time of all calls", measured=True),
    Column("wall_mean_s", REAL, "s", "Mean wall time of a call", measured=True),
    Column("optimiser_calls", INTEGER, "calls", "Questions it handed to an optimiser"),
    Column(
        "optimiser_decisions", INTEGER, "decisions", "Decisions it took by solutions of optimisers"
    ),
    Column(
        "heuristic_decisions",
        INTEGER,
        "decisions",
        "Decisions it took by its own rule; 0 for a controller that never asks optimisers",
    ),
    Column("stale_decisions", INTEGER, "decisions", "Decisions of solutions that no longer held"),
    Column(
        "failed_decisions",
        INTEGER,
        "decisions",
        "Decisions by its own rule because an optimiser failed or found nothing",
    ),
)

TABLES = {
    "footprint": FOOTPRINT,
    "series": SERIES,
    "stations": STATIONS,
    "orders": ORDERS,
    "picks": PICKS,
    "bundles": BUNDLES,
    "visits": VISITS,
    "trips": TRIPS,
    "connections": CONNECTIONS,
    "robots": ROBOTS,
    "pods": PODS,
    "skus": SKUS,
    "heat": HEAT,
    "edges": EDGES,
    "decisions": DECISIONS,
    "answers": ANSWERS,
    "controllers": CONTROLLERS,
}
"""Every table of a run folder, by the name of its file."""


def names(table: str) -> list[str]:
    """Names of a table's columns, in order."""
    return [column.name for column in TABLES[table]]


def reproducible(table: str) -> list[str]:
    """Names of the columns that are the same whenever the same run is repeated."""
    return [column.name for column in TABLES[table] if not column.measured]


def markdown() -> str:
    """Return the dictionary as a page: one section per table."""
    lines = [
        "# Data dictionary",
        "",
        "Every table of a run folder (`NAME.parquet`) and every column of it. Generated by",
        "`rmfs docs`. The *measured time* is the time after the warm-up;",
        "counts, means and rates cover it only unless a meaning says otherwise. A *measured*",
        "column depends on machine and moment, a *reproducible* one does not.",
        "",
    ]
    for table, columns in TABLES.items():
        lines += [f"## {table}", "", "| Column | Unit | Repeats | Meaning |", "|---|---|---|---|"]
        for column in columns:
            repeats = "measured" if column.measured else "reproducible"
            lines.append(f"| `{column.name}` | {column.unit} | {repeats} | {column.meaning} |")
        lines.append("")
    return "\n".join(lines)

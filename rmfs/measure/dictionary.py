"""The data dictionary: every column a run writes, with its unit and its meaning.

The tables are brought into this order and these types before they are written (`tables.tidy`), and
the documentation page is generated from here, so nothing is written that is not described.

"The measured time" means the time after the warm-up, `duration_s` long. Unless a meaning says
otherwise, counts, means and rates cover the measured time only.
"""

from __future__ import annotations

from dataclasses import dataclass

INTEGER = "int64"
COUNT_OR_EMPTY = "Int64"
REAL = "float64"
TEXT = "str"
FLAG = "bool"


@dataclass(frozen=True, slots=True)
class Column:
    """One column of a table.

    Attributes
    ----------
    name
        Ends with the unit where there is one: `_s`, `_m`, `_h` (per hour), `_share` (0 to 1).
    dtype
        The pandas type it is written in.
    unit
        Unit in words, or empty for names and identifiers.
    meaning
        Definition; empty cells are explained where they can occur.
    measured
        Whether it depends on the machine and the moment, and so does not repeat.
    """

    name: str
    dtype: str
    unit: str
    meaning: str
    measured: bool = False


def _shares_of_robots() -> tuple[Column, ...]:
    told = {
        "waiting": "standing with a way to go, or in a queue",
        "turning": "turning on the spot",
        "served": "standing at a station",
        "transfer": "lifting or setting down a pod",
        "riding": "in an elevator",
        "idle": "standing without anything to do",
    }
    return tuple(
        Column(f"robot_{name}_share", REAL, "share", f"Robot time {what}")
        for name, what in told.items()
    )


FOOTPRINT = (
    Column("layout", TEXT, "", "Name of the layout"),
    Column("scenario", TEXT, "", "Name of the scenario"),
    Column("controllers", TEXT, "", "Name of the set of controllers"),
    Column("seed", INTEGER, "", "Seed of all random streams of the run"),
    Column("warmup_s", REAL, "s", "Simulated time before the measured time"),
    Column("duration_s", REAL, "s", "Measured time"),
    Column("tiers", INTEGER, "tiers", "Floors of the layout"),
    Column("robots", INTEGER, "robots", "Robots"),
    Column("pods", INTEGER, "pods", "Pods"),
    Column("pick_stations", INTEGER, "stations", "Pick stations"),
    Column("replenishment_stations", INTEGER, "stations", "Replenishment stations"),
    Column("skus", INTEGER, "SKUs", "SKUs of the scenario"),
    Column("orders_completed", INTEGER, "orders", "Pick orders whose last unit was picked"),
    Column("lines_picked", INTEGER, "lines", "Order lines whose last unit was picked"),
    Column("units_picked", INTEGER, "units", "Units picked from pods into orders"),
    Column("bundles_stored", INTEGER, "bundles", "Replenishment bundles put into pods"),
    Column("orders_per_h", REAL, "1/h", "orders_completed / duration"),
    Column("lines_per_h", REAL, "1/h", "lines_picked / duration"),
    Column("units_per_h", REAL, "1/h", "units_picked / duration"),
    Column("bundles_per_h", REAL, "1/h", "bundles_stored / duration"),
    Column(
        "units_per_h_bound",
        REAL,
        "1/h",
        "What the pick stations could pick at most, never waiting for a pod: sum over stations of "
        "3600 / max(unit_transfer_s, unit_pick_s)",
    ),
    Column("units_score", REAL, "share", "units_per_h / units_per_h_bound"),
    Column(
        "pick_visits",
        INTEGER,
        "visits",
        "Stays of a pod at a pick station in which at least one unit was picked; a pod that keeps "
        "its place for further requests makes one visit",
    ),
    Column("units_per_visit", REAL, "units", "Pile-on: units_picked / pick_visits"),
    Column("lines_per_visit", REAL, "lines", "lines_picked / pick_visits"),
    Column("orders_per_visit", REAL, "orders", "orders_completed / pick_visits"),
    Column("bundles_per_visit", REAL, "bundles", "bundles_stored / replenishment_visits"),
    Column("distance_m", REAL, "m", "Distance driven by all robots"),
    Column("distance_per_robot_m", REAL, "m", "distance_m / robots"),
    Column("distance_per_unit_m", REAL, "m", "distance_m / units_picked"),
    Column(
        "trips",
        INTEGER,
        "trips",
        "Trips that ended: to a pod, to a station (ending at its queue zone), to a storage place, "
        "or to a resting place",
    ),
    Column("trip_time_mean_s", REAL, "s", "Mean time from the start to the end of a trip"),
    Column(
        "pick_station_idle_share",
        REAL,
        "share",
        "1 - time in which the stations handle a unit / (pick stations x duration)",
    ),
    Column(
        "replenishment_station_idle_share",
        REAL,
        "share",
        "1 - time in which the stations handle a bundle / (replenishment stations x duration)",
    ),
    Column(
        "robot_busy_share",
        REAL,
        "share",
        "Robot time with a task other than resting (pick, replenish, park, reposition)",
    ),
    Column("robot_moving_share", REAL, "share", "Robot time driving"),
    Column(
        "robot_queueing_share",
        REAL,
        "share",
        "Robot time from entering a station's queue zone to standing at the station; overlaps with "
        "the other shares",
    ),
    Column("order_turnover_mean_s", REAL, "s", "Mean time from arrival to completion of an order"),
    Column("order_turnover_median_s", REAL, "s", "Median of the same"),
    Column(
        "order_throughput_time_median_s",
        REAL,
        "s",
        "Median time from an order's assignment to a station to its completion",
    ),
    Column(
        "late_share", REAL, "share", "Completed orders that were completed after their due time"
    ),
    Column(
        "backlog_orders_mean",
        REAL,
        "orders",
        "Time average of the number of orders that wait for a station",
    ),
    Column(
        "inventory_share_mean",
        REAL,
        "share",
        "Time average of the space that stored units use / capacity of all pods",
    ),
    Column("plans", INTEGER, "plans", "Paths planned and accepted"),
    Column("plan_failures", INTEGER, "plans", "Searches that found no path yet"),
    Column("replans", INTEGER, "plans", "Paths changed before they were driven to the end"),
    Column(
        "collisions",
        COUNT_OR_EMPTY,
        "events",
        "Overlaps of two bodies found by the independent trace checker, warm-up included; empty "
        "where it did not run",
    ),
    Column("decisions", INTEGER, "decisions", "Decisions given by all controllers"),
    Column(
        "decision_wall_s",
        REAL,
        "s",
        "Wall time spent in controllers, also where they came to no decision",
        measured=True,
    ),
    Column("optimiser_calls", INTEGER, "calls", "Decision problems handed to an optimiser"),
    Column(
        "optimiser_gap_mean",
        REAL,
        "share",
        "Mean relative gap between value and bound of the optimisers' solutions; empty without",
    ),
    Column("paced_s", REAL, "s", "Simulated time that decisions took (see pacing)"),
    Column(
        "wall_s", REAL, "s", "Wall time of the whole simulation, loading excluded", measured=True
    ),
    Column("sim_per_wall", REAL, "s/s", "(warmup_s + duration_s) / wall_s", measured=True),
    Column("peak_rss_mb", REAL, "MB", "Largest memory the process has used", measured=True),
    # from here on: further columns, in no promised order
    Column("orders_created", INTEGER, "orders", "Orders that arrived"),
    Column("order_redraws", INTEGER, "draws", "Drawn orders that the stock could not serve"),
    Column("backlog_orders_end", INTEGER, "orders", "Orders that wait for a station at the end"),
    Column("open_orders_mean", REAL, "orders", "Time average of the orders open at stations"),
    Column("bundles_created", INTEGER, "bundles", "Bundles that arrived"),
    Column("units_stored", INTEGER, "units", "Units in the stored bundles"),
    Column(
        "replenishment_visits",
        INTEGER,
        "visits",
        "Stays of a pod at a replenishment station in which at least one bundle was stored",
    ),
    Column(
        "late_bound_units_per_visit",
        REAL,
        "units",
        "Units picked that were bound to the pod after its robot had got the task / pick_visits",
    ),
    Column("order_turnover_lower_quartile_s", REAL, "s", "First quartile of order turnover"),
    Column("order_turnover_upper_quartile_s", REAL, "s", "Third quartile of order turnover"),
    Column("order_throughput_time_mean_s", REAL, "s", "Mean time from assignment to completion"),
    Column("bundle_turnover_mean_s", REAL, "s", "Mean time from a bundle's arrival to its storage"),
    Column("bundle_turnover_median_s", REAL, "s", "Median of the same"),
    Column("pods_lifted", INTEGER, "lifts", "Pods lifted"),
    Column("loaded_distance_m", REAL, "m", "Distance driven with a pod"),
    Column(
        "trip_delay_mean_s",
        REAL,
        "s",
        "Mean of trip time less a lower bound of the time the trip takes without other robots; "
        "trips to stations are left out, as they end at the queue zone",
    ),
    *_shares_of_robots(),
    Column("expansions", INTEGER, "labels", "Labels expanded by the path planner"),
    Column("planning_wall_s", REAL, "s", "Wall time spent in path planning", measured=True),
)

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
    Column("units_per_h_bound", REAL, "1/h", "See footprint; empty for replenishment stations"),
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
)

TRIPS = (
    Column("robot", INTEGER, "", "Robot"),
    Column("kind", TEXT, "", "to_pod, to_station, to_storage or to_rest"),
    Column("from_waypoint", INTEGER, "", "Where it began"),
    Column("to_waypoint", INTEGER, "", "Where it led"),
    Column("start_s", REAL, "s", "When the robot was told to drive"),
    Column("end_s", REAL, "s", "Arrival (for a station: at its queue zone)"),
    Column("loaded", FLAG, "", "Whether the robot carried a pod"),
    Column("distance_m", REAL, "m", "Distance driven"),
    Column(
        "unhindered_s",
        REAL,
        "s",
        "Lower bound of the time without other robots (for a station: to the place in its queue)",
    ),
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

HEAT = (
    Column("waypoint", INTEGER, "", "Waypoint"),
    Column("tier", INTEGER, "", "Floor"),
    Column("x_m", REAL, "m", "Position"),
    Column("y_m", REAL, "m", "Position"),
    Column("visits", INTEGER, "visits", "Robots that passed or stopped"),
    Column("loaded_visits", INTEGER, "visits", "Of these, with a pod"),
    Column("waiting_s", REAL, "s", "Time that robots stood here, idle ones not counted"),
)

DECISIONS = (
    Column(
        "time_s",
        REAL,
        "s",
        "When a controller was asked that came to a decision, since the start of the run",
    ),
    Column("problem", TEXT, "", "Decision problem: roa, poa, rps, pps, psa, ta, sa, mm"),
    Column("decisions", INTEGER, "decisions", "Decisions given"),
    Column("wall_s", REAL, "s", "Wall time it took", measured=True),
)

TABLES = {
    "footprint": FOOTPRINT,
    "series": SERIES,
    "stations": STATIONS,
    "orders": ORDERS,
    "trips": TRIPS,
    "robots": ROBOTS,
    "pods": PODS,
    "skus": SKUS,
    "heat": HEAT,
    "decisions": DECISIONS,
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
    lines: list[str] = []
    for table, columns in TABLES.items():
        lines += [f"## {table}", "", "| Column | Unit | Repeats | Meaning |", "|---|---|---|---|"]
        for column in columns:
            repeats = "measured" if column.measured else "reproducible"
            lines.append(f"| `{column.name}` | {column.unit} | {repeats} | {column.meaning} |")
        lines.append("")
    return "\n".join(lines)

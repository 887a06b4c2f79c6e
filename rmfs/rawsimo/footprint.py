"""RAWSim-O's footprint columns and files, and their counterparts in rmfs.

Text in backticks is a column of the footprint, or `table.column` of another table; the rest is
prose. Columns that RAWSim-O computes incorrectly are computed correctly here; for columns that rmfs
omits, the reason is given.
"""

from __future__ import annotations

from typing import NamedTuple


class Mapped(NamedTuple):
    """A column or a file of RAWSim-O.

    Attributes
    ----------
    theirs
        Its name in RAWSim-O.
    ours
        Its counterpart in rmfs, or the reason why there is none.
    """

    theirs: str
    ours: str


_SPREAD = ("Avg", "Med", "LQ", "UQ")
_NAMES = {"Avg": "mean", "Med": "median", "LQ": "lower_quartile", "UQ": "upper_quartile"}
_RULE = "name and parameters of the rule in run.json: controllers.parameters.{}"


def _spread(theirs: str, ours: str) -> list[Mapped]:
    """Map four columns to four of the footprint, which interpolate quartiles."""
    return [Mapped(theirs + end, f"`{ours}_{_NAMES[end]}_s`") for end in _SPREAD]


def _over_stations(theirs: str, ours: str, mean: str | None, note: str = "") -> list[Mapped]:
    """Map four columns that summarise stations to the column of our table of stations."""
    own = f"`stations.{ours}`{note}"
    first = f"`{mean}` or the mean of {own}" if mean else f"mean of {own}"
    words = {"Avg": first, "Med": f"median of {own}"}
    words |= {"LQ": f"first quartile of {own}", "UQ": f"third quartile of {own}"}
    return [Mapped(theirs + end, words[end]) for end in _SPREAD]


def _names() -> list[Mapped]:
    rules = {
        "PP": "pp",
        "TA": "ta (and pps, part of it there)",
        "SA": "sa",
        "IS": "rps",
        "PS": "psa",
        "RP": "repositioning",
        "OB": "poa",
        "RB": "roa",
        "MM": "mm",
    }
    return [
        Mapped("Instance", "`layout`"),
        Mapped("Setting", "`scenario`"),
        Mapped("Controller", "`controllers`"),
        Mapped("Tag", "none: run folders are named freely, and designs name their arms"),
        *(Mapped(theirs, _RULE.format(ours)) for theirs, ours in rules.items()),
    ]


def _size() -> list[Mapped]:
    return [
        Mapped("Warmup", "`warmup_s`"),
        Mapped("Duration", "`duration_s`"),
        Mapped("NTiers", "`tiers`"),
        Mapped("NBots", "`robots`"),
        Mapped("NPods", "`pods`"),
        Mapped("NIStations", "`replenishment_stations`"),
        Mapped("NOStations", "`pick_stations`"),
        Mapped("BotsPerStation", "`robots` / (`pick_stations` + `replenishment_stations`)"),
        Mapped("BotsPerISTation", "`robots` / `replenishment_stations`"),
        Mapped("BotsPerOStation", "`robots` / `pick_stations`"),
        Mapped("IStationCapacityAvg", "mean of `stations.capacity`"),
        Mapped("OStationCapacityAvg", "mean of `stations.order_slots` of the pick stations"),
        Mapped("SKUs", "`skus`"),
    ]


def _counts() -> list[Mapped]:
    rejected = "none: the supply does not report refused arrivals; see `order_redraws`"
    return [
        Mapped("BundlesPlaced", "`bundles_created`"),
        Mapped("OrdersPlaced", "`orders_created`"),
        Mapped("BundlesRejected", rejected),
        Mapped("OrdersRejected", rejected),
        Mapped("BundlesInBacklogRemaining", "`backlog_bundles_end`"),
        Mapped("OrdersInBacklogRemaining", "`backlog_orders_end`"),
        Mapped(
            "BundlesInBacklogAvg", "`backlog_bundles_mean`, over the whole time (theirs forgets)"
        ),
        Mapped("OrdersInBacklogAvg", "`backlog_orders_mean`, over the whole time (theirs forgets)"),
        Mapped("BundlesHandled", "`bundles_stored`"),
        Mapped("ItemsHandled", "`units_picked`"),
        Mapped("LinesHandled", "`lines_picked`"),
        Mapped("OrdersHandled", "`orders_completed`"),
        Mapped("UnitsHandled", "`units_picked` + `bundles_stored`"),
        Mapped("Collisions", "`collisions`, proven by the checker of the trace"),
        Mapped("FailedReservations", "`plan_failures`: nothing is reserved piece by piece"),
        Mapped("PathPlanningTimeouts", "none: planning is limited by work, never by the clock"),
        Mapped("PathPlanningTimeoutFractional", "none, likewise"),
    ]


def _motion() -> list[Mapped]:
    optimal = "none in metres; `trips.unhindered_s` bounds the time of each trip from below"
    prose = "of the trips whose `trips.station` is of that kind"
    return [
        Mapped("DistanceTraveled", "`distance_m`"),
        Mapped("DistanceTraveledPerBot", "`distance_per_robot_m`"),
        Mapped("DistanceEstimated", optimal),
        Mapped("DistanceRequestedOptimal", optimal),
        Mapped("TimeMoving", "mean of `robots.moving_s`; `robot_moving_share`"),
        Mapped("TimeQueueing", "mean of `robots.queueing_s`; `robot_queueing_share`"),
        Mapped("TripDistance", "`distance_m` / `trips`"),
        Mapped("TripTime", "`trip_time_mean_s` + sum of `robots.queueing_s` / `trips`"),
        Mapped("TripTimeWithoutQueueing", "`trip_time_mean_s`: ours end at the queue zone"),
        Mapped("TripCount", "`trips`: legs of tasks, not moves between waypoints"),
        Mapped("LastMileTripOStationCount", f"number {prose}"),
        Mapped("LastMileTripOStationTimeAvg", f"mean of `trips.end_s` - `trips.start_s` {prose}"),
        Mapped("LastMileTripIStationCount", f"number {prose}"),
        Mapped("LastMileTripIStationTimeAvg", f"mean of `trips.end_s` - `trips.start_s` {prose}"),
        Mapped(
            "OverallAssignedTasks",
            "`tasks_pick` + `tasks_replenish` + `tasks_park` + `tasks_reposition` + `tasks_rest`",
        ),
    ]


def _visits() -> list[Mapped]:
    both = "(`pick_visits` + `replenishment_visits`)"
    return [
        Mapped("OverallPodsHandledAtIStations", "`replenishment_visits`"),
        Mapped("OverallPodsHandledAtOStations", "`pick_visits`"),
        Mapped("PodsHandledAtIStationsFractional", f"`replenishment_visits` / {both}"),
        Mapped("PodsHandledAtOStationsFractional", f"`pick_visits` / {both}"),
        Mapped(
            "PodsHandledPerIStationPerHour",
            "`replenishment_visits` / `replenishment_stations` / `duration_s` * 3600",
        ),
        Mapped(
            "PodsHandledPerOStationPerHour", "`pick_visits` / `pick_stations` / `duration_s` * 3600"
        ),
        Mapped("RepositioningMoves", "`tasks_reposition`"),
        Mapped("PodsHandledPerIStationAvg", "mean of `stations.visits`, replenishment stations"),
        Mapped("PodsHandledPerIStationVar", "its population variance"),
        Mapped(
            "PodsHandledPerOStationAvg",
            "mean of `stations.visits`, pick stations (theirs averages the other kind)",
        ),
        Mapped("PodsHandledPerOStationVar", "its population variance"),
    ]


def _stock() -> list[Mapped]:
    ranks = "none: how well pods are sorted by rank is not measured; see `pods.pick_visits` with "
    ranks += "`pods.waypoint_end`"
    kinds = [f"Inv{s}{e}" for s in ("Combined", "Speed", "Utility") for e in _INVERSIONS]
    stops = "none: see the pauses in `series.orders_created` and `series.bundles_created`"
    return [
        Mapped("InventoryLevelAvg", "`inventory_share_mean`, exact over time"),
        Mapped("InventoryLevelLQ", "first quartile of `series.inventory_share`"),
        Mapped("InventoryLevelUQ", "third quartile of `series.inventory_share`"),
        Mapped("StorageLocationRanks", ranks),
        *(Mapped(name, ranks) for name in kinds),
        Mapped("BundleGenerationStops", stops),
        Mapped("OrderGenerationStops", stops),
        Mapped("MemoryUsedMax", "`peak_rss_mb`"),
        Mapped("RealTimeUsed", "`wall_s`"),
    ]


_INVERSIONS = ("Total", "Rank", "AvgRank")


def _rates() -> list[Mapped]:
    return [
        Mapped("BundleThroughputRate", "`bundles_per_h`"),
        Mapped("ItemThroughputRate", "`units_per_h`"),
        Mapped(
            "ItemThroughputRateUB",
            "`units_per_h_at_pile_on`, which is no bound",
        ),
        Mapped("ItemThroughputRateScore", "`units_per_h` / `units_per_h_at_pile_on`"),
        Mapped("LineThroughputRate", "`lines_per_h`"),
        Mapped("OrderThroughputRate", "`orders_per_h`"),
    ]


def _times() -> list[Mapped]:
    return [
        *_spread("OrderTurnoverTime", "order_turnover"),
        *_spread("OrderThroughputTime", "order_throughput_time"),
        *_spread("BundleTurnoverTime", "bundle_turnover"),
        *_spread("BundleThroughputTime", "bundle_throughput_time"),
        *_spread("OrderLateness", "late_by"),
        *_spread("OrderOffset", "order_lateness"),
        Mapped("LateOrdersCount", "`orders_late`"),
        Mapped("OnTimeOrdersCount", "`orders_completed` - `orders_late`"),
        Mapped("LateOrdersFractional", "`late_share`"),
        Mapped("LateOrdersRate", "`orders_late` / `duration_s` * 3600"),
        Mapped("OnTimeOrdersRate", "(`orders_completed` - `orders_late`) / `duration_s` * 3600"),
    ]


def _stations() -> list[Mapped]:
    ours = "`late_bound_units_per_visit` is that of all visits"
    late = "`stations.late_bound_units` / `stations.visits`"
    words = {"Avg": "mean", "Med": "median", "LQ": "first quartile", "UQ": "third quartile"}
    bundled = "none: bundles added to a task on its way are not distinguished"
    pick, replenish = ", pick stations", ", replenishment stations"
    down = " (any time without work: there is no threshold)"
    return [
        *_over_stations("ItemPileOne", "units_per_visit", "units_per_visit"),
        *(
            Mapped(f"InjectedItemPileOne{end}", f"{words[end]} of {late}; {ours}")
            for end in _SPREAD
        ),
        *_over_stations("OrderPileOne", "orders_per_visit", "orders_per_visit"),
        *_over_stations("BundlePileOne", "bundles_per_visit", "bundles_per_visit"),
        *(Mapped(f"InjectedBundlePileOne{end}", bundled) for end in _SPREAD),
        *_over_stations("OSIdleTime", "idle_share", "pick_station_idle_share", pick),
        *_over_stations("ISIdleTime", "idle_share", "replenishment_station_idle_share", replenish),
        *_over_stations("OSUpTime", "active_share", "pick_station_active_share", pick),
        *_over_stations(
            "ISUpTime", "active_share", "replenishment_station_active_share", replenish
        ),
        *_over_stations("OSDownTime", "without_work_share", None, pick + down),
        *_over_stations("ISDownTime", "without_work_share", None, replenish + down),
    ]


def _tasks() -> list[Mapped]:
    kinds = {
        "ParkPod": "park",
        "RepositionPod": "reposition",
        "Insert": "replenish",
        "Extract": "pick",
        "Rest": "rest",
    }
    pairs = [
        (
            Mapped(f"TaskCount{t}", f"`tasks_{o}`"),
            Mapped(f"TaskTime{t}", f"sum of `robots.task_{o}_s`"),
        )
        for t, o in kinds.items()
    ]
    return [
        Mapped("TaskCountNone", "none: only tasks are counted"),
        Mapped("TaskTimeNone", "`robots` * `duration_s` less the times of all tasks"),
        *(one for pair in pairs for one in pair),
        Mapped("TaskTimeBusyAvg", "`robot_busy_share` * `duration_s`"),
        Mapped("TaskTimeBusyAvgFractional", "`robot_busy_share`"),
    ]


def _states() -> list[Mapped]:
    transfer = "sum of `robots.transfer_s`, lifting and setting down together"
    served = "visits' length: `visits.end_s` - `visits.begin_s` at {} stations"
    return [
        Mapped("StateCountPickup", "`pods_lifted`"),
        Mapped("StateTimePickup", transfer),
        Mapped("StateCountSetdown", "`tasks_park` + `tasks_reposition`, but for those under way"),
        Mapped("StateTimeSetdown", transfer),
        Mapped("StateCountGet", "`bundles_stored` in `replenishment_visits`"),
        Mapped("StateTimeGet", served.format("replenishment")),
        Mapped("StateCountPut", "`units_picked` in `pick_visits`"),
        Mapped("StateTimePut", served.format("pick")),
        Mapped("StateCountRest", "`tasks_rest`"),
        Mapped("StateTimeRest", "sum of `robots.idle_s`"),
        Mapped("StateCountMove", "`plans`"),
        Mapped(
            "StateTimeMove", "sum of `robots.moving_s` + `robots.turning_s` + `robots.waiting_s`"
        ),
        Mapped("StateCountEvade", "none: no robot evades another"),
        Mapped("StateTimeEvade", "none, likewise"),
        Mapped("StateCountElevator", "sum of `edges.passages` where `edges.ride`"),
        Mapped("StateTimeElevator", "sum of `robots.riding_s`"),
    ]


def _timings() -> list[Mapped]:
    problems = {
        "TaskAllocation": "ta",
        "ItemStorage": "rps",
        "PodStorage": "psa",
        "Repositioning": "repositioning (theirs repeats pod storage)",
        "ReplenishmentBatching": "roa",
        "OrderBatching": "poa",
    }
    columns = {"Avg": "wall_mean_s", "Overall": "wall_s", "Count": "calls"}
    return [
        Mapped("TimingDecisionsOverall", "`decision_wall_s` + `planning_wall_s`"),
        Mapped(
            "TimingPathPlanningAvg", "`planning_wall_s` / (`plans` + `plan_failures` + `replans`)"
        ),
        Mapped("TimingPathPlanningOverall", "`planning_wall_s`"),
        Mapped("TimingPathPlanningCount", "`plans` + `plan_failures` + `replans`"),
        *(
            Mapped(f"Timing{theirs}{end}", f"`controllers.{column}` of {ours}")
            for theirs, ours in problems.items()
            for end, column in columns.items()
        ),
    ]


def _free() -> list[Mapped]:
    own = "none: a controller or an observer keeps its own figures (rmfs.measure.Observer)"
    problems = ("PP", "TA", "PC", "SA", "IS", "PS", "RP", "OB", "RB", "MM")
    tags = "none: name and description of the file are in run.json"
    return [
        *(Mapped(f"CustomLog{p}{end}", own) for p in problems for end in ("String", *"1234")),
        *(Mapped(f"Tag{part}{n}", tags) for part in ("Setting", "Control") for n in (1, 2, 3)),
    ]


COLUMNS: tuple[Mapped, ...] = (
    *_names(),
    *_size(),
    *_counts(),
    *_motion(),
    *_visits(),
    *_stock(),
    *_rates(),
    *_times(),
    *_stations(),
    *_tasks(),
    *_states(),
    *_timings(),
    *_free(),
)
"""RAWSim-O's footprint columns, in the order of its file, which has no header."""

FILES: tuple[Mapped, ...] = (
    Mapped("instance.txt", "run.json: layout"),
    Mapped("setting.txt", "run.json: scenario"),
    Mapped("controller.txt", "run.json: controllers"),
    Mapped("footprint.csv", "footprint.csv with a header, footprint.parquet"),
    Mapped("statistics.txt", "report.html (rmfs report); tables robots, pods, stations"),
    Mapped("stationstatistics.csv", "stations; the spread of visit times from visits"),
    Mapped("itemdescriptionstatistics.csv", "skus (`skus.popularity`, `skus.lines_picked`)"),
    Mapped("itemprogression.csv", "picks, with order and SKU"),
    Mapped("bundleprogression.csv", "bundles"),
    Mapped("orderprogression.csv", "orders"),
    Mapped("bundleplacementprogression.csv", "`bundles.created_s`"),
    Mapped("orderplacementprogression.csv", "`orders.created_s`"),
    Mapped("collisionprogression.csv", "rmfs run --check: there are none; `collisions`"),
    Mapped("tripscompleted.csv", "trips, all kinds, with distance; `trips.station`"),
    Mapped("traveleddistanceprogression.csv", "`series.distance_m`"),
    Mapped(
        "inventorylevel.csv", "`series.inventory_share`; SKUs in stock and inversions: not kept"
    ),
    Mapped(
        "performance.csv",
        "`peak_rss_mb`, `wall_s`, `decisions.wall_s`; memory over time: not kept",
    ),
    Mapped(
        "bundleordersituations.csv",
        "`series.backlog_orders`, `series.backlog_bundles`; ages from `orders.created_s` and "
        "`orders.assigned_s` (theirs mixes relative and absolute times)",
    ),
    Mapped(
        "stationprogression.csv",
        "by grouping picks, bundles and visits by station and time; the sums in series",
    ),
    Mapped(
        "botinfoprogression.csv", "`series.robots_queueing`, `series.robots_task_pick` and so on"
    ),
    Mapped("wellsortedness.csv", "none: how well pods are sorted is not measured"),
    Mapped("connectionstatistics.csv", "connections; traffic on each edge in edges"),
    Mapped("pathfinding.csv", "`planning_wall_s`, `plans` of the run; not kept per call"),
    Mapped(
        "locationspolled.heat", "heat by task, exact counts and not samples: `heat.pick_visits`"
    ),
    Mapped("trips.heat", "connections, grouped by waypoint and `connections.to_kind`"),
    Mapped("storagelocationinfopolled.heat", "none: pods have no scores here; see pods"),
    Mapped("output.log", "the error stream of the command"),
    Mapped("tags.csv", "none, as for Tag"),
    Mapped("exception.txt", "the error stream and the exit code"),
    Mapped("debug.xinst", "none: overlaps do not happen; the checker would report the first"),
)
"""RAWSim-O's output files."""


def markdown() -> str:
    """Return the section on measures for the page for users of RAWSim-O."""
    lines = [
        "## Measures",
        "",
        "The tables show where to find each column of its footprint and each of its files.",
        "Names in backticks are columns of `footprint`, or `table.column`; all are explained in",
        "the [data dictionary](data-dictionary.md). RAWSim-O's quartiles are elements of the",
        "sorted list; ours are interpolated. Generated by `python -m tests.tools.pages`.",
        "",
        "### Footprint",
        "",
        "| # | RAWSim-O | here |",
        "|---:|---|---|",
        *(f"| {number} | {one.theirs} | {one.ours} |" for number, one in enumerate(COLUMNS, 1)),
        "",
        "### Files",
        "",
        "| RAWSim-O | here |",
        "|---|---|",
        *(f"| {one.theirs} | {one.ours} |" for one in FILES),
        "",
        "Two further names of an asynchronous order manager are declared there and never written.",
        "",
    ]
    return "\n".join(lines)

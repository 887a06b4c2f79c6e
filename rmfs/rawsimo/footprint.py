"""The footprint columns of RAWSim-O, and their counterparts in rmfs (`Mapped`).

Columns that RAWSim-O computes incorrectly are computed correctly in rmfs. For columns without a
counterpart, the reason is given.
"""

from __future__ import annotations

from rmfs.rawsimo.mapped import Mapped

_SPREAD = ("Avg", "Med", "LQ", "UQ")
_NAMES = {"Avg": "mean", "Med": "median", "LQ": "lower_quartile", "UQ": "upper_quartile"}
_RULE = "name and parameters of the rule: run.json, key controllers.parameters.{}"


def _spread(theirs: str, ours: str) -> list[Mapped]:
    """Map four columns to four columns of the footprint; rmfs interpolates quartiles."""
    return [Mapped(theirs + end, f"`{ours}_{_NAMES[end]}_s`") for end in _SPREAD]


def _over_stations(theirs: str, ours: str, mean: str | None, note: str = "") -> list[Mapped]:
    """Map four columns that summarise stations to one column of the table `stations` of rmfs."""
    own = f"`stations.{ours}`{note}"
    first = f"`{mean}`, or the mean of {own}" if mean else f"mean of {own}"
    words = {"Avg": first, "Med": f"median of {own}"}
    words |= {"LQ": f"first quartile of {own}", "UQ": f"third quartile of {own}"}
    return [Mapped(theirs + end, words[end]) for end in _SPREAD]


def _names() -> list[Mapped]:
    rules = {
        "PP": "pp",
        "TA": "ta (and pps, which is part of TA in RAWSim-O)",
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
        Mapped("Tag", "none: use the name of the run folder, or of the arm of a design"),
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
        Mapped("IStationCapacityAvg", "mean of `stations.capacity` over replenishment stations"),
        Mapped("OStationCapacityAvg", "mean of `stations.order_slots` over pick stations"),
        Mapped("SKUs", "`skus`"),
    ]


def _counts() -> list[Mapped]:
    rejected = "none: rejected arrivals are not recorded"
    whole = "over the measured time (RAWSim-O: only over samples not yet written to disk)"
    return [
        Mapped("BundlesPlaced", "`bundles_created`"),
        Mapped("OrdersPlaced", "`orders_created`"),
        Mapped("BundlesRejected", rejected),
        Mapped(
            "OrdersRejected",
            f"{rejected}; `order_redraws` counts order lines drawn again because stock was short",
        ),
        Mapped("BundlesInBacklogRemaining", "`backlog_bundles_end`"),
        Mapped("OrdersInBacklogRemaining", "`backlog_orders_end`"),
        Mapped("BundlesInBacklogAvg", f"`backlog_bundles_mean`, {whole}"),
        Mapped("OrdersInBacklogAvg", f"`backlog_orders_mean`, {whole}"),
        Mapped("BundlesHandled", "`bundles_stored`"),
        Mapped("ItemsHandled", "`units_picked`"),
        Mapped("LinesHandled", "`lines_picked`"),
        Mapped("OrdersHandled", "`orders_completed`"),
        Mapped("UnitsHandled", "`units_picked` + `bundles_stored`"),
        Mapped("Collisions", "`collisions`, counted by the independent checker of the trace"),
        Mapped(
            "FailedReservations",
            "`plan_failures`: searches that found no route; failed reservations of single segments "
            "are not counted",
        ),
        Mapped(
            "PathPlanningTimeouts",
            "none: path planning is limited by a number of search steps, not by wall time",
        ),
        Mapped("PathPlanningTimeoutFractional", "none, as for PathPlanningTimeouts"),
    ]


def _motion() -> list[Mapped]:
    optimal = "none in metres; `trips.unhindered_s` is a lower bound on the duration of each trip"
    trips = "trips to {} stations (see `trips.station`)"
    time = "mean of `trips.end_s` - `trips.start_s` over "
    pick, replenish = trips.format("pick"), trips.format("replenishment")
    return [
        Mapped("DistanceTraveled", "`distance_m`"),
        Mapped("DistanceTraveledPerBot", "`distance_per_robot_m`"),
        Mapped("DistanceEstimated", optimal),
        Mapped("DistanceRequestedOptimal", optimal),
        Mapped("TimeMoving", "mean of `robots.moving_s`; as a share of time, `robot_moving_share`"),
        Mapped(
            "TimeQueueing",
            "mean of `robots.queueing_s`; as a share of time, `robot_queueing_share`",
        ),
        Mapped("TripDistance", "`distance_m` / `trips`"),
        Mapped("TripTime", "`trip_time_mean_s` + (sum of `robots.queueing_s`) / `trips`"),
        Mapped(
            "TripTimeWithoutQueueing",
            "`trip_time_mean_s`: in rmfs, a trip to a station ends where the queue zone begins",
        ),
        Mapped("TripCount", "`trips`: trips between destinations of tasks, not between waypoints"),
        Mapped("LastMileTripOStationCount", f"number of {pick}"),
        Mapped("LastMileTripOStationTimeAvg", time + pick),
        Mapped("LastMileTripIStationCount", f"number of {replenish}"),
        Mapped("LastMileTripIStationTimeAvg", time + replenish),
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
        Mapped(
            "PodsHandledPerIStationAvg", "mean of `stations.visits` over replenishment stations"
        ),
        Mapped(
            "PodsHandledPerIStationVar",
            "population variance of `stations.visits` over replenishment stations",
        ),
        Mapped(
            "PodsHandledPerOStationAvg",
            "mean of `stations.visits` over pick stations (RAWSim-O averages over replenishment "
            "stations instead)",
        ),
        Mapped(
            "PodsHandledPerOStationVar",
            "population variance of `stations.visits` over pick stations",
        ),
    ]


def _stock() -> list[Mapped]:
    ranks = "none: rmfs does not measure how well pods are sorted; `pods.pick_visits` and "
    ranks += "`pods.waypoint_end` show how often each pod was used, and where it was at the end"
    kinds = [f"Inv{s}{e}" for s in ("Combined", "Speed", "Utility") for e in _INVERSIONS]
    stops = "none: pauses are visible in `series.orders_created` and `series.bundles_created`"
    return [
        Mapped("InventoryLevelAvg", "`inventory_share_mean`, an exact time average"),
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
            "`units_per_h_at_pile_on`, which is not an upper bound",
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
    ours = "for the mean over all visits, `late_bound_units_per_visit`"
    late = "`stations.late_bound_units` / `stations.visits`"
    words = {"Avg": "mean", "Med": "median", "LQ": "first quartile", "UQ": "third quartile"}
    bundled = "none: bundles added to a task in progress are not counted separately"
    pick, replenish = " over pick stations", " over replenishment stations"
    down = " (all time without work; RAWSim-O counts only periods above a threshold)"
    return [
        *_over_stations("ItemPileOne", "units_per_visit", "units_per_visit"),
        *(
            Mapped(
                f"InjectedItemPileOne{end}",
                f"{words[end]} of {late} over pick stations"
                + (f"; {ours}" if end == "Avg" else ""),
            )
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
        Mapped("TaskCountNone", "none: in rmfs, having no task is not a kind of task"),
        Mapped("TaskTimeNone", "`robots` * `duration_s` - the sum of the times of all tasks"),
        *(one for pair in pairs for one in pair),
        Mapped("TaskTimeBusyAvg", "`robot_busy_share` * `duration_s`"),
        Mapped("TaskTimeBusyAvgFractional", "`robot_busy_share`"),
    ]


def _states() -> list[Mapped]:
    transfer = "sum of `robots.transfer_s`, which covers lifting and setting down"
    served = "sum of `visits.end_s` - `visits.begin_s` at {} stations"
    return [
        Mapped("StateCountPickup", "`pods_lifted`"),
        Mapped("StateTimePickup", transfer),
        Mapped(
            "StateCountSetdown",
            "`tasks_park` + `tasks_reposition`, minus the tasks of these kinds in progress at the "
            "end",
        ),
        Mapped("StateTimeSetdown", transfer),
        Mapped(
            "StateCountGet",
            "`replenishment_visits`; the number of bundles stored in them is `bundles_stored`",
        ),
        Mapped("StateTimeGet", served.format("replenishment")),
        Mapped(
            "StateCountPut",
            "`pick_visits`; the number of units picked in them is `units_picked`",
        ),
        Mapped("StateTimePut", served.format("pick")),
        Mapped("StateCountRest", "`tasks_rest`"),
        Mapped("StateTimeRest", "sum of `robots.idle_s`"),
        Mapped("StateCountMove", "`plans`"),
        Mapped(
            "StateTimeMove", "sum of `robots.moving_s` + `robots.turning_s` + `robots.waiting_s`"
        ),
        Mapped("StateCountEvade", "none: evading another robot is not recorded as a state"),
        Mapped("StateTimeEvade", "none, as for StateCountEvade"),
        Mapped(
            "StateCountElevator",
            "sum of `edges.passages` over the edges for which `edges.ride` is true",
        ),
        Mapped("StateTimeElevator", "sum of `robots.riding_s`"),
    ]


def _timings() -> list[Mapped]:
    problems = {
        "TaskAllocation": "ta",
        "ItemStorage": "rps",
        "PodStorage": "psa",
        "Repositioning": "repositioning (RAWSim-O repeats the figures of pod storage)",
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
            Mapped(f"Timing{theirs}{end}", f"`controllers.{column}` of the problem {ours}")
            for theirs, ours in problems.items()
            for end, column in columns.items()
        ),
    ]


def _free() -> list[Mapped]:
    own = "none: to record further figures, write a measure (rmfs.measure.Measure)"
    problems = ("PP", "TA", "PC", "SA", "IS", "PS", "RP", "OB", "RB", "MM")
    tags = "none: the names and descriptions of the input files are in run.json"
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

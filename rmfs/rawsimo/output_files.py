"""The output files of RAWSim-O, and their counterparts in rmfs (`Mapped`)."""

from __future__ import annotations

from rmfs.rawsimo.mapped import Mapped

FILES: tuple[Mapped, ...] = (
    Mapped("instance.txt", "run.json: layout"),
    Mapped("setting.txt", "run.json: scenario"),
    Mapped("controller.txt", "run.json: controllers"),
    Mapped("footprint.csv", "footprint.csv with a header, footprint.parquet"),
    Mapped("statistics.txt", "report.html (rmfs report); tables robots, pods and stations"),
    Mapped(
        "stationstatistics.csv", "table stations; for the distribution of visit times, table visits"
    ),
    Mapped("itemdescriptionstatistics.csv", "table skus (`skus.popularity`, `skus.lines_picked`)"),
    Mapped("itemprogression.csv", "table picks, with order and SKU"),
    Mapped("bundleprogression.csv", "table bundles"),
    Mapped("orderprogression.csv", "table orders"),
    Mapped("bundleplacementprogression.csv", "`bundles.created_s`"),
    Mapped("orderplacementprogression.csv", "`orders.created_s`"),
    Mapped(
        "collisionprogression.csv",
        "none: rmfs run --check proves that there are no collisions, or else counts them in "
        "`collisions`",
    ),
    Mapped("tripscompleted.csv", "table trips, with distance and `trips.station`"),
    Mapped("traveleddistanceprogression.csv", "`series.distance_m`"),
    Mapped(
        "inventorylevel.csv",
        "`series.inventory_share`; SKUs in stock and inversions (a better pod at a worse "
        "place) are not recorded",
    ),
    Mapped(
        "performance.csv",
        "`peak_rss_mb`, `wall_s`, `decisions.wall_s`; memory over time is not recorded",
    ),
    Mapped(
        "bundleordersituations.csv",
        "`series.backlog_orders`, `series.backlog_bundles`; ages follow from `orders.created_s` "
        "and `orders.assigned_s` (RAWSim-O mixes relative and absolute times)",
    ),
    Mapped(
        "stationprogression.csv",
        "tables picks, bundles and visits, grouped by station and time; for totals, table series",
    ),
    Mapped(
        "botinfoprogression.csv", "`series.robots_queueing`, `series.robots_task_pick` and so on"
    ),
    Mapped("wellsortedness.csv", "none: rmfs does not measure how well pods are sorted"),
    Mapped(
        "connectionstatistics.csv", "table connections; for the traffic on each edge, table edges"
    ),
    Mapped(
        "pathfinding.csv",
        "`planning_wall_s` and `plans`, for the whole run; if searches take simulated time, table "
        "plans lists them",
    ),
    Mapped(
        "locationspolled.heat",
        "table heat, with exact counts by task (such as `heat.pick_visits`) instead of samples",
    ),
    Mapped("trips.heat", "table connections, grouped by waypoint and `connections.to_kind`"),
    Mapped(
        "storagelocationinfopolled.heat",
        "none: scores of pods are not recorded; table pods has other figures of each pod",
    ),
    Mapped("output.log", "the error stream of the command"),
    Mapped("tags.csv", "none, as for Tag"),
    Mapped("exception.txt", "the error stream and the exit code"),
    Mapped(
        "debug.xinst",
        "none: the file shows overlapping robots; in rmfs, robots never overlap, and the checker "
        "of the trace would report an overlap",
    ),
)
"""RAWSim-O's output files."""

"""Conversion of RAWSim-O's item storage (RPS), pod storage (PSA) and repositioning."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rmfs.rawsimo.control.elements import (
    METRICS,
    Element,
    Number,
    Numbers,
    Rule,
    Switch,
    Whole,
    Word,
    translated,
    values_of,
)

if TYPE_CHECKING:
    from rmfs.config import Table
    from rmfs.rawsimo.scenario.settings import Settings

_BUFFER: dict[str, Element] = {
    "BufferThreshold": Number("buffer_threshold", 0.8),
    "BufferTimeout": Number("buffer_timeout_s", 1200.0),
}
_STICKY: dict[str, Element] = {**_BUFFER, "StickToPodUntilFull": Switch("stick_to_pod", True)}
_CLASSES: dict[str, Element] = {
    "ClassBorders": Numbers("class_borders", (0.1, 0.3, 1.0)),
    "ReallocationDelay": Number("reallocation_period_s", 0.0),
    "ReallocationOrderCount": Whole("reallocation_orders", 0),
}

RPS = {
    "Dummy": Rule("dummy"),
    "Random": Rule("random", _STICKY),
    "Emptiest": Rule("emptiest", _STICKY),
    "LeastDemand": Rule("least-demand", _STICKY),
    "Correlative": Rule("correlative", _BUFFER),
    "ClosestLocation": Rule("nearest", _BUFFER),
    "Reactive": Rule(
        "reactive",
        {
            **_BUFFER,
            "AllocationRule": Word(
                "among_equals",
                {"RandomSameTier": "random", "EmptiestSameTier": "emptiest"},
                "RandomSameTier",
            ),
        },
    ),
    "Turnover": Rule(
        "turnover",
        {
            **_CLASSES,
            "EmptiestInsteadOfRandom": Switch("emptiest", True),
            "BufferThresholdPerClass": Numbers("buffer_thresholds", (0.8, 0.8, 0.8)),
            "BufferTimeoutPerClass": Numbers("buffer_timeouts_s", (1200.0, 1200.0, 1200.0)),
        },
    ),
}

_PLACES = {f"OutputStationDistance{theirs}": ours for theirs, ours in METRICS.items()}
_WITHIN = {
    "Random": "random",
    **{
        f"{theirs}{metric}": f"{ours} {METRICS[metric]}"
        for theirs, ours in (("Nearest", "nearest"), ("OStationNearest", "nearest-to-station"))
        for metric in METRICS
    },
}
"""Pairs of parameters that RAWSim-O expresses by one word."""

_PRIORITIES = {"DropoffFirst": "drop-off", "CacheFirst": "cache", "CacheDropoffEqual": "equal"}
ZONES: dict[str, Element] = {
    "CacheFraction": Number("cache_share", 0.25),
    "DropoffCount": Whole("drop_off_places", 0),
    "ZonePriority": Word("zone_priority", _PRIORITIES, "DropoffFirst"),
}
"""Parameters of the zones, which have a block of their own in the file."""

_DEAD = {
    "ScoreUpdateTimeout": "RAWSim-O itself never uses it",
    "ConsiderBacklogDemand": "RAWSim-O itself never uses it",
    "WeighSpeedByContainedCount": "RAWSim-O itself never uses it",
    "UseStaticItemFrequency": "RAWSim-O itself never uses it",
}
_UTILITY: dict[str, Element] = {
    "BufferStorageLocations": Number("place_buffer", 0.05),
    "RankCorridor": Whole("corridor", 3),
    "WeightSpeed": Number("speed_weight", 1.0),
    "WeightUtility": Number("utility_weight", 1.0),
}
_WORTH: dict[str, Element] = {
    "WeightUtility": Number("utility_weight", 1.0),
    "WeightSpeed": Number("speed_weight", 0.0),
    "WeightCacheFill": Number("fill_weight", 1.0),
    "WeightCacheUtility": Number("value_weight", 1.0),
    "PodCacheableThreshold": Number("threshold", 0.5),
}

PSA = {
    "Dummy": Rule("dummy"),
    "Fixed": Rule("fixed"),
    "Nearest": Rule("nearest", {"PodDisposeRule": Word("metric", METRICS, "ShortestTime")}),
    "Random": Rule("random", {"PreferSameTier": Switch("prefer_same_tier", True)}),
    "StationBased": Rule(
        "station-based",
        {
            "OutputStationMode": Word(
                "stations", {"true": "pick", "false": "replenishment"}, "true"
            ),
            "PodDisposeRule": Word("metric", METRICS, "ShortestTime"),
        },
        {"EuclideanDistanceMetric": "RAWSim-O no longer supports it and uses the shortest time"},
    ),
    "Turnover": Rule(
        "turnover",
        {
            **_CLASSES,
            "StorageLocationClassRule": Word(
                "place_metric", _PLACES, "OutputStationDistanceShortestTime"
            ),
            "PodDisposeRule": Word("within_class", _WITHIN, "NearestShortestTime"),
        },
    ),
    "Cache": Rule("cache", {**_WORTH, "PodDisposeRule": Word("metric", METRICS, "ShortestTime")}),
    "Utility": Rule("utility", _UTILITY, _DEAD),
}

_NEVER_CHECKED = {"GlobalTimeout": "RAWSim-O itself never uses it"}

REPOSITIONING = {
    "Dummy": Rule("none"),
    "Cache": Rule(
        "cache",
        {
            "CacheClearing": Whole("free_places", 8),
            "PodEmptyThreshold": Number("empty_below", 0.4),
            "UselessConsiderBacklog": Switch("count_backlog", True),
        },
        _NEVER_CHECKED,
    ),
    "CacheDropoff": Rule(
        "cache-drop-off",
        {
            **_WORTH,
            "PreferSameTierMoves": Switch("same_tier", False),
            "TargetFillCache": Number("target_fill", 0.8),
            "PodDisposeRule": Word("metric", METRICS, "Manhattan"),
        },
        _NEVER_CHECKED,
    ),
    "Utility": Rule("utility", _UTILITY, {**_DEAD, **_NEVER_CHECKED}),
}


def rps(kind: str, block: Settings) -> Table:
    """Convert an item storage method of RAWSim-O to the table `rps` of a controllers file."""
    return translated(block, RPS[kind])


def psa(kind: str, block: Settings) -> Table:
    """Convert a pod storage method of RAWSim-O to the table `psa` of a controllers file."""
    table = translated(block, PSA[kind]) | _zones(kind, block)
    if "within_class" in table:
        table["within_class"], _, metric = table["within_class"].partition(" ")
        table |= {"metric": metric} if metric else {}
    return table


def repositioning(kind: str, block: Settings) -> Table:
    """Convert RAWSim-O's repositioning to the table `repositioning` of a controllers file."""
    return translated(block, REPOSITIONING[kind]) | _zones(kind, block)


def _zones(kind: str, block: Settings) -> Table:
    """Convert the parameters of zones, which may be in a nested block."""
    if kind not in ("Cache", "CacheDropoff"):
        return {}
    nested = [tag for tag in block.tags if "Zon" in tag and tag not in ZONES]
    holder = block.block(nested[0]) if nested else block
    table = values_of(holder, ZONES)
    if nested:
        holder.leave_rest()
    return table

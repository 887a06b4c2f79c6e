"""Conversion of RAWSim-O's task allocation (TA), of which pod selection (PPS) is a part."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rmfs.rawsimo.control.elements import (
    METRICS,
    Complement,
    Element,
    Number,
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

_REST = {
    "Random": "random",
    "RandomSameTier": "random",
    "Middle": "middle",
    "MiddleSameTier": "middle",
    "Nearest": "nearest",
}
_TIER = "robots always rest on their tier, and pods go on to stations of their tier"
_DROPPED = "RAWSim-O no longer supports it"

TA = {
    "Balanced": Rule(
        "balanced",
        {
            "BotReallocationTimeout": Number("period_s", 30.0),
            "WeightInputStations": Number("replenishment_weight", 1.0),
            "WeightOutputStations": Number("pick_weight", 2.0),
            "WeightRepositioning": Number("reposition_weight", 0.0),
            "BotsPerStationLimit": Whole("robots_per_station", 9),
            "ExtendSearch": Switch("other_stations", False),
            "ExtendedSearchRadius": Number("search_radius_m", 8.0),
            "SearchAll": Switch("search_all", False),
            "RepositionBeforeRest": Switch("reposition_before_rest", True),
            "RestLocationOrderType": Word("rest", _REST, "MiddleSameTier"),
        },
        {
            "PreferSameTier": _TIER,
            **dict.fromkeys(
                ("Solver", "WeightInventoryFeedback", "InventoryFillDesired"), _DROPPED
            ),
        },
    ),
    "ConstantRatio": Rule(
        "constant-ratio",
        {
            "PickBotRatio": Number("pick_share", 0.75),
            "RefreshAllocationTimeout": Number("period_s", 30.0),
            "RestLocationOrderType": Word("rest", _REST, "MiddleSameTier"),
        },
        dict.fromkeys(
            ("OnTheFlyExtract", "OnTheFlyStore"),
            "RAWSim-O itself uses only those of the pod selection",
        ),
    ),
    "Swarm": Rule(
        "swarm",
        {
            "alpha": Number("threshold_weight", 1.0),
            "beta": Number("distance_weight", 1.0),
            "multiplikator": Number("growth", 1.2),
            "maxMultiplikatorValue": Number("growth_limit", 30.0),
            "restPercentage": Number("rest_share", 0.8),
            "maximumBotsPerStation": Whole("work_limit", 6),
            "ExtendSearch": Switch("other_stations", False),
            "ExtendedSearchRadius": Number("search_radius_m", 5.0),
            "RestLocationOrderType": Word("rest", _REST, "Nearest"),
        },
    ),
    "Random": Rule(
        "random",
        {
            "StickToModeProbability": Complement("switch_probability", 0.9),
            "StickToPodProbability": Number("keep_pod_probability", 0.95),
            "RepositioningProbability": Number("reposition_probability", 0.05),
            "SwitchModeIfNoWork": Switch("other_kind", True),
            "PreferSameTier": Switch("prefer_same_tier", True),
        },
        {"DoRepositioningIfNoWork": "RAWSim-O itself never uses it"},
    ),
    "BruteForce": Rule("brute-force"),
}

_FILTERS = {
    "AssignedOnly": "assigned",
    "AssignedAndCompleteQueued": "assigned-and-completable",
    "AssignedAndQueuedEqually": "assigned-and-queued",
}
_BINDING: dict[str, Element] = {
    "OnTheFlyExtract": Switch("late_picks", True),
    "OnTheFlyStore": Switch("late_bundles", True),
    "FilterForConsideration": Word("consider", _FILTERS, "AssignedAndCompleteQueued"),
    "FilterForReservation": Word("reserve", _FILTERS, "AssignedAndCompleteQueued"),
}
_VALUES = {"Picks": "picks", "OrderAge": "age", "OrderDueTime": "lateness"}
_SAME_TIER: dict[str, Element] = {"PreferSameTier": Switch("prefer_same_tier", True)}
_NEAR: dict[str, Element] = {"EstimateBotPodDistance": Switch("estimate", True)}
_LATENESS: dict[str, Element] = {
    "ValueMetric": Word("metric", _VALUES, "Picks"),
    "OnlyPositiveLateness": Switch("only_positive_lateness", False),
}
_OLD_AGE = {"IncludeAge": "RAWSim-O no longer supports it; ValueMetric takes its place"}
_ON_ITS_TIER = {"PreferSameTier": _TIER}

_PICK_POD = {
    "Random": Rule("random", _SAME_TIER),
    "Nearest": Rule(
        "nearest", {**_NEAR, "DistanceMetric": Word("metric", METRICS, "ShortestTime")}
    ),
    "Fill": Rule(
        "fill",
        {
            "PreferFullest": Switch("prefer_fullest", True),
            "Binary": Switch("binary", True),
            "Threshold": Number("threshold", 0.7),
        },
    ),
    "Demand": Rule("demand"),
    "Completeable": Rule("completeable", {"IncludeQueuedOrders": Switch("queued", True)}),
    "WorkAmount": Rule(
        "work-amount",
        {
            **_LATENESS,
            **_SAME_TIER,
            "BacklogWeight": Number("queued_weight", 0.2),
            "CompleteableOrderBoost": Number("completable_boost", 1.0),
            "CompleteableQueuedOrders": Switch("boost_queued", True),
            "TimeCosts": Number("time_cost", 1 / 3),
            "EstimateBotPodDistancePenalty": Switch("estimate_to_pod", True),
            "EstimatePodStationDistancePenalty": Switch("estimate_to_station", False),
        },
        _OLD_AGE,
    ),
}
_REPLENISHMENT_POD = {
    "Random": Rule("random", _SAME_TIER),
    "Nearest": Rule("nearest", {**_NEAR, "DistanceMetric": Word("metric", METRICS, "Euclidean")}),
    "Demand": Rule("demand"),
    "WorkAmount": Rule("work-amount", {"IncludeAge": Switch("age", False), **_SAME_TIER}),
}
_NEXT_PICK = {
    "Random": Rule("random", left=_ON_ITS_TIER),
    "Nearest": Rule("nearest", {"DistanceMetric": Word("metric", METRICS, "Euclidean")}),
    "WorkAmount": Rule("work-amount", _LATENESS, {**_ON_ITS_TIER, **_OLD_AGE}),
}
_NEXT_REPLENISHMENT = {
    "Random": Rule("random", left=_ON_ITS_TIER),
    "Nearest": Rule("nearest", {"DistanceMetric": Word("metric", METRICS, "Euclidean")}),
    "WorkAmount": Rule("work-amount", {"IncludeAge": Switch("bundle_age", False)}, _ON_ITS_TIER),
}

_OLD_ORDERS = (
    *("InputPodOrderType", "OutputPodOrderType"),
    *("InputStationExtendedSearchOrderType", "OutputStationExtendedSearchOrderType"),
)


def ta(kind: str, block: Settings) -> Table:
    """Convert a task allocation method of RAWSim-O to the table `ta` of a controllers file.

    The pod selection within the method is converted by `pps`.
    """
    block.leave(_OLD_ORDERS, "RAWSim-O no longer supports it and uses its default pod selection")
    table = translated(block, TA[kind])
    if table.get("period_s") == 0:
        block.note("a period of 0 means never: imported as 10^9 s")
        table["period_s"] = 1e9
    return table


def pps(kind: str, block: Settings) -> Table:
    """Convert a task allocation method's pod selection to the table `pps` of a controllers file.

    For task allocation methods that choose pods themselves (Random, BruteForce), the table names
    the rule `dummy` and switches late binding off (`late_picks` and `late_bundles` are false).
    """
    selection = block.block("PodSelectionConfig")
    if kind in ("Random", "BruteForce"):
        return {"name": "dummy", "late_picks": False, "late_bundles": False}
    table: Table = {"name": "lexicographic", **values_of(selection, _BINDING)}
    if kind == "Swarm":
        table |= {"late_picks": False, "late_bundles": False}
        selection.note(
            "OnTheFlyExtract and OnTheFlyStore not used: Swarm adds no requests to pods on their "
            "way"
        )
    table["pick_pod"] = _criteria(
        selection, "OutputPodScorer", _PICK_POD, ("Completeable", "WorkAmount", "Nearest")
    )
    table["replenishment_pod"] = _criteria(
        selection, "InputPodScorer", _REPLENISHMENT_POD, ("WorkAmount", "Nearest", "Random")
    )
    _next_stations(selection, table)
    selection.text("Name")
    selection.leave_rest()
    criteria = [*table["pick_pod"], *table["replenishment_pod"], *table["next_station"]]
    if all(criterion["criterion"] == "random" for criterion in criteria):
        binding = {key: table[key] for key in ("late_picks", "late_bundles", "consider", "reserve")}
        return {
            "name": "random",
            **binding,
            "prefer_same_tier": table["pick_pod"][0]["prefer_same_tier"],
        }
    return table


def _next_stations(selection: Settings, table: Table) -> None:
    """Convert RAWSim-O's two lists of criteria for stations to the single list of rmfs."""
    usual = ("WorkAmount", "Nearest", "Random")
    picks = _criteria(selection, "OutputExtendedSearchScorer", _NEXT_PICK, usual)
    bundles = _criteria(selection, "InputExtendedSearchScorer", _NEXT_REPLENISHMENT, usual)
    named = [[criterion["criterion"] for criterion in criteria] for criteria in (picks, bundles)]
    if named[0] != named[1]:
        selection.note(
            f"InputExtendedSearchScorer ({', '.join(named[1])}) not used: rmfs has one list of "
            "criteria for the next station of a pod, taken from OutputExtendedSearchScorer"
        )
    for criterion, other in zip(picks, bundles, strict=True):
        if criterion["criterion"] == other["criterion"] == "work-amount":
            criterion["bundle_age"] = other["bundle_age"]
    table["next_station"] = picks


def _criteria(
    selection: Settings, tag: str, rules: dict[str, Rule], usual: tuple[str, str, str]
) -> list[Table]:
    """Return a criterion and its two tie breakers; `usual` replaces those that are absent."""
    found = []
    for end, default in zip(("", "TieBreaker1", "TieBreaker2"), usual, strict=True):
        block = selection.block(tag + end)
        word = next((word for word in rules if block.kind.endswith(word)), None)
        if block.kind and word is None:
            raise selection.error(tag + end, f"unknown criterion {block.kind:.60}")
        table = translated(block, rules[word or default])
        table["criterion"] = table.pop("name")
        block.leave_rest()
        found.append(table)
    return found

"""Conversion of RAWSim-O's order batching (POA) and replenishment batching (ROA)."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rmfs.rawsimo.control.elements import (
    METRICS,
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

_TIES = {"EarliestDueTime": "due-time", "FCFS": "first-come", "Random": "random"}
_BUSY = {"LeastBusy": "least-busy", "MostBusy": "most-busy", "Random": "random"}
_LANE: dict[str, Element] = {
    "FastLane": Switch("fast_lane", False),
    "FastLaneTieBreaker": Word("fast_lane_tie_breaker", _TIES, "EarliestDueTime"),
}
_SELECTIONS = {
    "Random": "random",
    "FCFS": "first-come",
    "DueTime": "due-time",
    "FrequencyAge": "frequency-age",
}

SIMPLE = {
    "Random": Rule("first-come", {"Recycle": Switch("stick_to_station", False)}),
    "Workload": Rule(
        "workload",
        {
            "OrderingRule": Word(
                "station",
                {"LowestOrderCount": "least-busy", "HighestOrderCount": "most-busy"},
                "LowestOrderCount",
            )
        },
    ),
    "Related": Rule("related", {"TieBreaker": Word("tie_breaker", _BUSY, "LeastBusy")}),
    "NearBestPod": Rule("near-best-pod", {"DistanceRule": Word("metric", METRICS, "ShortestPath")}),
    "PodMatching": Rule(
        "pod-match",
        {
            **_LANE,
            "FastLane": Switch("fast_lane", True),
            "TieBreaker": Word("tie_breaker", _TIES, "EarliestDueTime"),
            "LateBeforeMatch": Switch("late_first", False),
        },
    ),
    "LinesInCommon": Rule(
        "lines-in-common", {**_LANE, "TieBreaker": Word("tie_breaker", _TIES, "EarliestDueTime")}
    ),
}
"""Order batchings whose parameters are converted one by one."""

POA = ("Default", "Foresight", "Queue", *SIMPLE)
"""Names of all order batchings."""

_DEFAULT: dict[str, Element] = {
    **_LANE,
    "StationSelectionRule": Word("station", _BUSY, "Random"),
    "Recycle": Switch("stick_to_station", False),
}

_PODS = {"true": "nearest-pod", "false": "all-pods"}
_COUNTED = {"true": "units", "false": "lines"}

_SCORES = {
    "NotDepletePod": "surplus",
    "DepletePod": "depletion",
    "Deadline": "due-time",
    "AvailablePicks": "matches",
}
"""Score functions by the suffix of their name in RAWSim-O. The first match counts, so
`NotDepletePod` comes before `DepletePod`."""

_CRITERIA = {
    "VacantDeadline": Rule("due-soon", {"": Number("within_s", 600.0)}),
    "EarliestDeadline": Rule("due-time"),
    "InboundMatches": Rule("inbound-matches", {"": Number("near_unit_metres", 10.0)}),
    "Completeable": Rule("completable", {"": Word("by", _PODS, "true")}),
    "Completable": Rule("completable", {"": Word("by", _PODS, "true")}),
    "Related": Rule("related"),
    "Lines": Rule("size", {"": Word("count", _COUNTED, "true")}),
    "FCFS": Rule("first-come"),
    "Random": Rule("random"),
}
"""Criteria of POA `queue`, by the word that stands for each in the name of RAWSim-O's type. A
block of such a type has at most one element, the parameter of the criterion."""

ROA = {
    "Random": Rule(
        "random",
        {"Recycle": Switch("stick_to_station", True)},
        {"Reactive": "RAWSim-O no longer supports it"},
    ),
    "SamePod": Rule(
        "same-pod",
        {
            "FirstStationRule": Word(
                "station",
                {
                    "DistanceEuclid": "nearest",
                    "Emptiest": "emptiest",
                    "Fullest": "fullest",
                    "LeastBusy": "least-busy",
                    "MostBusy": "most-busy",
                    "Random": "random",
                },
                "DistanceEuclid",
            ),
            "BreakBatches": Switch("break_batches", False),
            "FCFS": Switch("first_come_first_served", True),
            "OnlySameTier": Switch("same_tier", True),
        },
    ),
}


def poa(kind: str, block: Settings) -> Table:
    """Convert an order batching method of RAWSim-O to the table `poa` of a controllers file.

    Parameters
    ----------
    kind
        Name of the method: one of the names in the tuple `POA`.

    Raises
    ------
    InputError
        If a value is invalid.
    """
    if kind == "Default":
        name = block.choice("OrderSelectionRule", _SELECTIONS, "Random")
        return translated(block, Rule(name, _DEFAULT))
    if kind == "Foresight":
        return _foresight(block)
    if kind == "Queue":
        return _queue(block)
    return translated(block, SIMPLE[kind])


def _foresight(block: Settings) -> Table:
    """Map the two score functions, which are recognised by the ends of their type names."""
    found = []
    for tag in block.tags:
        told = block.kind_of(tag)
        score = next((ours for end, ours in _SCORES.items() if told.endswith(end)), None)
        if score is not None:
            block.block(tag)
            found.append(score)
    first, second = (*found, *("matches", "due-time")[len(found) :])[:2]
    return {"name": "foresight", "score": first, "tie_breaker": second}


def _queue(block: Settings) -> Table:
    """Map the criteria: for the pools, for the stations and for the fast lane."""
    groups: dict[str, list[Table]] = {}
    for tag in block.tags:
        word = next((word for word in _CRITERIA if word in block.kind_of(tag)), None)
        if word is not None:
            which = "fast_lane" if "FastLane" in tag else "station" if "Station" in tag else "queue"
            criteria = groups.setdefault(f"{which}_criteria", [])
            criteria.append(_criterion(block.block(tag), _CRITERIA[word]))
    rule = Rule(
        "queue", {"QueueLength": Whole("queue_length", 20), "FastLane": Switch("fast_lane", True)}
    )
    return translated(block, rule) | groups


def _criterion(block: Settings, rule: Rule) -> Table:
    """Return a criterion; its element, if any, is read whatever the name of the element is."""
    tags = [tag for tag in block.tags if tag != "Name"]
    elements = dict(zip(tags, rule.elements.values(), strict=False))
    return {"criterion": rule.name, **values_of(block, elements)}


def roa(kind: str, block: Settings) -> Table:
    """Convert RAWSim-O's replenishment batching to the table `roa` of a controllers file."""
    return translated(block, ROA[kind])

"""RAWSim-O's path planning: PP."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rmfs.rawsimo.control.elements import Number, Rule, Switch, Whole, Word, translated

if TYPE_CHECKING:
    from rmfs.config import Table
    from rmfs.rawsimo.scenario.settings import Settings

_BY_CLOCK = "limits count work here, so that results repeat"
_EVERYWHERE = {
    "AutoSetParameter": "the values in the file are read, not those it sets",
    "RuntimeLimitPerAgent": _BY_CLOCK,
    "RunTimeLimitOverall": _BY_CLOCK,
    "CanTunnel": "robots without a pod always pass beneath stored ones",
}
_EXACT_WAITS = {"LengthOfAWaitStep": "waits are as long as needed, not whole steps"}
_DEADLOCKS = {"UseDeadlockHandler": "robots that stand still for 30 s always hop to a neighbour"}
_PERIOD = {"Clocking": Number("period_s", 1.0)}
_WINDOW = {"LengthOfAWindow": Number("window_s", 30.0)}

_RULES = {
    "FAR": Rule(
        "far",
        {
            **_PERIOD,
            "LengthOfAWaitStep": Number("wait_s", 2.0),
            "evadingStrategy": Word(
                "reroute",
                {"EvadeByRerouting": True, "EvadeToNextNode": False},
                "EvadeByRerouting",
            ),
            "NoBackEvading": Switch("avoid_evading_back", True),
        },
        {
            **_EVERYWHERE,
            **_DEADLOCKS,
            "MaximumNumberOfBreakingManeuverTries": "a robot reroutes once before it waits",
        },
    ),
    "WHCAvStar": Rule(
        "whca-v",
        {
            **_PERIOD,
            **_WINDOW,
            "LengthOfAWaitStep": Number("wait_s", 2.0),
            "AbortAtFirstConflict": Switch("restart_at_once", True),
        },
        {**_EVERYWHERE, **_DEADLOCKS},
    ),
    "WHCAnStar": Rule(
        "whca-n",
        {**_PERIOD, **_WINDOW},
        {
            **_EVERYWHERE,
            **_EXACT_WAITS,
            **_DEADLOCKS,
            "UseBias": "ways of others are not made dearer",
        },
    ),
    "BCP": Rule(
        "bcp",
        {**_PERIOD, "BiasedCostAmount": Number("bias_m", 1.0)},
        {**_EVERYWHERE, **_EXACT_WAITS},
    ),
    "CBS": Rule(
        "cbs",
        _PERIOD,
        {**_EVERYWHERE, **_EXACT_WAITS, "SearchMethod": "the search is best first"},
    ),
    "ODID": Rule(
        "od-id",
        {
            **_PERIOD,
            **_WINDOW,
            "LengthOfAWaitStep": Number("wait_s", 2.0),
            "MaxNodeCountPerAgent": Whole("nodes_per_robot", 100),
        },
        {**_EVERYWHERE, "UseFinalReservations": "robots always end where they can stay"},
    ),
    "PAS": Rule(
        "pas",
        {
            **_PERIOD,
            **_WINDOW,
            "LengthOfAWaitStep": Number("wait_s", 2.0),
            "MaxPriorities": Whole("priorities", 2),
        },
        _EVERYWHERE,
    ),
}

PP = (*_RULES, "Simple", "Dummy")


def pp(kind: str, block: Settings) -> Table:
    """Return the PP table for a path planning.

    With methods that rmfs also has, a robot is granted one straight run at a time, as in RAWSim-O.
    """
    if kind in _RULES:
        return {**translated(block, _RULES[kind]), "runs_granted": 1}
    tags = [tag for tag in block.tags if tag != "Name"]
    block.note(f"{kind} becomes time-windows, which plans each way once and without conflict")
    block.leave(tags, "parameters of another planner")
    return {"name": "time-windows"}

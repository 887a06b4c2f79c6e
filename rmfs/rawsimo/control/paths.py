"""Conversion of RAWSim-O's path planning (PP)."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rmfs.rawsimo.control.elements import Number, Rule, Switch, Whole, Word, translated

if TYPE_CHECKING:
    from rmfs.config import Table
    from rmfs.rawsimo.scenario.settings import Settings

_BY_CLOCK = "rmfs limits searches by counted work instead of time, so that results are reproducible"
_EVERYWHERE = {
    "AutoSetParameter": "rmfs uses the values in the file",
    "RuntimeLimitPerAgent": _BY_CLOCK,
    "RunTimeLimitOverall": _BY_CLOCK,
    "CanTunnel": "robots without a pod can always pass beneath stored pods",
}
_EXACT_WAITS = {"LengthOfAWaitStep": "waiting times are exact, not multiples of a step"}
_DEADLOCKS = {
    "UseDeadlockHandler": "robots that stand still for 30 s always move to a neighbouring waypoint"
}
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
            "UseBias": "the paths of other robots do not raise costs",
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
        {**_EVERYWHERE, **_EXACT_WAITS, "SearchMethod": "the search is always best-first"},
    ),
    "ODID": Rule(
        "od-id",
        {
            **_PERIOD,
            **_WINDOW,
            "LengthOfAWaitStep": Number("wait_s", 2.0),
            "MaxNodeCountPerAgent": Whole("nodes_per_robot", 100),
        },
        {**_EVERYWHERE, "UseFinalReservations": "paths always end where the robot can stay"},
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
    """Convert a path planning method of RAWSim-O to the table `pp` of a controllers file.

    The methods Simple and Dummy, which rmfs lacks, are replaced by `time-windows`. With the other
    methods, a robot is granted one straight run of its path at a time, as in RAWSim-O.
    """
    if kind in _RULES:
        return {**translated(block, _RULES[kind]), "runs_granted": 1}
    tags = [tag for tag in block.tags if tag != "Name"]
    block.note(
        f"{kind} is replaced by time-windows, which plans each path once and without conflicts"
    )
    block.leave(tags, "parameters of another planner")
    return {"name": "time-windows"}

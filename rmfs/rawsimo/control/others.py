"""Conversion of RAWSim-O's station activation (SA) and method management (MM)."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rmfs.rawsimo.control.elements import Number, Rule, Whole, translated, values_of

if TYPE_CHECKING:
    from rmfs.config import Table
    from rmfs.rawsimo.scenario.settings import Settings

SA = {
    "ActivateAll": Rule("all"),
    "BacklogThreshold": Rule(
        "backlog-threshold",
        {
            "Timeout": Number("pause_s", 600.0),
            "OStationActivateThreshold": Whole("orders_on", 50),
            "OStationDeactivateThreshold": Number("pick_share_off", 0.7),
            "IStationActivateThreshold": Whole("bundles_on", 50),
            "IStationDeactivateThreshold": Number("replenishment_share_off", 0.7),
        },
    ),
    "ConstantRatio": Rule(
        "constant-ratio",
        {
            "ActiveRatio": Number("active_share", 0.5),
            "PickReplenishRatio": Number("pick_share", 0.5),
        },
    ),
    "WorkShift": Rule("work-shifts", {"LoopTime": Number("loop_s", 86400.0)}),
}
_SHIFTS = [(0.0, False), (21600.0, True), (79200.0, False)]

MM = ("NoChange", "Random", "Scheduled")
_EXCHANGEABLE = {
    "Nearest": "nearest",
    "Random": "random",
    "StationBased": "station-based",
    "Turnover": "turnover",
}


def sa(kind: str, block: Settings) -> Table:
    """Convert a station activation method of RAWSim-O to the table `sa` of a controllers file."""
    table = translated(block, SA[kind])
    if kind == "WorkShift":
        shifts = block.switches("Shifts") or _SHIFTS
        table["shifts"] = [{"at_s": at_s, "on": on} for at_s, on in shifts]
    return table


def mm(kind: str, block: Settings) -> Table:
    """Convert RAWSim-O's method management to the table `mm` of a controllers file.

    In RAWSim-O, method management exchanges PSA rules only.

    Raises
    ------
    InputError
        If a value is invalid, or the block names a pod storage rule to which RAWSim-O itself cannot
        change during a run.
    """
    if kind == "Random":
        exchanges = block.switch("ExchangePodStorage", default=True)
        period = values_of(block, {"ChangeTimeout": Number("period_s", 7200.0)})
        return {"name": "random", **period} if exchanges else {"name": "none"}
    if kind == "Scheduled":
        key = "at_share" if block.switch("RelativeMode", default=True) else "at_s"
        planned = [pair for tag in block.tags for pair in block.words(tag, _EXCHANGEABLE)]
        planned = sorted(planned) or [(0.5, "nearest")]
        return {
            "name": "scheduled",
            "exchanges": [{key: at, "psa": {"name": name}} for at, name in planned],
        }
    return {"name": "none"}

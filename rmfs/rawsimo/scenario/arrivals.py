"""Conversion of arrivals of orders and bundles, as given in RAWSim-O's settings (.xsett)."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Sequence

    from rmfs.config import Table
    from rmfs.rawsimo.scenario.settings import Settings

_DAY_S = 86400.0

_TIED_TO = {
    "None": "nothing",
    "PickStationsActivated": "pick-stations",
    "ReplenishmentStationsActivated": "replenishment-stations",
}
_POISSON_MODES = {"Simple": "constant", "TimeDependent": "steps", "HighLow": "high-low"}

UNBOUNDED_SHARE = 1000.0
"""Load limit, as a share of the pods' capacity, that stands for no limit."""


class Arrivals:
    """Conversion of the arrivals in the inventory block of a settings file.

    Parameters
    ----------
    block
        The inventory block.
    mode
        How orders arrive: constant backlog (`backlog`), Poisson process (`poisson`), or as listed
        in a file (`stream`).
    letters
        Whether SKUs are coloured letters, and orders are words spelled with these letters.
    file
        Path of the file that lists the orders and bundles; None if `mode` is not `stream`.
    """

    def __init__(self, block: Settings, mode: str, *, letters: bool, file: str | None) -> None:
        self._block = block
        self._mode = mode
        self._letters = letters
        self._file = file

    def tables(self) -> Table:
        """Return the tables `demand` and `replenishment` of a scenario."""
        returns = self._block.number("ReturnOrderProbability", 0.0)
        demand, replenishment = self._regular()
        if self._mode == "stream" or replenishment["mode"] == "needed":
            if returns:
                self._block.note("ReturnOrderProbability not used: bundles are not drawn")
        else:
            replenishment["return_share"] = returns
        self._leave_other_modes()
        orders, bundles = self._batches()
        if orders:
            demand["batches"] = orders
        if bundles:
            replenishment["batches"] = bundles
        return {"demand": demand, "replenishment": replenishment}

    def _regular(self) -> tuple[Table, Table]:
        if self._mode == "stream":
            self._leave_load_limit("bundles come from the file")
            self._block.note(
                "fixed orders have no due times: they are drawn by orders.due (in RAWSim-O, fixed "
                "orders are never late)"
            )
            return {"mode": "stream", "file": self._file}, {"mode": "stream", "file": self._file}
        if self._mode == "poisson":
            return self._poisson()
        return self._fill()

    def _leave_other_modes(self) -> None:
        for mode, tag in (
            ("poisson", "PoissonInventoryConfiguration"),
            ("backlog", "DemandInventoryConfiguration"),
        ):
            if mode != self._mode:
                self._block.leave([tag], "belongs to another OrderMode")

    # --- constant backlogs ----------------------------------------------------------------------

    def _fill(self) -> tuple[Table, Table]:
        fill = self._block.block("DemandInventoryConfiguration")
        by_stock = fill.switch("InventoryLevelDrivenOrderGeneration", default=True)
        by_load = fill.switch("InventoryLevelDrivenBundleGeneration", default=True)
        demand: Table = {
            "mode": "backlog",
            "orders": fill.whole("OrderCount", 200),
            # letters know no pauses
            "pause_by_stock": by_stock and not self._letters,
            "pause_below_share": fill.number("InventoryLevelOrderStopThreshold", 0.1),
            "resume_above_share": fill.number("InventoryLevelOrderRestartThreshold", 0.6),
        }
        bundles = fill.whole("BundleCount", 200)
        resume = fill.number("InventoryLevelBundleRestartThreshold", 0.65)
        pause = fill.number("InventoryLevelBundleStopThreshold", 0.85)
        limit = {"load_limit_share": self._load_limit()}
        replenishment: Table = {"mode": "needed", "bundles": bundles, **limit}
        if not self._letters:
            replenishment |= {
                "mode": "backlog",
                "pause_by_stock": by_load,
                "resume_below_share": resume,
                "pause_above_share": pause,
            }
        self._down(fill, demand, replenishment)
        fill.leave_rest()
        return demand, replenishment

    def _load_limit(self) -> float:
        limit = self._block.number("BufferBundlesUntilInventoryLoad", 1.1)
        self._block.note(
            "BufferBundlesUntilInventoryLoad limits the load in space units (RAWSim-O adds the "
            "number of units of a bundle to it)"
        )
        if self._block.switch("IgnoreCapacityForBundleGeneration", default=False):
            self._block.note(
                "IgnoreCapacityForBundleGeneration: imported as a very large load limit"
            )
            return UNBOUNDED_SHARE
        return limit

    def _leave_load_limit(self, reason: str) -> None:
        self._block.leave(
            ["BufferBundlesUntilInventoryLoad", "IgnoreCapacityForBundleGeneration"], reason
        )

    def _down(self, fill: Settings, demand: Table, replenishment: Table) -> None:
        """Convert down periods; their block may be in `fill` or in the inventory block."""
        tag = "DownPeriodConfiguration"
        holder = fill if tag in fill else self._block
        if tag not in holder:
            return
        periods = holder.block(tag)
        for word, table in (("Order", demand), ("Bundle", replenishment)):
            cycle_s = periods.number(f"MaxTimeFor{word}DownAndUpPeriods", _DAY_S)
            lists = [name for name in periods.tags if word in name and "MaxTime" not in name]
            changes = [change for name in lists for change in periods.switches(name)]
            if any(down for _, down in changes):
                found = down_periods(changes, cycle_s)
                table["down"] = {"cycle_s": cycle_s, "periods_s": found}
        periods.leave_rest()

    # --- Poisson --------------------------------------------------------------------------------

    def _poisson(self) -> tuple[Table, Table]:
        poisson = self._block.block("PoissonInventoryConfiguration")
        kind = poisson.choice("PoissonMode", _POISSON_MODES, "TimeDependent")
        demand: Table = {
            "mode": "poisson",
            "orders_per_h": poisson.number("AverageOrdersPerHourAndStation", 160.0),
            "initial_orders": poisson.whole("InitialOrderCount", 30),
            "tied_to": poisson.choice("DistortOrderRateParameter", _TIED_TO, "None"),
            "profile": self._profile(poisson, kind, "Order", high_per_h=210.0, affected=True),
        }
        replenishment: Table = {
            "mode": "poisson",
            "bundles_per_h": poisson.number("AverageBundlesPerHourAndStation", 45.0),
            "initial_bundles": poisson.whole("InitialBundleCount", 30),
            "tied_to": poisson.choice("DistortBundleRateParameter", _TIED_TO, "None"),
            "profile": self._profile(poisson, kind, "Bundle", high_per_h=75.0, affected=False),
        }
        poisson.leave_rest()
        self._leave_load_limit("bundles for which there is no room wait")
        self._block.note(
            "Poisson orders do not depend on stock, and orders that stock cannot serve wait "
            "(RAWSim-O draws them from stock and rejects orders that it cannot serve)"
        )
        if self._letters:
            self._block.note("bundles of letters are drawn by popularity, not by need")
        return demand, replenishment

    def _profile(
        self, poisson: Settings, kind: str, word: str, *, high_per_h: float, affected: bool
    ) -> Table:
        """Convert the profile of a rate over time; `word` is Order or Bundle."""
        cycle_s = poisson.number(f"MaxTimeForTimeDependent{word}Rates", _DAY_S)
        weights = poisson.pairs(f"TimeDependent{word}Weights")
        switching = {
            "low_to_high_per_h": poisson.number("LowToHighSwitchesPerHour", 0.5),
            "high_to_low_per_h": poisson.number("HighToLowSwitchesPerHour", 2.0),
        }
        high = [tag for tag in poisson.tags if "High" in tag and f"{word}sPerHour" in tag]
        affected = poisson.switch(f"{word}GenAffectedByHighPeriod", affected)
        high_per_h = poisson.number(high[0], high_per_h) if high else high_per_h
        if kind == "high-low" and affected:
            return {"kind": "high-low", "high_per_h": high_per_h, **switching}
        if kind != "steps":
            return {"kind": "constant"}
        self._block.note(
            f"rates of {word.lower()}s change exactly at the start of a step, and their mean is "
            "the given rate (RAWSim-O weights each step by the length of the previous step)"
        )
        return {"kind": "steps", "cycle_s": cycle_s} | steps(weights)

    # --- batches --------------------------------------------------------------------------------

    def _batches(self) -> tuple[Table, Table]:
        tag = "BatchInventoryConfiguration"
        if not self._block.switch("SubmitBatches", default=False):
            self._block.leave([tag], "SubmitBatches is not true")
            return {}, {}
        batches = self._block.block(tag)
        orders = batches.pairs("OrderBatches") or [(36000.0, 400.0)]
        bundles = batches.pairs("BundleBatches") or [(25200.0, 0.9)]
        found: tuple[Table, Table] = (
            {
                "cycle_s": batches.number("MaxTimeForOrderSubmissions", _DAY_S),
                "fill_to": [[time_s, round(number)] for time_s, number in orders],
            },
            {
                "cycle_s": batches.number("MaxTimeForBundleSubmissions", _DAY_S),
                "fill_to": [list(batch) for batch in bundles],
            },
        )
        batches.leave_rest()
        return found


def down_periods(changes: Sequence[tuple[float, bool]], cycle_s: float) -> list[list[float]]:
    """Return the down periods [start, end], in s, in which no orders (or bundles) are generated.

    Each change is a pair: a time in the cycle, in s, and whether generation is down from this time
    on. As the cycle repeats, the state after the last change also holds before the first one.
    """
    state = changes[-1][1]
    begin_s = 0.0
    periods: list[list[float]] = []
    for time_s, down in [*changes, (cycle_s, False)]:
        if state and time_s > begin_s:
            periods.append([begin_s, time_s])
        begin_s, state = time_s, down
    return periods


def steps(weights: Sequence[tuple[float, float]]) -> dict[str, Any]:
    """Convert steps (start in s, weight) of a rate to the keys `starts_s` and `weights`.

    Before the first step of a cycle, the weight of the last step applies. If there are no steps,
    the result is empty.
    """
    if not weights:
        return {}
    if weights[0][0] > 0:
        # before the first step of a cycle the last one goes on
        weights = [(0.0, weights[-1][1]), *weights]
    return {
        "starts_s": [start_s for start_s, _ in weights],
        "weights": [weight for _, weight in weights],
    }

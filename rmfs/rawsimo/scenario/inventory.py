"""Conversion of the inventory block of RAWSim-O's settings files (.xsett).

The block describes SKUs, initial stock, orders, demand and replenishment.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from rmfs.rawsimo.scenario.arrivals import Arrivals
from rmfs.rawsimo.scenario.search import find_beside

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from rmfs.config import Table
    from rmfs.rawsimo.scenario.settings import Settings

_PARTS = ("Mean", "StdDev", "Min", "Max")
_NORMAL_OF_LINES = [f"OrderPositionCount{part}" for part in _PARTS]
_NORMAL_OF_UNITS = [f"PositionCount{part}" for part in _PARTS]
_DEAD_DUE_TIMES = [f"OrderTimestampDueDateOffset{part}" for part in _PARTS]
_ITEM_TYPES = {"SimpleItem": "simple", "Letter": "letter"}
_ORDER_MODES = {"Fill": "backlog", "Poisson": "poisson", "Fixed": "stream"}


class Inventory:
    """Conversion of the inventory block of a settings file.

    Parameters
    ----------
    block
        The inventory block.
    path
        The settings file. The search for files that the block names starts in the folder of the
        settings file.
    """

    def __init__(self, block: Settings, path: Path) -> None:
        self._block = block
        self._path = path
        self._letters = block.choice("ItemType", _ITEM_TYPES, "SimpleItem") == "letter"
        self._mode = block.choice("OrderMode", _ORDER_MODES, "Fill")

    def tables(self) -> Table:
        """Return those tables of a scenario that the block defines, by name.

        Raises
        ------
        InputError
            If a value is invalid or a file is missing.
        """
        block = self._block
        # only a list of fixed orders brings its own letters
        words = self._letters and self._mode != "stream"
        order_file = self._order_file()
        tables: Table = {
            "skus": self._skus(order_file) | self._sizes(),
            "orders": self._orders(words) | {"due": self._due()},
            "stock": {"initial_share": block.number("InitialInventory", 0.7)},
        }
        tables |= Arrivals(block, self._mode, letters=words, file=order_file).tables()
        block.leave(
            ["WarmupOrderCount"], "popularity is known and need not be estimated from orders"
        )
        block.leave(
            _DEAD_DUE_TIMES, "RAWSim-O no longer supports it and uses the default due times"
        )
        block.leave_rest()
        return tables

    def _order_file(self) -> str | None:
        fixed = "FixedInventoryConfiguration"
        if self._mode != "stream":
            self._block.leave([fixed], "OrderMode is not Fixed")
            return None
        named = self._block.block(fixed).text("OrderFile")
        if not named:
            raise self._block.error("OrderFile", "is empty, but required if OrderMode is Fixed")
        return str(find_beside(self._path, named, ".xitem"))

    def _skus(self, order_file: str | None) -> Table:
        block = self._block
        if order_file is not None:
            block.leave(
                ["SimpleItemConfiguration", "ColoredWordConfiguration"],
                "the file of fixed orders lists its SKUs",
            )
            return {"file": order_file}
        if self._letters:
            block.leave(["SimpleItemConfiguration"], "ItemType is Letter")
            words = block.block("ColoredWordConfiguration")
            named = words.text("WordFile") or "SmallJargon.txt"
            colours = words.weights("ColorProbabilities")
            words.leave_rest()
            found: Table = {"words": str(find_beside(self._path, named, ".txt"))}
            if colours:
                found["colours"] = {name.lower(): weight for name, weight in colours.items()}
            return found
        block.leave(["ColoredWordConfiguration"], "ItemType is SimpleItem")
        simple = block.block("SimpleItemConfiguration")
        named = simple.text("GeneratorConfigFile") or "Mu-1000.xgenc"
        simple.leave_rest()
        return {"file": str(find_beside(self._path, named, ".xgenc"))}

    def _sizes(self) -> Table:
        """Return the space per unit and units per bundle of SKUs whose file does not give them."""
        block = self._block
        least = block.number("ItemWeightMin", 5.0)
        most = block.number("ItemWeightMax", 5.0)
        fewest, many = block.whole("BundleSizeMin", 6), block.whole("BundleSizeMax", 6)
        space = (
            {"distribution": "constant", "value": least}
            if least == most
            else {"distribution": "uniform", "min": least, "max": most}
        )
        # the upper end is excluded there, unless both are equal
        units = {"distribution": "uniform", "min": fewest, "max": max(fewest, many - 1)}
        return {"space_per_unit": space, "bundle_units": units}

    def _orders(self, words: bool) -> Table:
        if self._mode == "stream":
            self._block.leave((*_NORMAL_OF_LINES, *_NORMAL_OF_UNITS), "orders come from the file")
        elif words:
            self._block.leave(_NORMAL_OF_LINES, "a word has a line for each letter in its colour")
        lines = self._normal(_NORMAL_OF_LINES, 1.0, 1.0, 1, 4)
        units = self._normal(_NORMAL_OF_UNITS, 1.0, 0.3, 1, 3)
        if words:
            return {"content": "words", "units_per_letter": units}
        return {"content": "skus", "lines": lines, "units_per_line": units}

    def _normal(self, tags: Sequence[str], mean: float, sd: float, least: int, most: int) -> Table:
        """Map four elements; the numbers are the values of absent ones."""
        return {
            "distribution": "normal",
            "mean": self._block.number(tags[0], mean),
            "sd": self._block.number(tags[1], sd),
            "min": self._block.whole(tags[2], least),
            "max": self._block.whole(tags[3], most),
        }

    def _due(self) -> dict[str, Any]:
        block = self._block
        priority = {
            "urgent_share": block.number("DueTimePriorityOrderProbability", 0.2),
            "urgent_offset_s": block.number("DueTimePriorityOrder", 1800.0),
            "ordinary_offset_s": block.number("DueTimeOrdinaryOrder", 7200.0),
        }
        normal = {
            "mean_s": block.number("DueTimeOffsetMean", 10800.0),
            "sd_s": block.number("DueTimeOffsetStdDev", 900.0),
            "min_s": block.number("DueTimeOffsetMin", 7200.0),
            "max_s": block.number("DueTimeOffsetMax", 14400.0),
        }
        if block.switch("DueTimePriorityMode", default=True):
            return {"mode": "priority", **priority}
        return {"mode": "normal", **normal}

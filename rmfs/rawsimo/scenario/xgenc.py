"""Reader for RAWSim-O's SKU sets (.xgenc)."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from rmfs.errors import InputError
from rmfs.rawsimo.xml import read_root
from rmfs.scenario.skus.affinity import Affinity
from rmfs.scenario.skus.content import SkuFileContent

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path
    from xml.etree.ElementTree import Element

    from numpy.typing import NDArray

ROOT = "SimpleItemGeneratorConfiguration"

LISTS = ("ItemDescriptions", "ItemDescriptionWeights", "ItemDescriptionBundleSizes", "ItemWeights")
VALUES = ("DefaultWeight", "DefaultCoWeight", "ProbToUseCoWeight")
TEXTS = ("Name", "Description")


def read_xgenc(path: Path) -> SkuFileContent:
    """Read a SKU set; the colours of SKUs are ignored.

    Raises
    ------
    InputError
        If the file is missing or not a valid SKU set. The message is one line that names the
        file and the first error found, such as an unknown element or a SKU that is listed twice.
    """
    return _Reader(path).content()


class _Reader:
    def __init__(self, path: Path) -> None:
        self._path = path
        self._sections: dict[str, Element] = {}
        for section in read_root(path, ROOT):
            if section.tag not in (*LISTS, *VALUES, *TEXTS, "ItemCoWeights"):
                raise self._error(f"unknown element <{section.tag}>")
            if section.tag in self._sections:
                raise self._error(f"<{section.tag}> appears twice")
            self._sections[section.tag] = section
        ids = list(self._pairs("ItemDescriptions"))
        if not ids:
            raise self._error("<ItemDescriptions> lists no SKU")
        self._index = {sku: index for index, (sku, _) in enumerate(ids)}

    def content(self) -> SkuFileContent:
        bundle_units = self._complete("ItemDescriptionBundleSizes")
        if bundle_units is not None and (bundle_units % 1).any():
            raise self._error("<ItemDescriptionBundleSizes> must hold whole numbers")
        return SkuFileContent(
            ids=np.array(list(self._index), dtype=np.int64),
            popularity=self._popularity(),
            space_per_unit=self._complete("ItemDescriptionWeights"),
            bundle_units=None if bundle_units is None else bundle_units.astype(np.int64),
            affinity=self._affinity(),
        )

    def _popularity(self) -> NDArray[np.float64]:
        values = np.full(len(self._index), self._value("DefaultWeight", 1.0))
        for sku, value in self._pairs("ItemWeights"):
            values[self._known(sku)] = self._at_least_zero(value, "ItemWeights")
        if not values.any():
            raise self._error("no SKU has a positive popularity in <ItemWeights>")
        return values

    def _complete(self, section: str) -> NDArray[np.float64] | None:
        """Return the positive values of all SKUs in a list; None if it is missing or all zero."""
        values = np.zeros(len(self._index))
        for sku, value in self._pairs(section):
            values[self._known(sku)] = self._at_least_zero(value, section)
        if not values.any():
            return None
        if not values.all():
            sku = list(self._index)[int(np.argmin(values > 0))]
            raise self._error(f"<{section}> gives no positive value for SKU {sku}")
        return values

    def _affinity(self) -> Affinity | None:
        share = self._value("ProbToUseCoWeight", 0.0)
        if share > 1:
            raise self._error(f"<ProbToUseCoWeight> must be at most 1, not {share:g}")
        weights: dict[tuple[int, int], float] = {}
        for element in self._sections.get("ItemCoWeights", ()):
            first = self._known(self._whole(element, "Key1"))
            second = self._known(self._whole(element, "Key2"))
            value = self._at_least_zero(self._number(element, "Value"), "ItemCoWeights")
            weights[first, second] = value
        if not weights and share == 0:
            return None
        # a pair given in one direction only holds for both
        for (first, second), value in list(weights.items()):
            weights.setdefault((second, first), value)
        pairs = np.array(sorted(weights), dtype=np.int64).reshape(-1, 2)
        return Affinity(
            first=pairs[:, 0].copy(),
            second=pairs[:, 1].copy(),
            weight=np.array([weights[pair] for pair in sorted(weights)]),
            default_weight=self._value("DefaultCoWeight", 0.0),
            share=share,
        )

    def _pairs(self, section: str) -> Iterator[tuple[int, float]]:
        """Yield the pairs (SKU, value) of a list, in which each SKU may occur only once."""
        seen: set[int] = set()
        for element in self._sections.get(section, ()):
            sku = self._whole(element, "Key")
            if sku in seen:
                raise self._error(f"<{section}> lists SKU {sku} twice")
            seen.add(sku)
            yield sku, self._number(element, "Value")

    def _known(self, sku: int) -> int:
        """Index of a SKU."""
        try:
            return self._index[sku]
        except KeyError:
            raise self._error(f"SKU {sku} is not listed in <ItemDescriptions>") from None

    def _value(self, section: str, default: float) -> float:
        """Return the number in a top-level element; `default` if there is no such element."""
        element = self._sections.get(section)
        if element is None:
            return default
        return self._at_least_zero(self._parsed(element.text, section), section)

    def _at_least_zero(self, value: float, section: str) -> float:
        if value < 0:
            raise self._error(f"<{section}> must not be negative (given: {value:g})")
        return value

    def _whole(self, element: Element, tag: str) -> int:
        value = self._number(element, tag)
        if value % 1 or abs(value) > 2**53:
            raise self._error(f"<{tag}> must be a whole number (given: {value:g})")
        return int(value)

    def _number(self, element: Element, tag: str) -> float:
        return self._parsed(element.findtext(tag), tag)

    def _parsed(self, text: str | None, tag: str) -> float:
        try:
            value = float(text or "")
        except ValueError:
            value = math.nan
        if not math.isfinite(value):
            raise self._error(f"<{tag}> must be a finite number (given: {text!r:.40})")
        return value

    def _error(self, problem: str) -> InputError:
        return InputError(f"{self._path}: {problem}")

"""Where the SKUs come from: random distributions, a file, or the letters of a list of words."""

from __future__ import annotations

from typing import Annotated, Any

import pydantic
from pydantic import Field

from rmfs.scenario.counts import Counts, UniformCount
from rmfs.scenario.distributions import Constant, Gamma, Popularity, Space, Uniform
from rmfs.scenario.parameters.files import SkuSetFile, WordFile
from rmfs.scenario.quantities import Block, Count, Natural, NotNegative, Positive, Share

OWN_SEED = "seed of the SKUs, whatever the run's seed: all runs of a scenario share their SKUs"


class _Sizes(Block):
    seed: Natural = Field(0, description=OWN_SEED)
    space_per_unit: Space = Field(
        Uniform(min=2.0, max=8.0), description="space units that one unit of a SKU takes"
    )
    bundle_units: Counts = Field(
        UniformCount(min=4, max=12), description="units in a replenishment bundle of a SKU"
    )


class GeneratedAffinity(Block):
    """Random weights of pairs of SKUs, which determine which SKUs tend to be ordered together.

    Each SKU is a random point in the unit square. `pairs` pairs are drawn at random; the weight of
    a drawn pair is sqrt(2) minus the distance between its points. All other pairs have the weight
    `default_weight`.
    """

    share: Share = Field(
        description="probability that a line after the first is drawn by affinity instead of "
        "popularity"
    )
    pairs: Natural = Field(
        0, description="number of pairs of SKUs with a weight of their own, drawn at random"
    )
    default_weight: NotNegative = Field(0.2, description="weight of all other pairs")


class GeneratedSkus(_Sizes):
    """SKUs drawn from distributions.

    The seed of the SKUs is part of the scenario and independent of the seed of the run. All runs of
    a scenario therefore have the same SKUs, as they would with a SKU file, whereas stock and demand
    depend on the seed of the run.
    """

    count: Count = Field(1000, description="number of SKUs")
    popularity: Popularity = Field(
        Gamma(shape=1.0, scale=2.0, min=1.0),
        description="relative weight with which a SKU is ordered and replenished",
    )
    affinity: GeneratedAffinity | None = Field(
        None, description="which SKUs are ordered together; default: lines are independent"
    )

    @pydantic.field_validator("affinity")
    @classmethod
    def _enough_skus(
        cls, value: GeneratedAffinity | None, info: pydantic.ValidationInfo
    ) -> GeneratedAffinity | None:
        count = info.data.get("count")
        if value is not None and count is not None and value.pairs > count * (count - 1) // 2:
            raise ValueError(f"{count} SKUs have only {count * (count - 1) // 2} pairs")
        return value


class SkuFile(_Sizes):
    """SKUs from a file.

    Popularity and affinity come from the file. Space and bundle sizes also come from the file if it
    contains them; otherwise they are drawn as specified here.
    """

    file: SkuSetFile = Field(
        description="SKU set, relative to the scenario file: .json (rmfs-skus/1), .csv or "
        ".parquet (columns sku, popularity, space_per_unit, bundle_units), .xgenc or .xitem"
    )


class LetterSkus(_Sizes):
    """Letters in several colours as SKUs, as in the simulator Alphabet Soup.

    The letters are those of a list of words, and a SKU is a letter in one colour. How often a SKU
    is ordered depends on the words and on the weights of the colours.
    """

    words: WordFile = Field(
        description="text file with one word per line, relative to the scenario file"
    )
    colours: dict[str, Positive] = Field(
        {"blue": 1.0, "green": 1.0, "red": 1.0},
        min_length=1,
        max_length=100,
        description="relative weight of each colour",
    )
    space_per_unit: Space = Field(
        Constant(value=5.0), description="space units that one unit of a SKU takes"
    )
    bundle_units: Counts = Field(
        UniformCount(min=6, max=6), description="units in a replenishment bundle of a SKU"
    )


_SOURCES = {"file": SkuFile, "words": LetterSkus}


def _source(value: Any) -> str:
    """Return the name of the class that a table of SKUs describes."""
    if isinstance(value, GeneratedSkus | SkuFile | LetterSkus):
        return type(value).__name__
    given = value if isinstance(value, dict) else {}
    named = [source for key, source in _SOURCES.items() if key in given]
    return (named[0] if named else GeneratedSkus).__name__


Skus = Annotated[
    Annotated[GeneratedSkus, pydantic.Tag("GeneratedSkus")]
    | Annotated[SkuFile, pydantic.Tag("SkuFile")]
    | Annotated[LetterSkus, pydantic.Tag("LetterSkus")],
    pydantic.Discriminator(_source),
]

"""Small SKU sets and the folder of RAWSim-O's files, for the tests of scenarios."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from rmfs.scenario import SkuSet, sku_set
from rmfs.scenario.parameters import GeneratedSkus

REFERENCE = Path(__file__).resolve().parents[2] / "../shared/reference/instances"


@pytest.fixture
def reference() -> Path:
    if not REFERENCE.is_dir():
        pytest.skip("the reference instances are not here")
    return REFERENCE


@pytest.fixture(scope="session")
def skus() -> SkuSet:
    """The 1000 SKUs of the default scenario."""
    return sku_set(GeneratedSkus())


@pytest.fixture(scope="session")
def few_skus() -> SkuSet:
    """Five SKUs, the last of which is never ordered."""
    return SkuSet(
        ids=np.arange(5),
        popularity=np.array([4.0, 3.0, 2.0, 1.0, 0.0]),
        space_per_unit=np.array([1.0, 2.0, 3.0, 4.0, 5.0]),
        bundle_units=np.array([4, 4, 4, 4, 4]),
    )

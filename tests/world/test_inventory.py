"""The stock: how it is stored."""

from __future__ import annotations

import numpy as np
import pytest

from rmfs.world.inventory import Inventory


@pytest.mark.parametrize(("capacity", "bits"), [(30.0, 16), (40.0, 32)])
def test_a_pod_may_hold_more_than_two_bytes_can_count(capacity: float, bits: int) -> None:
    """Units of a thousandth: 40,000 of them fit into the larger pod."""
    made = Inventory(np.array([0.001]), np.array([capacity]), 1)
    units = round(capacity * 1000)
    made.stock(0, 0, units)
    assert made.contained.item(0, 0) == made.available.item(0, 0) == units
    assert made.contained.dtype.itemsize * 8 == bits

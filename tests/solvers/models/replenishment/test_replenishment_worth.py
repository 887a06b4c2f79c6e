"""What a bundle is worth in a pod: against sums over the Poisson distribution, and in words."""

from math import exp

import numpy as np
import pytest

from rmfs.solvers.models import ModelError
from rmfs.solvers.models.replenishment import bundle_worth_s
from rmfs.solvers.models.replenishment.worth import expected_served


def test_units_served_are_the_expectation_summed_term_by_term() -> None:
    for mean in (0.0, 0.3, 1.0, 4.5, 20.0):
        for units in range(12):
            probability, total = exp(-mean), 0.0
            for demand in range(120):
                total += min(units, demand) * probability
                probability *= mean / (demand + 1)
            served = expected_served(np.array(units), np.array(mean))
            assert float(served) == pytest.approx(total, abs=1e-9)


def worth(stock: list[list[int]], affinity: np.ndarray | None = None) -> np.ndarray:
    return bundle_worth_s(stock, [0], [4], [3.0, 3.0], affinity, visit_s=60.0, pile_on=2.0)


def test_the_more_a_pod_has_of_a_sku_the_less_more_of_it_is_worth() -> None:
    values = worth([[0, 2, 4, 8, 40], [0, 0, 0, 0, 0]])[0]
    assert (np.diff(values) < 0).all()
    # at most the four units, or the three wanted, at 30 s each
    assert 30.0 * 2.5 < values[0] < 30.0 * 3.0
    assert values[-1] == pytest.approx(0.0, abs=1e-9)


def test_a_pod_with_what_is_ordered_together_is_worth_more() -> None:
    affinity = np.array([[0.9, 0.5], [0.0, 0.0]])
    values = worth([[0, 0], [0, 1]], affinity)[0]
    # the affinity of a SKU to itself is no reason to bring it
    assert values == pytest.approx([worth([[0], [0]])[0, 0], 1.5 * worth([[0], [0]])[0, 0]])


def test_empty_and_invalid_input() -> None:
    none = bundle_worth_s(np.zeros((2, 3), int), [], [], [1.0, 1.0], visit_s=1.0, pile_on=1.0)
    assert none.shape == (0, 3)
    with pytest.raises(ModelError, match="sku"):
        bundle_worth_s([[1]], [1], [1], [1.0], visit_s=1.0, pile_on=1.0)
    with pytest.raises(ModelError, match="affinity"):
        bundle_worth_s([[1]], [0], [1], [1.0], [[-1.0]], visit_s=1.0, pile_on=1.0)
    with pytest.raises(ModelError, match="pile_on"):
        bundle_worth_s([[1]], [0], [1], [1.0], visit_s=1.0, pile_on=0.0)

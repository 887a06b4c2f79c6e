"""Compiled parts of rules, against the same in NumPy and plain Python."""

import numpy as np
import pytest

from rmfs.control.features import best_rows
from rmfs.traffic import _core as compiled

SEEDS = range(20)


@pytest.fixture(params=SEEDS)
def rng(request) -> np.random.Generator:
    return np.random.default_rng(request.param)


def orders(rng: np.random.Generator) -> tuple[np.ndarray, np.ndarray]:
    """SKUs and units of up to 30 orders with up to 4 lines."""
    shape = int(rng.integers(0, 30)), int(rng.integers(1, 5))
    units = rng.integers(0, 4, shape).astype(np.int32)
    return np.where(units > 0, rng.integers(0, 9, shape), 0), units


def test_orders_are_servable_if_no_line_is_short(rng) -> None:
    sku, units = orders(rng)
    stock = rng.integers(-1, 5, 9)
    expected = ~((stock[sku] < units) & (units > 0)).any(axis=1)
    np.testing.assert_array_equal(compiled.servable(sku, units, stock), expected)


def test_matches_are_what_pods_can_spare(rng) -> None:
    sku, units = orders(rng)
    inbound, need = rng.integers(0, 6, (2, 9)).astype(np.int32)
    expected = np.clip((inbound - need)[sku], 0, units).sum(axis=1)
    np.testing.assert_array_equal(compiled.matches(sku, units, inbound, need), expected)


def test_pods_complete_orders_one_after_another(rng) -> None:
    have = rng.integers(0, 5, (4, int(rng.integers(0, 8)))).astype(np.int32)
    wanted = [
        [(int(row), int(rng.integers(1, 4))) for row in rng.permutation(4)[: rng.integers(1, 4)]]
        for _ in range(6)
    ]
    expected = np.zeros((len(wanted), have.shape[1]), bool)
    for pod in range(have.shape[1]):
        left = have[:, pod].copy()
        for number, order in enumerate(wanted):
            if all(left[row] >= units for row, units in order):
                expected[number, pod] = True
                for row, units in order:
                    left[row] -= units
    np.testing.assert_array_equal(compiled.completed(have, wanted), expected)


def test_the_best_rows_are_those_of_a_stable_sort(rng) -> None:
    values = rng.integers(0, 4, (3, int(rng.integers(0, 60)))).astype(float)
    values[2, values[2] == 3] = np.inf
    weights = [(2, -0.5), (0, 2.0)]
    score = 2.0 * values[0] - 0.5 * np.minimum(values[2], 1e9)
    for k in (1, 8, 100):
        expected = np.argsort(-score, kind="stable")[:k]
        np.testing.assert_array_equal(best_rows(values, weights, k), expected)


def test_offered_features_are_scaled_clipped_and_in_their_columns(rng) -> None:
    values = rng.normal(0.0, 30.0, (3, int(rng.integers(0, 12))))
    scales, columns = np.array([1.0, 10.0, 0.5]), np.array([4, 0, 2])
    rows, found = compiled.offered(values, [(1, 1.0)], 5, scales, columns, 6, 10.0)
    np.testing.assert_array_equal(rows, best_rows(values, [(1, 1.0)], 5))
    expected = np.zeros((5, 6), np.float32)
    expected[: len(rows), columns] = (values / scales[:, None]).clip(-10.0, 10.0)[:, rows].T
    np.testing.assert_array_equal(found, expected)


@pytest.mark.parametrize("call", ["servable", "matches", "completed", "best_rows", "offered"])
def test_what_does_not_fit_is_refused(call) -> None:
    sku, units = np.array([[9]]), np.ones((1, 1), np.int32)
    few, values = np.zeros(9, np.int32), np.zeros((2, 3))
    calls = {
        "servable": lambda: compiled.servable(sku, units, few.astype(np.int64)),
        "matches": lambda: compiled.matches(sku, units, few, few),
        "completed": lambda: compiled.completed(few.reshape(3, 3), [[(3, 1)]]),
        "best_rows": lambda: compiled.best_rows(values, [(2, 1.0)], 1),
        "offered": lambda: compiled.offered(values, [], 1, np.ones(2), np.array([0, 6]), 6, 10.0),
    }
    with pytest.raises(ValueError, match=r"a line needs|an order needs|a weight is|every feature"):
        calls[call]()

"""Invalid inputs, broken plans, degenerate inputs."""

import numpy as np
import pytest

from rmfs.solvers.models import Limits, ModelError, Status
from rmfs.solvers.models.sequencing import (
    Sequencing,
    VisitSequence,
    beam,
    cp_sat,
    dynamic,
    violations,
)

METHODS = [dynamic, cp_sat, beam]


@pytest.mark.parametrize(
    ("fields", "named"),
    [
        ({"needs": [[1, 0], [0, 0]]}, "needs"),
        ({"needs": [[1, 2]]}, "needs[0, 1]"),
        ({"holds": [[1]]}, "holds"),
        ({"capacity": 0}, "capacity"),
        ({"opened": [1, 1]}, "opened"),
        ({"opened": [1]}, "opened"),
    ],
)
def test_an_invalid_field_is_named(fields: dict[str, object], named: str) -> None:
    valid: dict[str, object] = {"needs": np.eye(2), "holds": np.eye(2), "capacity": 1}
    with pytest.raises(ModelError) as error:
        Sequencing(**(valid | fields))  # type: ignore[arg-type]
    assert error.value.field == named


@pytest.mark.parametrize("method", METHODS)
def test_no_orders_need_no_visits(method: object) -> None:
    solution = method.solve(Sequencing(np.zeros((0, 3)), np.eye(3), 2))
    assert solution.status is Status.OPTIMAL
    assert solution.objective == 0.0
    assert solution.required.pods.size == 0


@pytest.mark.parametrize("method", METHODS)
def test_a_sku_on_no_pod_is_infeasible(method: object) -> None:
    solution = method.solve(Sequencing([[1, 1]], [[1, 0]], 1))
    assert solution.status is Status.INFEASIBLE
    assert solution.values is None
    assert method.solve(Sequencing([[1]], np.zeros((0, 1)), 1)).status is Status.INFEASIBLE


@pytest.mark.parametrize("method", METHODS)
def test_of_two_equal_pods_the_first_comes(method: object) -> None:
    data = Sequencing([[1, 1]], [[1, 0], [1, 1], [1, 1]], 1)
    assert method.solve(data).required.pods.tolist() == [1]


def test_violations_name_each_broken_rule() -> None:
    data = Sequencing([[1, 1], [1, 1]], np.eye(2), 1, [True, False])
    plans = {
        "open at the start": VisitSequence(np.array([0, 1]), np.array([0, -1])),
        "never opened": VisitSequence(np.array([0, 1]), np.array([-1, 5])),
        "never complete": VisitSequence(np.array([0, 1]), np.array([-1, 1])),
        "than slots at visit 0": VisitSequence(np.array([0, 1]), np.array([-1, 0])),
    }
    for text, plan in plans.items():
        assert any(text in line for line in violations(data, plan)), text
    assert violations(data, VisitSequence(np.array([0, 1, 0]), np.array([-1, 1]))) == []


@pytest.mark.parametrize("method", METHODS)
def test_a_start_that_is_not_feasible_is_refused(method: object) -> None:
    """It would look optimal: one visit instead of two."""
    data = Sequencing(np.eye(2), np.eye(2), 1)
    start = VisitSequence(np.array([0]), np.array([0, 0]))
    with pytest.raises(ModelError, match="start: order is never complete"):
        method.solve(data, Limits(iterations=0), start=start)

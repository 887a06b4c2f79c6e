"""Assignment and flow: against networkx, and their proofs of optimality."""

from math import inf

import networkx as nx
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from rmfs.solvers.models import ModelError
from rmfs.solvers.models.backends.assignment import assign, assignment_bound
from rmfs.solvers.models.backends.flow import Network, flow_bound, min_cost_flow
from rmfs.solvers.models.checks import costs


def random_network(seed: int) -> Network:
    """A few nodes, parallel and opposite arcs, costs of any sign in eighths."""
    rng = np.random.default_rng(seed)
    nodes, arcs = int(rng.integers(2, 7)), int(rng.integers(0, 16))
    tail = rng.integers(0, nodes, arcs)
    supply = rng.integers(-3, 4, nodes)
    supply[-1] -= supply.sum()
    return Network(
        tail,
        (tail + rng.integers(1, nodes, arcs)) % nodes,
        rng.integers(0, 5, arcs),
        rng.integers(-40, 160, arcs) / 8,
        supply,
    )


def by_networkx(network: Network) -> float:
    """Cost of the best flow in eighths; inf if there is none."""
    graph = nx.MultiDiGraph()
    for node, supply in enumerate(network.supply.tolist()):
        graph.add_node(node, demand=-supply)
    for tail, head, capacity, cost in zip(
        network.tail, network.head, network.capacity, network.cost, strict=True
    ):
        graph.add_edge(int(tail), int(head), capacity=int(capacity), weight=round(cost * 8))
    try:
        return float(nx.network_simplex(graph)[0]) / 8
    except nx.NetworkXUnfeasible:
        return inf


def test_flows_are_optimal_and_proven() -> None:
    infeasible = 0
    for seed in range(400):
        network = random_network(seed)
        best, flow = by_networkx(network), min_cost_flow(network)
        if flow is None:
            infeasible += 1
            assert best == inf
            continue
        net = np.zeros(len(network.supply), np.int64)
        np.add.at(net, network.tail, flow.units)
        np.add.at(net, network.head, -flow.units)
        assert (net == network.supply).all()
        assert ((flow.units >= 0) & (flow.units <= network.capacity)).all()
        assert float(flow.units @ network.cost) == pytest.approx(best)
        assert best - 1e-6 <= flow.bound <= best
    assert 50 < infeasible < 350


def test_costs_that_are_no_whole_millionths_are_bounded_safely() -> None:
    for seed in range(100):
        rng = np.random.default_rng(seed)
        network = random_network(seed)
        odd = Network(
            network.tail,
            network.head,
            network.capacity,
            rng.uniform(0, 10, len(network.tail)) / 3.0,
            network.supply,
        )
        flow = min_cost_flow(odd)
        if flow is not None:
            assert flow.bound <= float(flow.units @ odd.cost) <= flow.bound + 1e-4


@given(st.integers(0, 399), st.lists(st.floats(-1e3, 1e3), min_size=7, max_size=7))
@settings(max_examples=150, deadline=None, derandomize=True)
def test_any_potentials_give_a_bound(seed: int, potentials: list[float]) -> None:
    network = random_network(seed)
    best = by_networkx(network)
    assert flow_bound(network, np.array(potentials[: len(network.supply)])) <= best


def test_huge_costs_are_scaled_down_not_overflown() -> None:
    cost = np.array([1e12, 2e12])
    network = Network(np.array([0, 0]), np.array([1, 1]), np.array([1, 1]), cost, np.array([1, -1]))
    flow = min_cost_flow(network)
    assert flow is not None
    assert flow.units.tolist() == [1, 0]
    assert flow.bound == pytest.approx(1e12)


def test_an_assignment_bound_holds_for_any_assignment_and_proves_the_best() -> None:
    for seed in range(200):
        rng = np.random.default_rng(seed)
        rows = int(rng.integers(1, 6))
        cost = rng.uniform(-50, 50, (rows, rows + int(rng.integers(0, 4))))
        best = assign(cost)
        assert best is not None
        value = float(cost[range(rows), best.column].sum())
        assert value - 1e-9 <= best.bound <= value
        other = rng.permutation(cost.shape[1])[:rows]
        assert assignment_bound(cost, other) <= value + 1e-9


def test_the_cheapest_pair_first_may_be_a_dead_end() -> None:
    assert assign(np.array([[1.0, 2.0], [1.0, inf]])).column.tolist() == [1, 0]  # type: ignore[union-attr]


def test_more_rows_than_columns_cannot_be_assigned() -> None:
    for solver in ("scipy", "min_cost_flow"):
        assert assign(np.zeros((2, 1)), solver) is None  # type: ignore[arg-type]


def test_costs_may_be_infinite_but_not_undefined() -> None:
    assert np.array_equal(costs("c", [[1, inf]], (1, 2)), [[1.0, inf]])
    for wrong in ([[np.nan]], [[-inf]], [["a"]], [[-1.0]]):
        with pytest.raises(ModelError, match="c"):
            costs("c", wrong, (1, 1), low=0)
    with pytest.raises(ModelError, match="shape"):
        costs("c", [1.0], (1, 1))


@pytest.mark.parametrize("unit", [1.0, 1e-7, 1e-12])
@pytest.mark.parametrize("dear", [0, 1])
def test_flows_take_the_cheaper_arc_however_small_its_cost(unit: float, dear: int) -> None:
    """Of two arcs between two nodes, one costs a third less."""
    cost = np.array([2.0, 2.0]) * unit
    cost[dear] = 3.0 * unit
    ends, one = np.zeros(2, np.int64), np.ones(2, np.int64)
    flow = min_cost_flow(Network(ends, ends + 1, one, cost, np.array([1, -1])))
    assert flow.units[dear] == 0
    assert flow.bound == pytest.approx(2.0 * unit, rel=1e-5)

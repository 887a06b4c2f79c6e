"""Every back end against enumeration on random small integer programs."""

from dataclasses import replace
from itertools import product

import numpy as np
import pytest

from rmfs.solvers.models import Limits, ModelError, Solution, Status, WallGuardError
from rmfs.solvers.models.backends import clarabel, cp_sat, highs
from rmfs.solvers.models.backends.backend import with_relaxed_bound
from rmfs.solvers.models.backends.safe_bound import safe_bound
from rmfs.solvers.models.checks import integers
from rmfs.solvers.models.program import LinearProgram, ProgramBuilder

BACKENDS = {"cp_sat": cp_sat.solve, "highs": highs.solve}


def random_program(seed: int) -> LinearProgram:
    """Up to 6 small integer columns, up to 4 rows with either or both bounds; often infeasible."""
    rng = np.random.default_rng(seed)
    n, m = int(rng.integers(1, 7)), int(rng.integers(0, 5))
    builder = ProgramBuilder()
    lower = rng.integers(0, 2, n)
    columns = builder.columns(
        n, cost=rng.integers(-40, 40, n) / 8, lower=lower, upper=lower + rng.integers(0, 3, n)
    )
    for _ in range(m):
        middle = rng.integers(-3, 9)
        low = middle - rng.integers(0, 3) if rng.random() < 0.6 else -np.inf
        high = middle + rng.integers(0, 3) if rng.random() < 0.6 else np.inf
        builder.rows(1, (0, columns, rng.integers(-3, 4, n)), lower=low, upper=high)
    return builder.build(offset=float(rng.integers(-3, 4)))


def enumerate_best(program: LinearProgram) -> float:
    """Smallest objective over all whole points of the box; inf if none is feasible."""
    boxes = [range(int(a), int(b) + 1) for a, b in zip(program.lower, program.upper, strict=True)]
    points = (np.array(p, dtype=float) for p in product(*boxes))
    return min((program.objective(p) for p in points if program.violation(p) == 0), default=np.inf)


@pytest.mark.parametrize("backend", BACKENDS)
def test_back_ends_find_the_enumerated_optimum(backend: str) -> None:
    infeasible = 0
    for seed in range(150):
        program = random_program(seed)
        best = enumerate_best(program)
        outcome = BACKENDS[backend](program)
        if np.isinf(best):
            infeasible += 1
            assert outcome.status is Status.INFEASIBLE
            assert outcome.x is None
        else:
            assert outcome.status is Status.OPTIMAL
            assert program.violation(outcome.x) == 0
            assert program.objective(outcome.x) == pytest.approx(best, abs=1e-9)
            assert best - 1e-5 * max(1, abs(best)) <= outcome.bound <= best + 1e-12
    assert 10 < infeasible < 120


def test_the_relaxation_bounds_the_integer_optimum_and_is_the_lp_optimum() -> None:
    compared = 0
    for seed in range(60):
        program = random_program(seed)
        best = enumerate_best(program)
        relaxed, simplex = clarabel.relax(program), highs.relax(program)
        interior = highs.relax(program, interior=True)
        assert relaxed.bound <= best
        assert simplex.bound <= best
        assert interior.bound <= best
        lp = highs.solve(continuous(program))
        if lp.status is Status.OPTIMAL:
            compared += 1
            assert relaxed.bound == pytest.approx(program.objective(lp.x), abs=1e-5)
            assert simplex.bound == pytest.approx(program.objective(lp.x), abs=1e-9)
            assert interior.bound == pytest.approx(program.objective(lp.x), abs=1e-5)
    assert compared > 20


def continuous(program: LinearProgram) -> LinearProgram:
    return LinearProgram(
        **{
            field: getattr(program, field)
            for field in LinearProgram.__dataclass_fields__
            if field != "integer"
        },
        integer=np.zeros(program.columns, dtype=bool),
    )


def test_any_multipliers_give_a_valid_bound() -> None:
    rng = np.random.default_rng(7)
    for seed in range(150):
        program = random_program(seed)
        best = enumerate_best(program)
        for _ in range(5):
            y = rng.normal(scale=10.0 ** rng.integers(-2, 3), size=program.rows)
            assert safe_bound(program, y) <= best
        assert safe_bound(program, np.full(program.rows, np.nan)) <= best


def test_a_compiled_relaxation_is_reused_for_other_numbers_of_the_same_pattern() -> None:
    def knapsack(values: list[float], weights: list[float], room: float) -> LinearProgram:
        builder = ProgramBuilder()
        x = builder.columns(3, cost=[-v for v in values])
        builder.rows(1, (0, x, weights), upper=room)
        return builder.build()

    first = knapsack([3, 2, 1], [1, 1, 1], 2)
    relaxation = clarabel.LinearRelaxation(first)
    assert relaxation.solve(first).bound == pytest.approx(-5, abs=1e-6)
    other = knapsack([3, 2, 4], [1, 2, 2], 3)
    assert relaxation.fits(other)
    assert relaxation.solve(other).bound == pytest.approx(-7, abs=1e-6)
    wider = ProgramBuilder()
    wider.columns(4)
    assert not relaxation.fits(wider.build())
    with pytest.raises(ModelError, match="pattern"):
        relaxation.solve(wider.build())


@pytest.mark.parametrize("backend", BACKENDS)
def test_a_program_without_columns_is_answered(backend: str) -> None:
    empty = ProgramBuilder().build(offset=3.0)
    outcome = BACKENDS[backend](empty)
    assert outcome.status is Status.OPTIMAL
    assert outcome.bound == 3.0
    impossible = ProgramBuilder()
    impossible.rows(1, lower=1)
    assert BACKENDS[backend](impossible.build()).status is Status.INFEASIBLE


def hard_program() -> LinearProgram:
    """A multi-dimensional knapsack that takes long to prove."""
    rng = np.random.default_rng(1)
    n, m = 120, 12
    weight = rng.integers(5, 100, (m, n))
    builder = ProgramBuilder()
    x = builder.columns(n, cost=-(weight.sum(axis=0) + rng.integers(0, 40, n)) / 4)
    row, column = np.indices((m, n))
    builder.rows(m, (row, x[column], weight), upper=weight.sum(axis=1) // 3)
    return builder.build()


@pytest.mark.parametrize(
    ("backend", "limits"),
    [("cp_sat", Limits(deterministic_s=0.05)), ("highs", Limits(nodes=20))],
)
def test_a_limit_ends_the_search_at_the_same_place_every_time(backend: str, limits: Limits) -> None:
    program = hard_program()
    outcomes = [BACKENDS[backend](program, limits) for _ in range(3)]
    first = outcomes[0]
    assert first.status in (Status.FEASIBLE, Status.LIMIT)
    for other in outcomes[1:]:
        assert (other.bound, other.work, other.status) == (first.bound, first.work, first.status)
        assert np.array_equal(other.x, first.x) if first.x is not None else other.x is None


@pytest.mark.parametrize("backend", BACKENDS)
def test_a_start_is_never_lost(backend: str) -> None:
    program = hard_program()
    good = BACKENDS["highs"](program, Limits(nodes=50)).x
    limits = Limits(deterministic_s=0.02, nodes=0)
    outcome = BACKENDS[backend](program, limits, start=good)
    assert outcome.x is not None
    assert program.objective(outcome.x) <= program.objective(good)


@pytest.mark.parametrize("backend", BACKENDS)
def test_the_wall_guard_raises_and_returns_nothing(backend: str) -> None:
    with pytest.raises(WallGuardError):
        BACKENDS[backend](hard_program(), Limits(wall_guard_s=0.02))


def test_cp_sat_names_the_number_that_is_not_whole() -> None:
    builder = ProgramBuilder()
    x = builder.columns(2)
    builder.rows(1, (0, x, [0.5, 1.0]), upper=1)
    with pytest.raises(ModelError, match="coefficient"):
        cp_sat.solve(builder.build())
    fractional = ProgramBuilder()
    fractional.columns(1, integer=False)
    with pytest.raises(ModelError, match="integer"):
        cp_sat.solve(fractional.build())


def test_costs_of_any_size_are_compared() -> None:
    """Costs far below 1/1024 are no zeros to CP-SAT: the cheaper of two columns is chosen."""
    for unit in (1.0, 1e-3, 1e-6, 1e-9, 1e-200):
        builder = ProgramBuilder()
        columns = builder.columns(2, cost=[3 * unit, 2 * unit])
        builder.rows(1, (0, columns, 1.0), lower=1.0)
        outcome = cp_sat.solve(builder.build())
        assert outcome.x.tolist() == [0.0, 1.0]
        assert 2 * unit * (1 - 1 / 512) <= outcome.bound <= 2 * unit


def test_highs_refuses_coefficients_that_its_tolerance_blurs() -> None:
    """A millionth of a column, which counts as 0, times 4e10 would be 40,000 units."""
    builder = ProgramBuilder()
    columns = builder.columns(2)
    builder.rows(1, (0, columns, [4e10, 1.0]), lower=1.0)
    with pytest.raises(ModelError, match=r"coefficient: is 4\.0e\+10"):
        highs.solve(builder.build())


def test_a_search_stopped_at_once_says_so_if_the_relaxation_proves_there_is_nothing() -> None:
    """Three rows want a column of their own, but there are two; the search may not begin."""
    builder = ProgramBuilder()
    columns = builder.columns((3, 2), upper=[[1.0, 1.0], [1.0, 0.0], [1.0, 0.0]])
    builder.rows(3, (np.arange(3)[:, None], columns, 1.0), lower=1.0)
    builder.rows(2, (np.arange(2), columns, 1.0), upper=1.0)

    def stopped(program, limits, *, seed, start):
        return replace(cp_sat.solve(program, limits), x=None, bound=-np.inf, status=Status.LIMIT)

    outcome = with_relaxed_bound(stopped)(builder.build(), Limits(), seed=0, start=None)
    assert (outcome.status, outcome.bound) == (Status.INFEASIBLE, np.inf)


@pytest.mark.parametrize("value", [1e30, 2**64 - 1, 2.0**63])
def test_whole_numbers_too_large_for_the_computer_are_refused(value: float) -> None:
    with pytest.raises(ModelError, match="units: must be below"):
        integers("units", [value], (None,))


def test_limits_of_counts_are_whole() -> None:
    assert Limits(nodes=2.0).nodes == 2
    for field in ("nodes", "iterations"):
        with pytest.raises(ModelError, match=f"limits.{field}: must hold whole numbers"):
            Limits(**{field: 2.5})


def test_the_gap_at_an_optimum_of_nothing_is_nothing() -> None:
    """HiGHS states -1e-6 as the bound of 0: that is not a gap of 100,000 %."""
    values = {"values": 0, "status": Status.OPTIMAL, "backend": "highs"}
    assert Solution(objective=0.0, bound=-1e-6, **values).gap == 0.0
    assert Solution(objective=1e-3, bound=0.0, **values).gap == 1.0
    assert Solution(objective=2.0, bound=1.0, **values).gap == 0.5


@pytest.mark.parametrize("backend", BACKENDS)
def test_the_gap_limit_is_relative_to_the_objective_with_its_offset(backend: str) -> None:
    """Most of the offset is earned back, so 5 % of the objective is far less than 5 % of that."""
    for seed in range(10):
        rng = np.random.default_rng(seed)
        builder = ProgramBuilder()
        columns = builder.columns(30, cost=-rng.integers(100, 140, 30))
        rows = np.arange(3)[:, None]
        builder.rows(3, (rows, columns, rng.integers(1, 30, (3, 30))), upper=200)
        program = builder.build(offset=2500.0)
        outcome = BACKENDS[backend](program, Limits(gap=0.05))
        assert outcome.status is Status.OPTIMAL
        value = program.objective(outcome.x)
        assert value - outcome.bound <= 0.0501 * abs(value)

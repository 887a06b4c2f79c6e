"""Searches for better values and bounds of questions, with more work in every round."""

from __future__ import annotations

import os
from dataclasses import dataclass
from time import monotonic, sleep
from typing import TYPE_CHECKING

from rmfs.errors import InputError
from rmfs.solvers.decisions.bounding import best as best_bound
from rmfs.solvers.decisions.files import read
from rmfs.solvers.decisions.library.table import OPTIMAL
from rmfs.solvers.decisions.profiling import UNLIMITED
from rmfs.solvers.decisions.solving import solve
from rmfs.solvers.models import WallGuardError

if TYPE_CHECKING:
    from collections.abc import Callable, Collection, Iterator

    from rmfs.solvers.decisions.files import Decision
    from rmfs.solvers.decisions.library.table import Library, Row

METHODS = {
    "pile_on": ("greedy", "hadgs", "joint", "neighbourhood", "cp_sat"),
    "planning": ("greedy", "lns", "highs", "cp_sat"),
    "sequencing": ("beam", "cp_sat"),
    "rack_allocation": ("greedy", "cp_sat"),
    "placement": ("assignment",),
    "stays": ("greedy", "cp_sat", "highs"),
    "charging": ("greedy", "highs"),
    "zones": ("clarabel",),
    "matching": ("assignment",),
    "balance": ("flow",),
    "sequence": ("greedy", "lns", "columns", "cp_sat"),
    "replenishment": ("greedy", "rounding", "cp_sat", "highs"),
    "run_bound": ("highs",),
}
"""Methods that search for answers, in this sequence."""

STEPS = {"lns": 20_000.0, "beam": 400.0, "hadgs": 400.0, "highs": 100.0}
"""Limit of the first round for methods that count steps or nodes; others get `work` seconds."""

STEPS_OF = {"planning": {"lns": 40_000.0, "highs": 10.0}}
"""Exceptions to `STEPS`, for families whose steps take microseconds or whose nodes take seconds."""

LARGEST_EXACT = {"planning": 60_000}
"""Size (pods times lines times stations) above which the exact program is not searched."""


@dataclass(frozen=True)
class Effort:
    """Limits of a search for better values and bounds.

    Attributes
    ----------
    work
        Deterministic seconds of each search in the first round, for methods that count them; for
        the others see `STEPS`. Each further round quadruples the limits of all methods.
    rounds
        Number of rounds.
    seconds
        Wall time in s after which no further question is taken up.
    guard_s
        Wall time in s after which a single search is given up.
    load
        Load average of the machine above which no question is taken up until the load has fallen;
        infinite: no limit.
    """

    work: float = 1.0
    rounds: int = 1
    seconds: float = float("inf")
    guard_s: float = 120.0
    load: float = float("inf")


def improve(
    library: Library,
    effort: Effort,
    families: Collection[str] = (),
    sizes: Collection[str] = (),
    tell: Callable[[str], None] = print,
) -> int:
    """Search for better values and bounds of questions without a proven optimum.

    Parameters
    ----------
    library
        The library, in which improvements are entered.
    effort
        Limits of the search.
    families, sizes
        Families and sizes of the questions. Default: all.
    tell
        Function that is called with a line of text about each question after its searches, and
        about each search that fails.

    Returns
    -------
    Number of improvements of a value or a bound.
    """
    until, count = monotonic() + effort.seconds, 0
    for number in range(effort.rounds):
        for name in sorted(library.rows, key=lambda name: _urgency(library.rows[name])):
            row = library.rows[name]
            asked = (not families or row.family in families) and (not sizes or row.size in sizes)
            if not asked or row.status == OPTIMAL:
                continue
            if not _wait(effort, until):
                return count
            count += _tried(library, row, effort, number, until, tell)
    return count


def _urgency(row: Row) -> tuple[float, str, str]:
    """Sort key of the questions: by size, the smallest first, then by family and name."""
    size = {"small": 1.0, "medium": 2.0, "real": 3.0, "double": 4.0}.get(row.size, 5.0)
    return size, row.family, row.question


def _wait(effort: Effort, until: float) -> bool:
    """Wait until the load of the machine is low enough; return whether there is time left."""
    while os.getloadavg()[0] > effort.load and monotonic() < until:
        sleep(5.0)
    return monotonic() < until


def _tried(
    library: Library,
    row: Row,
    effort: Effort,
    number: int,
    until: float,
    tell: Callable[[str], None],
) -> int:
    decision = read(library.path(row))
    count = 0
    if decision.recorded is not None:
        count += len(library.enter(decision, decision.recorded, "recorded in the run"))
    for method, work in _searches(decision, effort, number):
        now = library.rows[row.question]
        if now.status == OPTIMAL or monotonic() > until:
            break
        start = library.answer(now, decision)
        try:
            found = solve(
                decision, method, work=work, seed=number, start=start, guard_s=effort.guard_s
            )
        except (WallGuardError, InputError) as error:
            tell(f"{row.question}: {method}: {error}")
            continue
        by = method if method in UNLIMITED else f"{method} {work:g}"
        better = library.enter(decision, found, by, found.bound)
        count += len(better)
    if library.rows[row.question].status != OPTIMAL:
        work, search = effort.work * 4**number, _is_searched(decision)
        who, bound = best_bound(decision, work, guard_s=effort.guard_s, search=search)
        if who:
            count += len(library.enter(decision, None, f"{who} {work:g}", bound))
    now = library.rows[row.question]
    tell(f"{now.size} {now.question}: value {now.value:.10g}, gap {now.gap:.2%}, {now.status}")
    return count


def _searches(decision: Decision, effort: Effort, number: int) -> Iterator[tuple[str, float]]:
    """Yield methods and limits of a round; methods that ignore limits only in the first round."""
    for method in METHODS[decision.family]:
        if method in UNLIMITED and number:
            continue
        if method in ("cp_sat", "highs") and not _is_searched(decision):
            continue
        first = STEPS | STEPS_OF.get(decision.family, {})
        yield method, first.get(method, effort.work) * 4**number


def _is_searched(decision: Decision) -> bool:
    """Whether the exact program is small enough to be searched."""
    most = LARGEST_EXACT.get(decision.family)
    if most is None:
        return True
    n = decision.sizes
    return n["P"] * n["S"] * int(decision.data["visits"]) + n["L"] * n["S"] * 4 <= most

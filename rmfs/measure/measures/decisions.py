"""Measures of decisions: their number, sources and wall time, and questions to optimisers."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from rmfs.measure.base import Measure
from rmfs.measure.columns import INTEGER, LESS, NEITHER, REAL, Column
from rmfs.measure.measures.reckoning import ratio

if TYPE_CHECKING:
    from rmfs.measure.ended import EndedRun

SOURCES = {
    "optimiser": "based on solutions of optimisers",
    "heuristic": "that controllers with optimisers made by their own rules, except those counted "
    "as failed",
    "stale": "proposed by optimisers but not applied, because they were no longer valid",
    "failed": "that controllers made by their own rules because an optimiser failed or found "
    "nothing",
}
"""Sources of decisions in runs with optimisers, each with its description."""


class Decisions(Measure):
    """Number of decisions, wall time of controllers, and shares of decisions by their source.

    A source is, for example, the solution of an optimiser, or a controller's own rule.
    """

    columns = (
        Column("decisions", INTEGER, "decisions", "Decisions made by all controllers"),
        Column(
            "decision_wall_s",
            REAL,
            "s",
            "Wall time of all calls of controllers, including calls in which no decision was made",
            measured=True,
            better=LESS,
        ),
        *(
            Column(
                f"{source}_decision_share",
                REAL,
                "share",
                f"Decisions {what}, as a share of the decisions of all four kinds (optimiser, "
                "heuristic, stale, failed); empty without optimisers",
                better=LESS if source in ("stale", "failed") else NEITHER,
            )
            for source, what in SOURCES.items()
        ),
    )

    def footprint(self, run: EndedRun) -> dict[str, Any]:
        """Return number of decisions, wall time of controllers, and share of each source."""
        controllers = run.tables["controllers"]
        counts = {source: int(controllers[f"{source}_decisions"].sum()) for source in SOURCES}
        total = sum(counts.values())
        return {
            "decisions": int(run.tables["decisions"]["decisions"].sum()),
            "decision_wall_s": sum(wall_s for _, wall_s in run.recorder.asked.values()),
            **{f"{source}_decision_share": ratio(n, total) for source, n in counts.items()},
        }


class Optimisers(Measure):
    """Questions to optimisers: number, failures, optimality gaps, and times until the answers."""

    columns = (
        Column("optimiser_calls", INTEGER, "calls", "Questions to optimisers"),
        Column(
            "optimiser_gap_mean",
            REAL,
            "share",
            "Mean relative gap of the optimisers' solutions: the difference between value and "
            "bound, divided by the cost of the pods called (pile-on models) or by the absolute "
            "value (other models); empty if no gap is known",
            better=LESS,
        ),
        Column(
            "optimiser_gap_abs_mean",
            REAL,
            "",
            "Mean of abs(value - bound) of the optimisers' solutions, in the unit of the "
            "objectives (seconds for most models)",
            better=LESS,
        ),
        Column(
            "paced_s",
            REAL,
            "s",
            "Total simulated time from questions to optimisers until their answers took effect",
            better=LESS,
        ),
        Column(
            "optimiser_failures",
            INTEGER,
            "calls",
            "Questions whose optimiser crashed, hung or raised an error",
            better=LESS,
        ),
        Column(
            "optimiser_wall_s",
            REAL,
            "s",
            "Total wall time that optimisers took for their answers",
            measured=True,
            better=LESS,
        ),
        Column(
            "optimiser_wall_median_s",
            REAL,
            "s",
            "Median wall time that an optimiser took for an answer",
            measured=True,
            better=LESS,
        ),
    )

    def footprint(self, run: EndedRun) -> dict[str, Any]:
        """Return numbers of questions and failures, mean optimality gaps, and times until answers.

        These times are given both as simulated time and as wall time.
        """
        decisions = run.tables["decisions"]
        asked = decisions[decisions["source"] == "optimiser"]
        return {
            "optimiser_calls": len(asked),
            "optimiser_gap_mean": asked["gap"].mean(),
            "optimiser_gap_abs_mean": asked["gap_abs"].mean(),
            "paced_s": asked["paced_s"].sum(),
            "optimiser_failures": int((asked["outcome"] == "failed").sum()),
            "optimiser_wall_s": asked["wall_s"].sum(),
            "optimiser_wall_median_s": asked["wall_s"].median(),
        }

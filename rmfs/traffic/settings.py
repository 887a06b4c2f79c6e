"""Settings of the core's path planner."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from rmfs.traffic.guidance import GuidedEdges
    from rmfs.traffic.planner import PathPlanner

COST_TABLE_BYTES = 256_000_000
EXPANSION_BUDGET = 50_000
"""Maximum number of labels of a search for one leg. If it would need more, the leg starts only
after all motion planned so far has ended."""


class PlannerSettings(NamedTuple):
    """Settings of a path planner of the core.

    Attributes
    ----------
    name
        Name of the planner, as in a controllers file.
    parameters
        All its parameters; durations in seconds, switches as 0 and 1.
    seed
        Seed of its random decisions.
    code
        The planner itself, if it is written in Python (`rmfs.traffic.planner`).
    guidance
        Edges with an extra cost: their waypoints, and the cost in s (`rmfs.traffic.guidance`).
    """

    name: str
    parameters: dict[str, float]
    seed: int = 0
    code: PathPlanner | None = None
    guidance: GuidedEdges = ()


TIME_WINDOWS = PlannerSettings(
    "time-windows",
    {"labels": EXPANSION_BUDGET, "improve_labels": 0, "swift": 0, "swift_from": 300},
)

"""Number and duration of calls of controllers."""

from __future__ import annotations

from array import array
from dataclasses import dataclass, field


@dataclass(slots=True)
class DecisionStatistics:
    """Calls of the controllers of one decision problem; calls in the warm-up are not kept.

    Attributes
    ----------
    problem
        The decision problem, as in a controllers file.
    name
        Name of the currently installed controller.
    decisions
        Number of decisions made in all calls.
    last_s
        Simulated time of the last decision in s, even if it was made in the warm-up; -1 if there
        was none.
    wall_ns
        Wall time of each call in ns, excluding the time of controllers consulted during the call.
    """

    problem: str
    name: str
    decisions: int = 0
    last_s: float = -1.0
    wall_ns: array[int] = field(default_factory=lambda: array("q"))

    @property
    def calls(self) -> int:
        """Number of calls."""
        return len(self.wall_ns)

    @property
    def wall_s(self) -> float:
        """Total wall time of all calls, in s."""
        return sum(self.wall_ns) / 1e9

    def count(self, decisions: int, now_s: float) -> None:
        """Count the decisions of a call."""
        self.last_s = now_s
        self.decisions += decisions

    def reset(self) -> None:
        """Forget all calls, at the end of the warm-up; `last_s` is kept."""
        self.decisions = 0
        self.wall_ns = array("q")

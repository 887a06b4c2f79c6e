"""How often controllers are asked, and how long they take."""

from __future__ import annotations

from array import array
from dataclasses import dataclass, field

import numpy as np


@dataclass(slots=True)
class DecisionStatistics:
    """Calls of the controllers of one problem.

    Attributes
    ----------
    problem
        The decision problem, as in a controllers file.
    name
        The rule now installed.
    decisions
        Decisions given in all calls.
    last_s
        When it last decided something, simulated; -1 for never.
    wall_ns
        Wall time of each call, without the time in which other controllers were consulted.
    """

    problem: str
    name: str
    decisions: int = 0
    last_s: float = -1.0
    wall_ns: array[int] = field(default_factory=lambda: array("q"))

    @property
    def calls(self) -> int:
        """How often the controller was asked."""
        return len(self.wall_ns)

    @property
    def wall_s(self) -> float:
        """Wall time of all calls."""
        return sum(self.wall_ns) / 1e9

    def wall_quantile_s(self, share: float) -> float:
        """Wall time that this share of the calls did not exceed; nan without calls."""
        return float(np.quantile(self.wall_ns, share)) / 1e9 if self.wall_ns else float("nan")

    def record(self, wall_ns: int, decisions: int, now_s: float) -> None:
        """Add one call."""
        if decisions:
            self.last_s = now_s
        self.wall_ns.append(wall_ns)
        self.decisions += decisions

    def reset(self) -> None:
        """Forget all calls (end of the warm-up)."""
        self.decisions = 0
        self.wall_ns = array("q")

"""Pacing: what an optimiser's thinking costs in simulated time (design: section 5).

A rule decides at once. A controller that asks an optimiser is told the answer later: how much
later, the pacing says, and it is the pacing that has the question solved.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Protocol

from rmfs.simulation.pacing.computed import Fixed, Instant, Work
from rmfs.simulation.pacing.errors import OptimiserError as OptimiserError
from rmfs.simulation.pacing.errors import ReplayError as ReplayError
from rmfs.simulation.pacing.replay import Replay as Replay
from rmfs.simulation.pacing.settings import FixedPacing as FixedPacing
from rmfs.simulation.pacing.settings import InstantPacing as InstantPacing
from rmfs.simulation.pacing.settings import PacingSettings as PacingSettings
from rmfs.simulation.pacing.settings import ReplayPacing as ReplayPacing
from rmfs.simulation.pacing.settings import WallPacing as WallPacing
from rmfs.simulation.pacing.settings import WorkPacing as WorkPacing
from rmfs.simulation.pacing.settings import pacing_settings as pacing_settings
from rmfs.simulation.pacing.wall import Wall

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

    from rmfs.control.asks import Call

    Return = Callable[[Call, int], None]
    """Told which call has come back, and at which simulated time (us) that takes effect."""


class Pacing(Protocol):
    """Has questions solved, and says when each answer takes effect.

    Attributes
    ----------
    waits
        Whether a solver may be at work while the simulation goes on.
    """

    waits: bool

    def begin(self, modules: Iterable[str], give: Return) -> None:
        """Get ready, before the clock counts.

        Parameters
        ----------
        modules
            Modules with the functions that will solve the questions.
        give
            To be called for each question once: also at once, from within `ask`.
        """
        ...

    def ask(self, call: Call) -> None:
        """Begin to solve a question."""
        ...

    def limit_us(self, now_us: int) -> int:
        """Latest simulated time that may be simulated now; waits until it is past `now_us`."""
        ...

    def end(self) -> None:
        """Let go of whatever is held; questions that are not answered are given up."""
        ...


Paced = InstantPacing | WallPacing | WorkPacing | FixedPacing | Replay
"""A mode with its parameters; for a replay the answers that were read from its run."""


def pacing_of(settings: Paced, seed: int) -> Pacing:
    """Make the pacing of a run.

    Parameters
    ----------
    settings
        Mode and parameters.
    seed
        The run's seed.
    """
    match settings:
        case InstantPacing():
            return Instant()
        case WallPacing():
            return Wall(settings)
        case WorkPacing():
            return Work(settings)
        case FixedPacing():
            return Fixed(settings, seed)
        case Replay():
            return settings

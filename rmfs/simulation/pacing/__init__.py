"""Pacing: how simulated time accounts for the computation of optimisers.

A rule decides without delay in simulated time. A controller that asks an optimiser may get the
answer later; the pacing determines how much later, and runs the optimiser.
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
    """Function of an answered call and the simulated time (us) at which the answer takes effect."""


class Pacing(Protocol):
    """Runs optimisers, and determines when each answer takes effect.

    Attributes
    ----------
    waits
        Whether solvers run beside the simulation; `limit_us` may then have to wait for them.
    """

    waits: bool

    def begin(self, modules: Iterable[str], give: Return) -> None:
        """Prepare the optimisers; called before the measurement of wall time begins.

        Parameters
        ----------
        modules
            Modules with the functions that answer the questions.
        give
            Function to be called once for each question that has been answered or has failed,
            possibly from within `ask`. Its arguments are the call, which holds the answer or the
            reason for the failure, and the simulated time (us) at which the controller is to be
            notified.
        """
        ...

    def ask(self, call: Call) -> None:
        """Process a question: solve it now, let a worker solve it, or look up its answer."""
        ...

    def limit_us(self, now_us: int) -> int:
        """Wait until times after `now_us` may be simulated; return the latest such time, in us."""
        ...

    def end(self) -> None:
        """Release all resources; unanswered questions are abandoned."""
        ...


Paced = InstantPacing | WallPacing | WorkPacing | FixedPacing | Replay
"""A mode with its parameters or, for a replay, the answers read from the recorded run."""


def pacing_of(settings: Paced, seed: int) -> Pacing:
    """Create the pacing of a run.

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

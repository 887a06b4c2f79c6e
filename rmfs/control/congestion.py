"""Parameters by which rules take the delay from congestion into account."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated

import numpy as np
import pydantic

from rmfs.control.base import Parameters
from rmfs.control.trackers.congestion import Congestion

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from rmfs.control.view import View


class CongestionParameters(Parameters):
    """Parameters of rules that can add the delay from congestion to travel times."""

    congestion: Annotated[float, pydantic.Field(ge=0, allow_inf_nan=False)] = 0.0
    """The delay that congestion is expected to cause on a trip, times this weight, is added to the
    travel time. With 0, congestion is ignored."""
    congestion_from: Annotated[str, pydantic.Field(min_length=1)] = "recent"
    """Source of the expected delay: `recent` (how long robots have waited in each part of the
    floor; the weight of each wait halves about every seven minutes), `forecast` (as `recent`, but
    adjusted to where robots are going now), or the path of the table `heat` of an earlier run."""

    def delay_s(
        self, view: View, waypoint: int, others: NDArray[np.integer]
    ) -> NDArray[np.float64] | float:
        """Return the weighted delay in s on the trips from a waypoint to n others, shape (n,).

        If `congestion` is 0, the number 0 is returned instead of an array.
        """
        if not self.congestion:
            return 0.0
        return self.congestion * self.tracker(view).on_trips(waypoint, others)

    def tracker(self, view: View) -> Congestion:
        """Return the tracker of the delay, creating it if necessary.

        Raises
        ------
        InputError
            If `congestion_from` is neither `recent` nor `forecast` nor the path of a table `heat`
            of a run in this layout.
        """
        return view.trackers.get(Congestion, self.congestion_from)

    def prepare(self, view: View) -> None:
        """Create the tracker of the delay, unless `congestion` is 0.

        Rules call this method in their constructor, so that the tracker observes all events.
        """
        if self.congestion:
            self.tracker(view)

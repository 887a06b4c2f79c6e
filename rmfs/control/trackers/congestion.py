"""Congestion: where robots have waited for others, and the delay to expect on a trip.

The delay in a region of the floor is the time for which robots with a destination stood still in
it, divided by the number of waypoints that robots passed in it (plus 20, so that a few passages
have little effect). Queue zones of stations are left out, since waiting there has other causes.
"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from rmfs.control.trackers import Tracker
from rmfs.control.trackers.regions import Density, Regions
from rmfs.errors import InputError
from rmfs.layout.graph import edge_sources

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from rmfs.control.view import View
    from rmfs.layout.model import Layout

PERIOD_S = 60.0
"""Minimum simulated time between two readings of the counts, in s."""

KEPT = 0.9
"""Share of the earlier counts that is kept per `PERIOD_S`: half of them are forgotten after seven
minutes."""

DOUBT = 20.0
"""Passages without delay that are added to those counted, so that a few have little effect."""

AHEAD_S = 10.0
"""Minimum simulated time between two forecasts, in s."""

BOUNDS = (0.25, 4.0)
"""Bounds of the factor by which a forecast changes the recent delay in a region."""

RECENT, FORECAST = "recent", "forecast"


class Congestion(Tracker):
    """Expected delay in each region of the floor.

    Parameters
    ----------
    view
        The world.
    source
        Source of the delay. `recent`: passages and waiting times in this run; the weight of a count
        falls by half in seven minutes. `forecast`: as `recent`, but the delay in a region is
        multiplied by the ratio of the region's present load to its recent mean load. The load is
        the number of robots whose straight routes to their destinations lead through the region;
        1 is added to both loads, and the ratio is limited to the range `BOUNDS`. Any other text is
        the path of the table `heat` (`.parquet` or `.csv`) of an earlier run in the same layout;
        its counts keep their full weight.

    Attributes
    ----------
    regions
        The regions of the floor.

    Raises
    ------
    InputError
        If `source` is a path at which there is no such table, or the table does not belong to the
        layout.
    """

    def __init__(self, view: View, source: str = RECENT) -> None:
        super().__init__(view)
        layout = view.layout
        self.regions = Regions(layout)
        self._source = source
        self._counted = ~layout.is_queue
        self._spacing_m = _spacing_m(layout)
        self._passages = np.zeros(self.regions.shape)
        self._waiting_s = np.zeros(self.regions.shape)
        self._span_s = 0.0
        self._read_s = self._forecast_s = view.now_s
        self._last = np.zeros((2, layout.waypoints))
        self._load = self._mean_load = np.ones(self.regions.shape)
        if source in (RECENT, FORECAST):
            self._last = self._counts()
        else:
            self._add(_table(Path(source), layout.waypoints))
        self._density = self._new_density()

    @property
    def flow_per_h(self) -> NDArray[np.float64]:
        """Waypoints passed per hour in each region, shape `regions.shape`; nan if not known."""
        self._update()
        return self._passages * (3600.0 / self._span_s if self._span_s else np.nan)

    @property
    def delay_s(self) -> NDArray[np.float64]:
        """Expected delay per waypoint passed in each region, in s, shape `regions.shape`."""
        self._update()
        return self._delay_s()

    def on_trips(self, waypoint: int, others: NDArray[np.integer]) -> NDArray[np.float64]:
        """Return the expected delay on trips from a waypoint to n others, in s, shape (n,)."""
        self._update()
        return self._density.along(waypoint, others)

    # --- inside ---------------------------------------------------------------------------------

    def _update(self) -> None:
        if self._source not in (RECENT, FORECAST):
            return
        now_s = self.view.now_s
        periods = int((now_s - self._read_s) / PERIOD_S)
        if periods:
            self._forget(periods)
            self._read_s = now_s
            counts = self._counts()
            since = counts - self._last
            # counts only grow, except that they start again at the end of the warm-up
            self._add(counts if (since < 0).any() else since)
            self._last = counts
        if self._source == FORECAST and (periods or now_s - self._forecast_s >= AHEAD_S):
            self._forecast_s = now_s
            self._load = self._robots_through()
            self._mean_load = 0.95 * self._mean_load + 0.05 * self._load
            self._density = self._new_density()
        elif periods:
            self._density = self._new_density()

    def _forget(self, periods: int) -> None:
        for _ in range(min(periods, 200)):
            self._passages *= KEPT
            self._waiting_s *= KEPT
            self._span_s *= KEPT
        self._span_s += self.view.now_s - self._read_s

    def _counts(self) -> NDArray[np.float64]:
        """Return passages and waiting time per waypoint so far, shape (2, N)."""
        return np.stack(self.view.travel.passages())

    def _add(self, counts: NDArray[np.float64]) -> None:
        self._passages += self.regions.sums(counts[0] * self._counted)
        self._waiting_s += self.regions.sums(counts[1] * self._counted)

    def _delay_s(self) -> NDArray[np.float64]:
        delay_s: NDArray[np.float64] = self._waiting_s / (self._passages + DOUBT)
        if self._source == FORECAST:
            delay_s = delay_s * np.clip((self._load + 1.0) / (self._mean_load + 1.0), *BOUNDS)
        return delay_s

    def _new_density(self) -> Density:
        return Density(self.regions, self._delay_s() / self._spacing_m)

    def _robots_through(self) -> NDArray[np.float64]:
        """Return the number of robots that are about to drive through each region."""
        regions, travel = self.regions, self.view.travel
        through = np.zeros(regions.shape)
        for robot in self.view.robots:
            here, there = travel.robot_waypoint(robot.index), robot.waypoint
            if here == there:
                continue
            tier, row, column = regions.tier[here], regions.row[here], regions.column[here]
            last_row, last_column = regions.row[there], regions.column[there]
            rows, columns = slice(*_between(row, last_row)), slice(*_between(column, last_column))
            # half a robot on each of the two routes; a corner is on two legs but counts once
            through[tier, row, columns] += 0.5
            through[tier, rows, last_column] += 0.5
            through[tier, row, last_column] -= 0.5
            through[tier, rows, column] += 0.5
            through[tier, last_row, columns] += 0.5
            through[tier, last_row, column] -= 0.5
        return through


def _between(one: np.intp, other: np.intp) -> tuple[int, int]:
    return int(min(one, other)), int(max(one, other)) + 1


def _spacing_m(layout: Layout) -> float:
    """Return the mean length of the edges, in m; 1 if there are none."""
    tails, heads = edge_sources(layout), layout.edge_target
    if not len(heads):
        return 1.0
    x, y = np.abs(layout.x_m[heads] - layout.x_m[tails]), layout.y_m[heads] - layout.y_m[tails]
    return float(np.mean(x + np.abs(y)))


def _table(path: Path, waypoints: int) -> NDArray[np.float64]:
    """Read passages and waiting time per waypoint from a table `heat`, shape (2, N)."""
    import pandas as pd

    names = ["waypoint", "visits", "waiting_s"]
    try:
        if path.suffix == ".parquet":
            table = pd.read_parquet(path, columns=names)
        else:
            table = pd.read_csv(path, usecols=names)
    except (OSError, ValueError, KeyError) as error:
        raise InputError(
            f"{path}: must be the table heat of a run (heat.parquet, or a .csv file with the "
            f"columns {', '.join(names)}): {error}"
        ) from None
    table = table.sort_values("waypoint")
    if table["waypoint"].tolist() != list(range(waypoints)):
        raise InputError(
            f"{path}: must have a row for each of the {waypoints} waypoints of the layout "
            f"(rows: {len(table)})"
        )
    counts: NDArray[np.float64] = table[["visits", "waiting_s"]].to_numpy(np.float64).T
    if not np.isfinite(counts).all() or (counts < 0).any():
        raise InputError(f"{path}: visits and waiting_s must be finite and not negative")
    return counts

"""The cost of splitting orders: the put wall it needs, and the packing work it may cause.

Split orders are compared with whole ones, for put walls of different sizes, one minute and ten
minutes away from the pick stations. The controllers split only as many orders as the wall can hold
or, in the arms whose names contain `always`, any number of orders. The study publishes

- the means of all arms, and differences from whole orders, paired by seed;
- the gain of splitting within the capacity of the wall, compared with the better of two
  alternatives: whole orders, and splitting regardless of this capacity;
- the gain of optimisers over their start rules;
- the number of slots of the wall at which splitting picks as many units per hour as whole orders;
- how much time packers may take for each additional tote until pickers and packers together need as
  much time per unit with splitting as with whole orders;
- the transport time to the wall at which the mean time from the arrival of an order to its packing
  is the same with splitting as with whole orders.

The study uses the small site (layout `small`) or, with `--default` or `--large`, the default or the
large site (layouts `default` and `large`). At the large site, all walls are one minute away.
"""

from __future__ import annotations

import re
import sys
from math import inf, nan
from typing import TYPE_CHECKING

import numpy as np

from rmfs.experiments.papers.benefit import (
    CONTROLLERS,
    START,
    completed,
    gains,
    overview,
    publish_added,
    require_optimised,
)
from rmfs.experiments.papers.study import command, done, parser, station_units_per_h
from rmfs.experiments.statistics import interval
from rmfs.experiments.tables import HALF, Table, rows_frame

if TYPE_CHECKING:
    from collections.abc import Sequence

    import pandas as pd
    from numpy.typing import NDArray

    Floats = NDArray[np.float64]

DEMAND, ORDERS, WHOLE = "demand", "orders", "whole"
ALWAYS = ", always"
"""Suffix of levels of `orders` that split regardless of the wall's capacity."""

COLUMNS = (
    *("units_per_h", "distance_per_unit_m", "order_cycle_mean_s", "order_cycle_p95_s"),
    *("totes_per_order", "orders_packed_split_share", "consolidation_time_mean_s"),
    *("wall_slots_mean", "wall_slots_max", "totes_held_mean", "totes_by_hand"),
)
GAINED = ("units_per_h", "distance_per_unit_m", "order_cycle_mean_s", "order_cycle_p95_s")
RESAMPLES = 2000


def wall_of(label: str) -> tuple[float, float]:
    """Return the number of slots (inf: unlimited) and the time to the wall, in s, from a label.

    Raises
    ------
    ValueError
        If the label is not like `16 slots, 60 s` or `any slots, 60 s`.
    """
    found = re.fullmatch(r"(\d+|any) slots, (\d+) s", label)
    if found is None:
        raise ValueError(f"{label!r} is no wall such as '16 slots, 60 s'")
    return inf if found[1] == "any" else float(found[1]), float(found[2])


def walls_of(runs: pd.DataFrame) -> dict[str, tuple[float, float]]:
    """Return the wall of each level of `orders`, as `wall_of` returns it.

    Three kinds of levels are left out: whole orders, splitting regardless of the wall's capacity,
    and start rules.
    """
    labels = [str(label) for label in runs[ORDERS].unique()]
    return {
        label: wall_of(label)
        for label in labels
        if label != WHOLE and not label.endswith((ALWAYS, START))
    }


def break_even(slots: Sequence[float], gain: Floats) -> float:
    """Return the number of slots above which splitting has a gain, by linear interpolation.

    Parameters
    ----------
    slots
        Number of slots of each wall, ascending. The last number may be infinite.
    gain
        Gain of splitting with each wall. It is replaced by its running maximum, so that noise
        cannot make the gain decrease as the number of slots increases.

    Returns
    -------
    The number of slots. If there is a gain even with the smallest wall, this is the number of slots
    of that wall. If there is no gain with any wall, it is infinity. If there is a gain only with
    unlimited slots, it is the number of slots of the largest limited wall.
    """
    reached: Floats = np.maximum.accumulate(gain)
    if reached[0] > 0:
        return float(slots[0])
    if reached[-1] <= 0:
        return inf
    more = int(np.argmax(reached > 0))
    below, above = slots[more - 1], slots[more]
    if not np.isfinite(above):
        return float(below)
    part = -reached[more - 1] / (reached[more] - reached[more - 1])
    return float(below + part * (above - below))


def break_even_slots(runs: pd.DataFrame, way_s: float) -> tuple[float, float, float]:
    """Return the break-even number of slots, and the ends of its 95 % interval.

    With more slots than this number, splitting picks more units per hour than whole orders.

    Parameters
    ----------
    runs
        Runs with one kind of demand.
    way_s
        Time to the wall, in s. Walls with this time and the wall with unlimited slots are
        considered. The latter is never full, so the time to it does not affect units per hour.

    Returns
    -------
    The break-even number for the mean gains over all seeds, and the 2.5th and 97.5th percentiles of
    the break-even numbers for `RESAMPLES` bootstrap samples of the seeds.
    """
    wide = runs.pivot_table(index="replication", columns=ORDERS, values="units_per_h")
    chosen = sorted(
        (slots, label) for label, (slots, s) in walls_of(runs).items() if s == way_s or slots == inf
    )
    slots = [slots for slots, _ in chosen]
    each = np.stack([(wide[label] / wide[WHOLE] - 1).to_numpy() for _, label in chosen], axis=1)
    draws = np.random.default_rng(0).integers(0, len(each), (RESAMPLES, len(each)))
    found = np.sort([break_even(slots, each[draw].mean(axis=0)) for draw in draws])
    low, high = found[int(0.025 * RESAMPLES)], found[int(0.975 * RESAMPLES) - 1]
    return break_even(slots, each.mean(axis=0)), float(low), float(high)


def tolerable_tote_s(split: pd.DataFrame, whole: pd.DataFrame) -> pd.Series[float]:
    """Return the packer's time per additional tote, in s, at which splitting saves no work.

    An additional tote is one beyond the first of an order. One picker works at each pick station.
    With units per hour `split` and `whole`, splitting saves the share `1 - whole / split` of the
    pickers' time. The result is the time saved divided by the number of additional totes. It has
    one value per seed, which is nan if no order was split.

    Parameters
    ----------
    split, whole
        Runs, indexed by seed.
    """
    saved_s = 3600.0 * split["pick_stations"] * (1 - whole["units_per_h"] / split["units_per_h"])
    orders_per_h = 3600.0 * split["orders_packed"] / split["duration_s"]
    further_per_h = orders_per_h * (split["totes_per_order"] - 1)
    return saved_s / further_per_h.where(further_per_h > 0)


def tolerable_way_s(split: pd.DataFrame, whole: pd.DataFrame, way_s: float) -> pd.Series[float]:
    """Return the time to the wall, in s, up to which splitting does not delay packing on average.

    At this time to the wall, the mean time from the arrival of an order to its packing is the same
    as with whole orders. Only split orders go to the wall, but the mean is over all orders. The
    result has one value per seed. It is nan if no order was split, and negative if splitting would
    delay packing even with a wall next to the stations.

    Parameters
    ----------
    split, whole
        Runs, indexed by seed, in which the wall is never full.
    way_s
        Time to the wall in the runs `split`, in s.
    """
    earlier_s = whole["order_cycle_mean_s"] - split["order_cycle_mean_s"]
    share = split["orders_packed_split_share"]
    return way_s + earlier_s / share.where(share > 0)


def even(frame: pd.DataFrame) -> Table:
    """Return the break-even points of splitting, by demand and time to the wall.

    Parameters
    ----------
    frame
        Runs of the design.
    """
    rows: dict[str, dict[tuple[str, str], float]] = {}
    for demand, runs in frame.groupby(DEMAND, sort=False):
        walls = walls_of(runs)
        by_seed = {label: own.set_index("replication") for label, own in runs.groupby(ORDERS)}
        free = next(label for label, (slots, _) in walls.items() if slots == inf)
        tote = interval(tolerable_tote_s(by_seed[free], by_seed[WHOLE]))
        way = interval(tolerable_way_s(by_seed[free], by_seed[WHOLE], walls[free][1]))
        for way_s in sorted({s for _, s in walls.values()}):
            slots, low, high = break_even_slots(runs, way_s)
            first = not any(row.startswith(f"{demand}, ") for row in rows)
            rows[f"{demand}, {way_s:.0f} s"] = {
                ("slots", "mean"): slots,
                ("slots", "2.5 %"): low,
                ("slots", "97.5 %"): high,
                ("packer, s per tote", "mean"): tote.mean if first else nan,
                ("packer, s per tote", HALF): tote.half_width if first else nan,
                ("way, s", "mean"): way.mean if first else nan,
                ("way, s", HALF): way.half_width if first else nan,
            }
    decimals = {(name, part): 0 for name in ("slots", "way, s") for part in _PARTS}
    decimals |= {("packer, s per tote", part): 1 for part in _PARTS}
    caption = (
        "Where split orders break even with whole ones. slots: break-even number of slots of the "
        "wall, above which splitting picks more units per hour than whole orders, with a "
        "bootstrap interval over seeds; the smallest wall of the design may stand for smaller "
        "ones, and inf means none. packer: packer's time per additional tote at which pickers and "
        "packers together need the same time per unit as with whole orders. way: time to the wall "
        "at which orders are packed on average as early as with whole orders; a negative time "
        "means never. packer and way are for a wall with any number of slots, with 95% confidence "
        "intervals (Student's t)."
    )
    return Table(rows_frame(rows, f"{DEMAND}, way to the wall"), decimals, caption)


_PARTS = ("mean", HALF, "2.5 %", "97.5 %")


def against_better(frame: pd.DataFrame) -> Table:
    """Return the gain in units per hour of splitting within the wall's capacity, in percent.

    There are three gains: compared with whole orders, with splitting regardless of this capacity,
    and with the better of these two.

    Parameters
    ----------
    frame
        Runs of the design.
    """
    column = "units_per_h"
    rows: dict[str, dict[tuple[str, str], float]] = {}
    for demand, runs in frame.groupby(DEMAND, sort=False):
        wide = runs.pivot_table(index="replication", columns=ORDERS, values=column)
        for label in walls_of(runs):
            if label + ALWAYS not in wide:
                continue
            others = [WHOLE, label + ALWAYS]
            better = str(wide[others].mean().idxmax())
            row: dict[tuple[str, str], float] = {}
            for told, other in zip(("whole", "always", "better"), (*others, better), strict=True):
                found = interval(100 * (wide[label] / wide[other] - 1))
                row[f"against {told}, %", "mean"] = found.mean
                row[f"against {told}, %", HALF] = found.half_width
            rows[f"{demand}, {label}"] = row
    made = rows_frame(rows, f"{DEMAND}, wall")
    caption = (
        "Gain in units per hour of splitting within the wall's capacity, in percent, "
        "compared with whole orders, with splitting regardless of the wall, and with the one "
        "of the two with the higher mean in these runs, paired by seed, with 95% confidence "
        "intervals (Student's t)."
    )
    return Table(made, {key: 1 for row in rows.values() for key in row}, caption)


def main(arguments: list[str] | None = None) -> None:
    """Run the study and publish it."""
    options = parser("price-of-splitting", __doc__)
    site = options.add_mutually_exclusive_group()
    site.add_argument("--default", action="store_true", help="use the default site instead")
    site.add_argument("--large", action="store_true", help="use the large site instead")
    given = options.parse_args(arguments)
    name = "price-of-splitting"
    if given.default or given.large:
        name += "-default" if given.default else "-large"
        given.design = name
    study = done(given)
    frame = completed(study.frame, station_units_per_h(study))
    frame = frame.assign(**{CONTROLLERS: frame[ORDERS]})
    study.publish(overview(frame, (DEMAND, CONTROLLERS), COLUMNS), name, COLUMNS)
    split = frame[~frame[ORDERS].str.endswith(START)]
    study.publish(gains(split, (DEMAND,), WHOLE, GAINED), f"{name}-gains", GAINED)
    publish_added(study, frame, (DEMAND,), name, GAINED)
    study.publish(against_better(frame), f"{name}-better", ("units_per_h",))
    study.publish(even(frame), f"{name}-even", GAINED)
    # where the wall is ignored, stations are blocked and little is left to decide
    require_optimised(study, frame[~frame[ORDERS].str.endswith(ALWAYS)])


if __name__ == "__main__":
    sys.exit(command(main))

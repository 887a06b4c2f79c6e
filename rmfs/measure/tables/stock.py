"""The tables of pods and SKUs."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from rmfs.measure.tables import logs
from rmfs.measure.tables.tidy import log, tidy

if TYPE_CHECKING:
    import pandas as pd

    from rmfs.measure.recorder import Recorder


def pods(recorder: Recorder) -> pd.DataFrame:
    """One row per pod."""
    world = recorder.world
    count = recorder.layout.pods
    visits = logs.visits(recorder)
    lifts = logs.measured(recorder, log(recorder.lifts, "time_s", "pod", "robot"))
    units = logs.measured(recorder, logs.units(recorder))
    bundles = logs.measured(recorder, logs.stored(recorder))
    return tidy(
        "pods",
        {
            "pod": np.arange(count),
            "capacity": world.inventory.capacity,
            "used_end": world.inventory.used,
            "waypoint_end": world.storage.place_of,
            "lifts": _count(lifts["pod"], count),
            "pick_visits": _count(visits["pod"][visits["units"] > 0], count),
            "replenishment_visits": _count(visits["pod"][visits["bundles"] > 0], count),
            "units_picked": _count(units["pod"], count),
            "bundles_stored": _count(bundles["pod"], count),
        },
    )


def skus(recorder: Recorder) -> pd.DataFrame:
    """One row per SKU."""
    world = recorder.world
    count = len(world.skus)
    contained = world.inventory.contained
    return tidy(
        "skus",
        {
            "sku": np.arange(count),
            "popularity": world.skus.popularity,
            "space": world.skus.space_per_unit,
            "lines_picked": _count(logs.measured(recorder, logs.lines(recorder))["sku"], count),
            "units_picked": _count(logs.measured(recorder, logs.units(recorder))["sku"], count),
            "bundles_stored": _count(logs.measured(recorder, logs.stored(recorder))["sku"], count),
            "units_end": contained.sum(axis=1),
            "pods_end": (contained > 0).sum(axis=1),
        },
    )


def _count(index: pd.Series, length: int) -> np.ndarray[tuple[int], np.dtype[np.int64]]:
    return np.bincount(index.to_numpy(np.int64), minlength=length)

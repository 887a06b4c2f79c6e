"""Pictures: what they show, not how they look."""

from __future__ import annotations

import matplotlib as mpl
import numpy as np
import pandas as pd
import pytest

mpl.use("Agg")
from matplotlib import pyplot as plt
from matplotlib.colors import LogNorm

from rmfs.errors import InputError
from rmfs.measure.plots import heat, warmup


@pytest.fixture
def axes():
    figure, ax = plt.subplots()
    yield ax
    plt.close(figure)


def counted(visits):
    number = np.arange(len(visits))
    return pd.DataFrame(
        {
            "waypoint": number,
            "tier": 0,
            "x_m": number % 3 * 1.0,
            "y_m": number // 3 * 1.0,
            "visits": visits,
            "loaded_visits": visits,
            "waiting_s": np.asarray(visits) / 2,
        }
    )


def test_every_waypoint_is_drawn_and_colours_are_logarithmic(axes):
    assert heat(counted([0, 1, 10, 100, 1000, 0]), axes) is None
    unused, used = axes.collections
    assert (len(unused.get_paths()), len(used.get_paths())) == (2, 4)
    assert isinstance(used.norm, LogNorm)
    assert used.get_array().tolist() == [1, 10, 100, 1000]
    assert axes.get_xlabel() == "x (m)"
    assert axes.figure.axes[1].get_ylabel() == (
        "Number of times that a robot passed or stopped here (visits)"
    )


def test_other_counts_and_tiers(axes):
    frame = counted([1, 2, 3, 4])
    frame["tier"] = [0, 0, 1, 1]
    heat(frame, axes, column="waiting_s", tier=1)
    assert axes.collections[-1].get_array().tolist() == [1.5, 2.0]


@pytest.mark.parametrize("visits", [[0, 0, 0], [5, 5, 5]])
def test_nothing_and_all_the_same(axes, visits):
    heat(counted(visits), axes)
    axes.figure.canvas.draw()


def test_an_unknown_count_is_named(axes):
    with pytest.raises(InputError, match="valid: visits, loaded_visits, pick_visits"):
        heat(counted([1]), axes, column="heat")


def test_a_shorter_last_interval_does_not_change_the_proposed_warm_up(axes):
    units = [0, 2, 5, 8, 10, *[11, 9, 10, 12, 8] * 7]
    series = pd.DataFrame({"interval_s": 60.0, "units_picked": units})
    series["time_s"] = series["interval_s"].cumsum()
    longer = pd.concat([series[:-1], series[-1:].assign(interval_s=1.0, units_picked=1)])
    whole = plt.figure().subplots()
    warmup(series[:-1], whole)
    warmup(longer, axes)
    expected = whole.get_legend_handles_labels()[1]
    assert axes.get_legend_handles_labels()[1] == expected
    assert "MSER-5: 300 s" in expected

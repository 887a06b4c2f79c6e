"""The benchmark: what its table says of made-up results, and that its designs can be planned."""

from __future__ import annotations

import numpy as np
import pandas as pd
import pytest

from rmfs.experiments.design.planning import plan
from rmfs.experiments.papers.learning import LATE, UNITS, best_rule, compared


def results(**gains: float) -> pd.DataFrame:
    """Ten seeds of a regime per goal; an arm is so much better than the default rules."""
    draw = np.random.default_rng(1)
    rows = []
    for regime in ("backlog, tight", "arrivals, tight"):
        for seed in range(10):
            common = draw.normal(0, 5)
            for policy, gain in {"default rules": 0.0, **gains}.items():
                own = gain + common + draw.normal(0, 1)
                rows.append(
                    {
                        "regime": regime,
                        "policy": policy,
                        "arm": f"{regime} {policy}",
                        "replication": seed,
                        UNITS: 200 + own,
                        LATE: 40 - own,
                        "units_per_h": 600 + own,
                        "late_share": 0.4,
                        "order_turnover_mean_s": 300.0,
                        "bundles_per_h": 40.0,
                        "cpu_s": 1.0,
                    }
                )
    return pd.DataFrame(rows)


def test_gains_have_one_sign_whatever_the_goal() -> None:
    frame = compared(results(**{"POA due-time": 2.0, "TA tried": 6.0, "linear": -3.0})).frame
    for regime in ("backlog, tight", "arrivals, tight"):
        tried = frame.loc[f"{regime}, TA tried"]
        assert tried["gain on default", "mean"] == pytest.approx(6.0, abs=1.5)
        assert tried["gain on best rule", "mean"] == pytest.approx(4.0, abs=1.5)
        assert tried["gain on default", "p"] < 0.001
        assert frame.loc[f"{regime}, linear"]["gain on default", "mean"] < -1.0
        assert f"{regime}, POA due-time (best rule)" in frame.index


def test_the_best_rule_is_neither_trained_nor_tried() -> None:
    frame = results(**{"POA due-time": 1.0, "TA tried": 9.0, "linear, units": 8.0})
    runs = frame[frame["regime"] == "backlog, tight"]
    assert best_rule(runs, UNITS) == best_rule(runs, LATE) == "POA due-time"


@pytest.mark.parametrize(("design", "arms"), [("learning", 28), ("learning-sites", 19)])
def test_designs_can_be_planned_with_seeds_that_no_training_has_seen(
    design: str, arms: int
) -> None:
    made = plan(design)
    assert len(made.arms) == arms
    assert min(made.design.seeds) > 1000

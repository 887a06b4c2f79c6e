"""Optimisation of guidance."""

from __future__ import annotations

import json
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pandas as pd
import pytest

from rmfs import layout as layouts
from rmfs.cli import main
from rmfs.errors import InputError
from rmfs.experiments.traffic.guide import LARGEST, optimise
from rmfs.experiments.traffic.guide_features import FEATURES, features
from rmfs.experiments.traffic.guide_tasks import Orders, Trips
from rmfs.layout.graph import edge_sources
from rmfs.traffic.guidance import read_guidance

KEYS = {"scenario.duration_s": 200.0, "layout.robots": 8}
TASK = Orders("small", (11,), KEYS, "small")


def edges(rows: list[tuple[int, int, int]]) -> pd.DataFrame:
    return pd.DataFrame(rows, columns=["from_waypoint", "to_waypoint", "passages"])


def heat(rows: list[tuple[int, int, float]]) -> pd.DataFrame:
    return pd.DataFrame(rows, columns=["waypoint", "visits", "waiting_s"])


@pytest.mark.parametrize("two_way", [False, True])
def test_features_of_a_layout(two_way: bool) -> None:
    layout = layouts.load("default", [(["two_directional_aisles"], two_way)])
    tails, heads = edge_sources(layout), layout.edge_target
    aisle = ~(layout.is_storage | layout.is_queue)
    on_aisle = np.flatnonzero(aisle[tails] & aisle[heads])
    first, second = on_aisle[0], on_aisle[-1]
    of = list(zip(tails.tolist(), heads.tolist(), strict=True))
    found = features(
        layout,
        edges(
            [(int(tails[first]), int(heads[first]), 6), (int(tails[second]), int(heads[second]), 3)]
        ),
        heat([(int(heads[second]), 5, 20.0)]),
    )
    assert tuple(found) == FEATURES == tuple(LARGEST)
    assert all(column.shape == heads.shape for column in found.values())
    assert (found["flow"][first], found["flow"][second]) == (1.0, 0.5)
    assert found["waiting"][second] == pytest.approx(20.0 / 10.0)
    assert (found["storage"] > 0).sum() == layout.is_storage[heads].sum()
    assert 0 < found["entrance"].sum() < 0.1 * len(heads)
    # one direction of each two-way edge is against the main one; neighbouring aisles alternate
    pairs = set(of)
    against = {of[edge] for edge in np.flatnonzero(found["against"])}
    both = {(a, b) for a, b in pairs if (b, a) in pairs and aisle[a] and aisle[b]}
    assert len(against) == len(both) / 2
    assert not {(b, a) for a, b in against} & against
    assert bool(against) == two_way


def test_the_search_is_repeatable_and_starts_where_it_is_told() -> None:
    some = {"generations": 1, "population": 4, "seed": 3}
    one, other = optimise(TASK, **some), optimise(TASK, **some)
    assert one.weights == other.weights
    np.testing.assert_array_equal(one.extra_s, other.extra_s)
    assert one.history.equals(other.history)
    assert len(one.history) == 1
    assert one.value >= one.base_value  # no guidance is one of the candidates
    given = optimise(TASK, start={"storage": 0.5}, generations=0)
    layout = TASK.load()
    np.testing.assert_array_equal(given.extra_s, 0.5 * layout.is_storage[layout.edge_target])


def test_the_number_of_processes_does_not_matter() -> None:
    some = {"generations": 1, "population": 4, "seed": 3}
    assert optimise(TASK, **some).weights == optimise(TASK, jobs=2, **some).weights


def test_guidance_for_random_trips() -> None:
    task = Trips("small", (5,), {"layout.robots": 8}, warmup_s=60.0, duration_s=120.0)
    edges, heat = task.counted(5)
    assert edges["passages"].sum() > 100
    assert len(heat) == task.load().waypoints
    found = optimise(task, start={"storage": 5.0}, generations=0)
    usual = [task.run(seed).trips_per_h for seed in task.other_seeds()]
    assert found.base_value == pytest.approx(np.mean(usual))
    assert found.value != found.base_value


def test_seeds_that_decide_are_others() -> None:
    task = Trips("small", seeds=(3, 9))
    assert task.other_seeds() == [10, 11, 12, 13]


@pytest.mark.parametrize(
    ("given", "told"),
    [
        ({"start": {"speed": 1.0}}, "weight speed: unknown feature"),
        ({"start": {"flow": -1.0}}, "weight flow: must be between 0 and 600"),
        ({"population": 3}, "population of 4"),
        ({"generations": -1}, "generations of 0 or more"),
    ],
)
def test_wrong_searches_are_refused(given: dict[str, Any], told: str) -> None:
    with pytest.raises(InputError, match=told):
        optimise(TASK, **given)


def test_wrong_tasks_are_refused() -> None:
    with pytest.raises(InputError, match="objective speed"):
        Orders("small", objective={"speed": 1.0})
    with pytest.raises(InputError, match="at least one"):
        Trips("small", seeds=())
    with pytest.raises(InputError, match="is what is searched for"):
        Orders("small", set={"controllers.pp.guidance": "g.json"})
    with pytest.raises(InputError, match=r"scenario\.duration_s: random trips have only"):
        Trips("small", set={"scenario.duration_s": 9.0})


def test_an_objective_without_a_value_is_refused() -> None:
    """In five seconds, no order is completed."""
    keys = KEYS | {"scenario.duration_s": 5.0}
    task = Orders("small", (11,), keys, "small", objective={"order_turnover_mean_s": -1.0})
    with pytest.raises(InputError, match="must have a value in every run without guidance"):
        optimise(task)


def test_guidance_that_leaves_no_value_is_not_the_best(monkeypatch: pytest.MonkeyPatch) -> None:
    """An objective to make small, such as a delay, must not be 0 because nothing happened."""
    nothing = SimpleNamespace(footprint=pd.Series({"trip_delay_mean_s": np.nan}))
    monkeypatch.setattr(Orders, "_run", lambda *_: nothing)
    assert TASK.value(Path("g.json"), 11) == -np.inf


def test_the_command_end_to_end(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out = tmp_path / "g.json"
    given = ["traffic", "guide", "small", "--scenario", "small", "--seeds", "11"]
    keys = [f"--set={key}={value}" for key, value in KEYS.items()]
    search = ["--generations", "1", "--population", "4", "--weights", "storage=0.1,waiting=1"]
    assert main([*given, *keys, *search, "--out", str(out)]) == 0
    shown = capsys.readouterr()
    assert "generation 1: best" in shown.err
    assert "mean objective over other seeds" in shown.out
    read_guidance(out, layouts.load("small"))
    origin = json.loads(out.read_text())["origin"]
    assert origin["task"]["set"] == KEYS
    assert set(origin["weights"]) == set(FEATURES)
    run = ["run", "--layout", "small", "--scenario", "small", *keys, "--check"]
    guided = [f"--set=controllers.pp.guidance={out}", "--out", str(tmp_path / "run")]
    assert main([*run, *guided]) == 0


@pytest.mark.parametrize(
    "wrong",
    [
        ["--seeds", "a"],
        ["--weights", "storage"],
        ["--generations", "0"],
        ["--objective", "nothing=1"],
        ["--out", "g.txt"],
        ["--set", "controllers.pp.guidance=g.json"],
        ["--trips", "--set", "scenario.duration_s=60"],
    ],
)
def test_wrong_options_are_refused(
    wrong: list[str], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out = tmp_path / "g.json"
    assert main(["traffic", "guide", "small", "--out", str(out), *wrong]) == 2
    assert len(capsys.readouterr().err.strip().splitlines()) == 1
    assert not out.exists()


def test_designs_find_guidance_beside_them(tmp_path: Path) -> None:
    from rmfs.experiments.design.planning import plan

    (tmp_path / "g.json").write_text("{}")
    (tmp_path / "d.toml").write_text(
        'format = "rmfs-design/1"\nname = "d"\nreplications = 1\n[base]\nlayout = "small"\n'
        'scenario = "small"\n[[factors.path]]\nlabel = "none"\n[[factors.path]]\n'
        'label = "guided"\n"controllers.pp.guidance" = "g.json"\n'
    )
    before = plan(str(tmp_path / "d.toml"))
    overrides = {".".join(path): value for path, value in before.arms[1].overrides}
    assert overrides == {"controllers.pp.guidance": str(tmp_path / "g.json")}
    (tmp_path / "g.json").write_text("{ }")
    after = plan(str(tmp_path / "d.toml"))
    assert before.arms[0].digest == after.arms[0].digest
    assert before.arms[1].digest != after.arms[1].digest  # the contents count

"""Network rules: their scores, their choices in runs, and refused files."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import rmfs
from rmfs.cli import main
from rmfs.control.features import COLUMNS
from rmfs.control.network import WHOLE, Layer, Network, Scorer, start
from rmfs.errors import InputError

KEYS = {"scenario.duration_s": 300, "layout.robots": 4}
ALL = {f"controllers.{problem}": "network" for problem in ("poa", "pps", "psa", "ta")}
BESIDE = np.zeros(len(WHOLE), np.float32)


def random_network(kind: str, seed: int, sizes: tuple[int, ...] = (5, 4, 1)) -> Network:
    draw = np.random.default_rng(seed)
    inputs = (*COLUMNS[kind], *(f"all.{name}" for name in WHOLE))
    layers, entering = [], len(inputs)
    for size in sizes:
        weights = tuple(map(tuple, draw.normal(size=(entering, size)).tolist()))
        layers.append(Layer(weights=weights, biases=tuple(draw.normal(size=size).tolist())))
        entering = size
    first = start(kind)
    return Network(linear=first.linear, decline=first.decline, inputs=inputs, layers=tuple(layers))


def test_scores_by_hand() -> None:
    network = Network(
        linear={"back_s": 10.0},
        decline={"constant": 1.0, "backlog_orders": -2.0},
        inputs=("all.backlog_orders", "away_s"),
        layers=(
            Layer(weights=((1.0, 0.5), (2.0, -1.0)), biases=(0.0, -1.0)),
            Layer(weights=((3.0,), (7.0,)), biases=(0.25,)),
        ),
    )
    scorer = Scorer("place", network)
    whole = BESIDE.copy()
    whole[WHOLE.index("backlog_orders")] = 0.5
    features = np.array([[1.0, 2.0], [-2.0, 0.0]], np.float32)  # away_s, back_s
    # first: hidden 0.5 + 2 = 2.5 and 0.25 - 1 - 1 < 0; 3 * 2.5 + 0.25 + 10 * 2
    # second: hidden 0.5 - 4 < 0 and 0.25 + 2 - 1 = 1.25; 7 * 1.25 + 0.25
    assert scorer.scores(features, whole).tolist() == [27.75, 9.0]
    assert scorer.declining(whole) == 0.0
    assert Scorer("place", start("place")).declining(whole) is None


@pytest.mark.parametrize("kind", ["poa", "pick pod", "place", "ta"])
def test_scores_are_those_of_the_matrices(kind: str) -> None:
    network = random_network(kind, 3)
    draw = np.random.default_rng(4)
    features = draw.normal(size=(6, len(COLUMNS[kind]))).astype(np.float32)
    whole = draw.normal(size=len(WHOLE)).astype(np.float32)
    values = np.hstack([features, np.tile(whole, (6, 1))]).astype(float)
    for number, layer in enumerate(network.layers):
        values = values @ np.array(layer.weights) + np.array(layer.biases)
        if number < len(network.layers) - 1:
            values = values.clip(0)
    linear = np.array([network.linear.get(name, 0.0) for name in COLUMNS[kind]])
    scorer = Scorer(kind, network)
    found = scorer.scores(features, whole)
    np.testing.assert_allclose(found, values[:, 0] + features @ linear, rtol=1e-12)
    # a score does not depend on the other candidates, nor on their order
    order = draw.permutation(6)
    assert (scorer.scores(features[order], whole) == found[order]).all()
    assert scorer.scores(features[2:3], whole)[0] == found[2]


def test_network_rules_decide_everything() -> None:
    run = rmfs.simulate("small", "small", seed=1, set=KEYS | ALL, trace=True)
    again = rmfs.simulate("small", "small", seed=1, set=KEYS | ALL)
    assert run.check().ok
    assert run.footprint["units_picked"] == again.footprint["units_picked"] > 20
    assert run.footprint["bundles_stored"] > 0


def test_a_network_without_layers_decides_like_the_linear_rule() -> None:
    weights = {"away_s": -3.0, "back_s": -1.0}
    found = [
        rmfs.simulate("small", "small", seed=2, set=KEYS | {"controllers.psa": rule}, trace=True)
        for rule in (
            {"name": "linear", "weights": weights},
            {"name": "network", "network": {"linear": weights}, "candidates": 1000},
        )
    ]
    for name, table in found[0].trace.items():
        np.testing.assert_array_equal(table, found[1].trace[name], name)


def test_layers_and_the_number_of_candidates_matter() -> None:
    far = {"inputs": ["away_s"], "layers": [{"weights": [[100.0]], "biases": [0.0]}]}
    driven = [
        rmfs.simulate(
            "small",
            "small",
            seed=1,
            set=KEYS | {"controllers.psa": {"name": "network", "network": far, "candidates": k}},
        ).footprint["distance_m"]
        for k in (1, 1000)
    ]
    assert driven[1] > 1.1 * driven[0]


def test_declining_stops_a_rule() -> None:
    """An order is assigned only while many slots are free."""
    network = {"linear": {"in_stock": 1.0}, "decline": {"constant": 1.5, "free_slots": -1.0}}
    rule = {"name": "network", "network": network}
    run = rmfs.simulate("small", "small", seed=1, set=KEYS | {"controllers.poa": rule})
    full = rmfs.simulate("small", "small", seed=1, set=KEYS | {"controllers.poa": "network"})
    assert 0 < run.footprint["open_orders_mean"] < full.footprint["open_orders_mean"]


GOOD = 'inputs = ["away_s"], layers = [{ weights = [[1.0]], biases = [0.0] }]'


@pytest.mark.parametrize(
    ("network", "key", "told"),
    [
        ('inputs = ["price"], layers = [{ weights = [[1.0]], biases = [0.0] }]', "", "price"),
        ('inputs = ["away_s"]', "", "inputs and layers must both be given, or neither"),
        (GOOD.replace("[[1.0]]", "[[1.0], [2.0]]"), "", "has 2 rows; one for each of the 1"),
        (GOOD.replace("[[1.0]]", "[[1.0, 2.0]]"), ".layers.0", "has 2 numbers, biases 1"),
        (GOOD.replace("[0.0]", "[]"), ".layers.0", "at least one input and one output"),
        (GOOD.replace("1.0", "nan"), ".layers.0.weights.0.0", "finite number"),
        (GOOD.replace("1.0", "inf"), ".layers.0.weights.0.0", "finite number"),
        (GOOD.replace("1.0", '"x"'), ".layers.0.weights.0.0", "valid number"),
        (GOOD.replace("biases", "bias"), ".layers.0.biases", "unknown key network.layers.0.bias"),
        (GOOD.replace('["away_s"]', '["away_s", "away_s"]'), "", "1 rows; one for each of the 2"),
        ("linear = { away_s = nan }", ".linear.away_s", "finite number"),
        ("linear = { reach_s = 1.0 }", "", "reach_s is unknown; valid: away_s, back_s"),
        ("decline = { away_s = 1.0 }", "", "away_s is unknown; valid: constant, time_left"),
    ],
)
def test_a_wrong_file_is_refused(
    network: str, key: str, told: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "mine.toml"
    path.write_text(
        'format = "rmfs-controllers/1"\nname = "mine"\n'
        f'[psa]\nname = "network"\nnetwork = {{ {network} }}\n'
    )
    out = tmp_path / "out"
    assert main(["run", "--controllers", str(path), "--out", str(out)]) == 2
    message = capsys.readouterr().err
    assert message.count("\n") == 1
    assert "mine.toml: " in message
    assert f"psa: network{key}: " in message
    assert told in message
    assert not out.exists()


def test_a_station_must_be_chosen() -> None:
    network: dict[str, Any] = {"decline": {"constant": 1.0}}
    rule = {"name": "network", "next_station": network}
    with pytest.raises(InputError, match=r"next_station: decline: must be absent"):
        rmfs.simulate("small", "small", seed=1, set=KEYS | {"controllers.pps": rule})

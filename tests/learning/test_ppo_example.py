"""The example of deep learning, where its libraries are installed: a policy learns and plays."""

from __future__ import annotations

import importlib.util
from pathlib import Path
from typing import Any

import pytest

pytest.importorskip("sb3_contrib")

EXAMPLE = Path(__file__).parents[2] / "docs" / "examples" / "learn_pods.py"


def test_a_policy_learns_and_plays() -> None:
    spec = importlib.util.spec_from_file_location("learn_pods", EXAMPLE)
    assert spec is not None and spec.loader is not None
    example: Any = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(example)
    example.SITE["set"]["scenario.duration_s"] = 200
    model = example.trained(128)
    again = example.trained(128)
    footprints = [example.played(one, seed=1001) for one in (model, again)]
    assert footprints[0]["units_picked"] == footprints[1]["units_picked"] > 0

"""Robots as agents: PettingZoo's own checks, seeds, and that work gets done."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from pettingzoo.test import parallel_api_test, parallel_seed_test

from rmfs.errors import InputError
from rmfs.learning import RobotsEnv


def made(duration_s: float = 200.0) -> RobotsEnv:
    return RobotsEnv("small", "small", set={"scenario.duration_s": duration_s})


def test_pettingzoo_accepts_the_environment() -> None:
    parallel_api_test(made(), num_cycles=60)
    parallel_seed_test(made, num_cycles=20)


def test_robots_that_take_what_there_is_get_orders_done() -> None:
    env = made(400)
    observations, infos = env.reset(seed=1)
    total, elapsed_s = 0.0, 0.0
    while env.agents:
        actions = {
            agent: int(np.argmax(seen["action_mask"][1:])) + 1
            if seen["action_mask"][1:].any()
            else 0
            for agent, seen in observations.items()
        }
        observations, rewards, _, truncations, infos = env.step(actions)
        total += rewards["robot_0"]
        elapsed_s += infos["robot_0"]["elapsed_s"]
    footprint: Any = infos["robot_0"]["footprint"]
    assert all(truncations.values())
    assert total == footprint["units_picked"] > 20
    assert elapsed_s == 400


def test_actions_of_unknown_agents_are_refused() -> None:
    env = made()
    env.reset(seed=1)
    told = r"no agent robot_99, picker \(agents: robot_0 to robot_\d+\)"
    with pytest.raises(InputError, match=told):
        env.step({"robot_0": 0, "robot_99": 0, "picker": 1})
    env.step({"robot_0": 0})

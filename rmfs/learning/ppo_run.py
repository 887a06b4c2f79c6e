"""Training by MaskablePPO, as `rmfs.learning.ppo` describes; needs the extra `ppo`."""

from __future__ import annotations

from math import exp
from time import perf_counter, process_time
from typing import TYPE_CHECKING, Any

import pandas as pd
import torch
from sb3_contrib import MaskablePPO
from stable_baselines3.common.callbacks import BaseCallback
from stable_baselines3.common.vec_env import DummyVecEnv, VecNormalize

from rmfs.learning.environment import DecisionEnv
from rmfs.learning.networks import first_networks, mean_value, network_rules
from rmfs.learning.scoring import ScoringPolicy
from rmfs.learning.training import Trained
from rmfs.random import Stream, generator

if TYPE_CHECKING:
    from collections.abc import Callable

    from rmfs.control.settings import ControllerSettings
    from rmfs.learning.rewards import Wanted
    from rmfs.learning.training import Task

FIRST_SEED = 1_000_000
"""Seed of the first training run; each further run has the next seed."""
ENVIRONMENTS = 8
"""Number of environments; one process simulates their runs alternately."""
ROLLOUT = 2048
"""Number of decisions between two updates of the networks."""


def learned(
    task: Task,
    *,
    reward: Wanted,
    steps: int,
    hidden: int,
    candidates: int,
    gamma: float,
    learning_rate: float,
    checks: int,
    average: bool,
    seed: int,
    told: Callable[[str], None] | None,
) -> Trained:
    """Train network rules; see `rmfs.learning.ppo.train_network`."""
    torch.set_num_threads(1)
    first = first_networks(task)
    settings = network_rules(task, first, candidates)
    given = {key: value for key, value in task.set.items() if not key.startswith("controllers.")}

    rate = Rate() if average else None

    def made(number: int) -> Training:
        return Training(
            task.layout,
            task.scenario,
            settings,
            problems=task.problems,
            set=given,
            candidates=candidates,
            reward=reward,
            observation="flat",
            footprint=False,
            number=number,
            rate=rate,
        )

    several = DummyVecEnv([lambda number=number: made(number) for number in range(ENVIRONMENTS)])
    env = VecNormalize(several, norm_obs=False, norm_reward=True, gamma=gamma)
    rollouts = -(-steps // ROLLOUT)
    watched = Checks(task, settings, candidates, rollouts, checks, told)
    drawn = int(generator(seed, Stream.TRAINING).integers(1, 2**31))
    model = MaskablePPO(
        ScoringPolicy,
        env,
        n_steps=ROLLOUT // ENVIRONMENTS,
        batch_size=256,
        n_epochs=10,
        gamma=gamma,
        learning_rate=lambda left: learning_rate * left,
        ent_coef=0.001,
        seed=drawn,
        device="cpu",
        policy_kwargs={
            "observing": several.get_attr("observing")[0],
            "first": first,
            "hidden": hidden,
        },
    )
    model.learn(total_timesteps=rollouts * ROLLOUT, callback=watched)
    history = pd.DataFrame(watched.rows, columns=["steps", "value", "wall_s", "cpu_s"])
    return Trained(watched.best, watched.value, watched.start_value, history)


class Rate:
    """The mean reward per second of recent decisions in all environments."""

    MEMORY_S = 20_000.0
    """Simulated time, in s, after which the weight of a reward in the mean has fallen to 1 / e."""

    def __init__(self) -> None:
        self._reward, self._time_s = 0.0, 0.0

    def less_mean(self, reward: float, elapsed_s: float) -> float:
        """Include a reward in the mean; return the reward minus mean x elapsed time."""
        kept = exp(-elapsed_s / self.MEMORY_S)
        self._reward = kept * self._reward + reward
        self._time_s = kept * self._time_s + elapsed_s
        if self._time_s == 0:
            return 0.0
        return reward - elapsed_s * self._reward / self._time_s


class Training(DecisionEnv):
    """An environment for training, which uses every `ENVIRONMENTS`-th of the training seeds.

    Parameters
    ----------
    number
        Number of the environment, from 0; its first seed is `FIRST_SEED + number`.
    rate
        Mean reward per second; its product with the elapsed time is subtracted from each reward.
        None: rewards are not changed.
    """

    def __init__(self, *arguments: Any, number: int, rate: Rate | None, **named: Any) -> None:
        super().__init__(*arguments, **named)
        self._next_seed = FIRST_SEED + number
        self._rate = rate

    def step(self, action: Any) -> tuple[Any, float, bool, bool, dict[str, Any]]:
        """Carry out an action, and simulate up to the next decision."""
        seen, reward, ended, over, info = super().step(action)
        if self._rate is not None:
            reward = self._rate.less_mean(reward, info["elapsed_s"])
        return seen, reward, ended, over, info

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Any, dict[str, Any]]:
        """Start a run with the next training seed; `seed` is ignored."""
        seed, self._next_seed = self._next_seed, self._next_seed + ENVIRONMENTS
        return super().reset(seed=seed, options=options)


class Checks(BaseCallback):
    """Simulates the rules from time to time during training, and stores the best ones.

    Attributes
    ----------
    best, value, start_value
        As in `Trained`.
    rows
        For each check, the number of decisions so far, the value of the rules, and the wall and
        processor times since the start, in s.
    """

    def __init__(
        self,
        task: Task,
        first: ControllerSettings,
        candidates: int,
        rollouts: int,
        checks: int,
        told: Callable[[str], None] | None,
    ) -> None:
        super().__init__()
        self._began_s, self._cpu_began_s = perf_counter(), process_time()
        self._task, self._candidates, self._told = task, candidates, told
        # the value at the start is known: with few rollouts, there are fewer checks
        self._due = {round(rollouts * (number + 1) / checks) for number in range(checks)} - {0}
        self._done = 0
        self.best, self.rows = first, list[tuple[int, float, float, float]]()
        self.value = self.start_value = mean_value(task, first)
        task.require_value(self.value)

    def _on_step(self) -> bool:
        return True

    def _on_rollout_start(self) -> None:
        self._check()
        self._done += 1

    def _on_training_end(self) -> None:
        self._check()

    def _check(self) -> None:
        if self._done not in self._due:
            return
        found = network_rules(self._task, self.model.policy.networks(), self._candidates)
        value = mean_value(self._task, found)
        spent = perf_counter() - self._began_s, process_time() - self._cpu_began_s
        self.rows.append((self.num_timesteps, value, *spent))
        if value > self.value:
            self.best, self.value = found, value
        if self._told is not None:
            self._told(f"{self.num_timesteps} decisions: objective {value:.4g}")

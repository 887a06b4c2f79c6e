"""Training of network rules by proximal policy optimisation (PPO).

The agent of a `DecisionEnv` decides some problems with networks that score candidates, and
MaskablePPO of the package sb3-contrib trains these networks. From time to time, network rules are
created from the networks and simulated; the best of these rules are returned. Training needs the
extra `ppo`; simulating the rules does not.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from rmfs.control.network import CANDIDATES
from rmfs.errors import InputError

if TYPE_CHECKING:
    from collections.abc import Callable

    from rmfs.learning.rewards import Wanted
    from rmfs.learning.training import Task, Trained


def train_network(
    task: Task,
    *,
    reward: Wanted = "units",
    steps: int = 200_000,
    hidden: int = 16,
    candidates: int = CANDIDATES,
    gamma: float = 0.99,
    learning_rate: float = 1e-3,
    checks: int = 10,
    average: bool = False,
    seed: int = 1,
    told: Callable[[str], None] | None = None,
) -> Trained:
    """Train network rules for the problems of a task, and return the best rules found.

    If the controller of a problem is a network rule, training starts from its networks; otherwise,
    it starts from `rmfs.control.network.start`. Training runs have the seeds 1000000, 1000001, ...
    Before training, and `checks` times during training, the rules are simulated with the task's
    seeds; the rules with the best mean objective are returned. The result depends on the versions
    of PyTorch and sb3-contrib.

    Parameters
    ----------
    reward
        The reward that PPO maximises (`rmfs.learning.rewards`). During training, rewards are
        divided by the standard deviation of their discounted sum.
    steps
        Number of decisions; rounded up to a multiple of 2048.
    hidden
        Number of units in the hidden layer of each network. A network that already has layers
        keeps these.
    candidates
        Maximum number of candidates (such as pods) that are scored for a decision.
    gamma
        Discount factor per decision.
    learning_rate
        Initial learning rate; it falls linearly to 0.
    checks
        Number of times that the rules are simulated during training; fewer if `steps` is less than
        2048 times this number.
    average
        Whether to subtract from each reward the product of the mean reward per second and the time
        since the last decision. Without this, PPO maximises the reward per decision rather than per
        second, because it discounts by decision.
    seed
        Seed of the initial weights and of PPO.
    told
        Function called with a line of text after each check.

    Raises
    ------
    InputError
        If a number is out of range, a package of the extra `ppo` is not installed, or the objective
        has no value before training.
    """
    numbers = (steps, hidden, candidates, checks)
    if min(numbers) < 1 or not 0 < gamma <= 1 or not learning_rate > 0:
        raise InputError(
            "training needs steps, hidden, candidates and checks of 1 or more, a gamma above 0 and "
            "at most 1, and a learning_rate above 0 (given: "
            f"{', '.join(map(str, (*numbers, gamma, learning_rate)))})"
        )
    try:
        from rmfs.learning.ppo_run import learned
    except ModuleNotFoundError as error:
        if str(error.name).partition(".")[0] == "rmfs":
            raise
        raise InputError(
            f"training of networks needs the package {error.name}: pip install rmfs[learning,ppo]"
        ) from error
    return learned(
        task,
        reward=reward,
        steps=steps,
        hidden=hidden,
        candidates=candidates,
        gamma=gamma,
        learning_rate=learning_rate,
        checks=checks,
        average=average,
        seed=seed,
        told=told,
    )

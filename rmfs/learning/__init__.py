"""Reinforcement learning: Gymnasium and PettingZoo environments, rewards, and trained rules.

Requires the extra `learning` (`pip install rmfs[learning]`); no other part of the simulator imports
this package. `import rmfs.learning` registers `rmfs/Decision-v0` with Gymnasium.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from rmfs.errors import InputError

if TYPE_CHECKING:
    from rmfs.learning.environment import DecisionEnv as DecisionEnv
    from rmfs.learning.ppo import train_network as train_network
    from rmfs.learning.rewards import Reward as Reward
    from rmfs.learning.robots import RobotsEnv as RobotsEnv
    from rmfs.learning.training import Task as Task
    from rmfs.learning.training import train as train
    from rmfs.learning.vector import DecisionVectorEnv as DecisionVectorEnv

NAME = "rmfs/Decision-v0"

_PLACES = {
    "DecisionEnv": "rmfs.learning.environment",
    "DecisionVectorEnv": "rmfs.learning.vector",
    "Reward": "rmfs.learning.rewards",
    "RobotsEnv": "rmfs.learning.robots",
    "Task": "rmfs.learning.training",
    "train": "rmfs.learning.training",
    "train_network": "rmfs.learning.ppo",
}

__all__ = [
    "NAME",
    "DecisionEnv",
    "DecisionVectorEnv",
    "Reward",
    "RobotsEnv",
    "Task",
    "train",
    "train_network",
]


def __getattr__(name: str) -> Any:
    """Import an exported name on first use, so that training does not need Gymnasium."""
    if name not in _PLACES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    import importlib

    try:
        return getattr(importlib.import_module(_PLACES[name]), name)
    except ModuleNotFoundError as error:
        if str(error.name).partition(".")[0] not in ("gymnasium", "pettingzoo"):
            raise
        raise InputError(
            "rmfs.learning needs Gymnasium and PettingZoo: pip install rmfs[learning]"
        ) from error


def _register() -> None:
    try:
        import gymnasium
    except ModuleNotFoundError:
        return
    if NAME not in gymnasium.registry:
        gymnasium.register(
            id=NAME,
            entry_point="rmfs.learning.environment:DecisionEnv",
            vector_entry_point="rmfs.learning.vector:DecisionVectorEnv",
        )


_register()

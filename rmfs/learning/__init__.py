"""Every decision as an environment: Gymnasium, PettingZoo, rewards, and policies that are trained.

Needs the extra `learning` (`pip install rmfs[learning]`); nothing else of rmfs imports this.
`import rmfs.learning` registers `rmfs/Decision-v0` with Gymnasium.
"""

from __future__ import annotations

from rmfs.errors import InputError

try:
    import gymnasium as _gymnasium
    import pettingzoo as _pettingzoo  # noqa: F401
except ImportError as error:  # pragma: no cover
    raise InputError(
        "rmfs.learning needs Gymnasium and PettingZoo: pip install rmfs[learning]"
    ) from error

from rmfs.learning.environment import DecisionEnv as DecisionEnv
from rmfs.learning.rewards import Reward as Reward
from rmfs.learning.robots import RobotsEnv as RobotsEnv

NAME = "rmfs/Decision-v0"

if NAME not in _gymnasium.registry:
    _gymnasium.register(id=NAME, entry_point="rmfs.learning.environment:DecisionEnv")

__all__ = ["NAME", "DecisionEnv", "Reward", "RobotsEnv"]

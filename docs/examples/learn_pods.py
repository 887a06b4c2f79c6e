"""Which pod to fetch, learnt by PPO: `python docs/examples/learn_pods.py [STEPS]`.

MaskablePPO of sb3-contrib is trained on runs of the small site and then compared with the default
rules, on seeds it has not seen. Needs `pip install "rmfs[learning,ppo]"`.
"""

from __future__ import annotations

import sys
from typing import Any

import numpy as np
from sb3_contrib import MaskablePPO

import rmfs
from rmfs.learning import DecisionEnv

SITE: dict[str, Any] = {"set": {"layout.robots": 4, "scenario.duration_s": 900}}
HELD_OUT = (1001, 1002, 1003, 1004)


def warehouse(**more: Any) -> DecisionEnv:
    """Make the environment: the agent chooses pods, the default rules decide all else."""
    return DecisionEnv("small", "small", problems=["pps"], observation="flat", **SITE, **more)


def trained(steps: int, seed: int = 1) -> MaskablePPO:
    """Train a policy over so many decisions."""
    env = warehouse(reward="units", footprint=False)
    model = MaskablePPO(
        "MlpPolicy",
        env,
        n_steps=min(512, steps),
        batch_size=64,
        gamma=0.95,
        seed=seed,
        device="cpu",
    )
    return model.learn(total_timesteps=steps)


def played(model: MaskablePPO, seed: int) -> Any:
    """Let a policy decide a run; return the footprint."""
    env = warehouse()
    seen, info = env.reset(seed=seed)
    while "footprint" not in info:
        action, _ = model.predict(seen, action_masks=info["action_mask"], deterministic=True)
        seen, _, _, _, info = env.step(action)
    return info["footprint"]


def main(steps: int) -> None:
    """Train, and compare with the default rules."""
    model = trained(steps)
    gains = []
    for seed in HELD_OUT:
        rules = rmfs.simulate("small", "small", seed=seed, **SITE).footprint
        learnt = played(model, seed)
        gains.append(learnt["units_picked"] - rules["units_picked"])
        print(f"seed {seed}: {learnt['units_picked']} units, default {rules['units_picked']}")
    print(f"gain {np.mean(gains):.1f} units, standard error {np.std(gains, ddof=1) / 2:.1f}")


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 20_000)

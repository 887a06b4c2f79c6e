"""Speed of the environments, beside RWARE's: `python -m tests.tools.environment_speed`.

Figures are per second of processor time, so that other work on the machine counts less, and the
best of several rounds, which take turns. Two processes are compared with one by the clock, which
needs two idle cores, and by their processor time: all their work, with what the main process does,
over the longest way through it, the slower process of each step. RWARE (`pip install rware`) is
left out where it is not installed. A decision of ours lets all robots drive, with turns and
accelerations and free of collisions, until somebody has to be asked again; a step of RWARE moves
agents by a cell of a grid.
"""

from __future__ import annotations

import argparse
import sys
import time
from dataclasses import dataclass
from importlib.util import find_spec
from typing import TYPE_CHECKING, Any

import gymnasium
import numpy as np

from rmfs.learning import DecisionEnv, DecisionVectorEnv

if TYPE_CHECKING:
    from collections.abc import Callable

GIVEN: dict[str, Any] = {
    "layout": "default",
    "scenario": "default",
    "problems": ["ta", "pps"],
    "footprint": False,
    "set": {"layout.robots": 32, "scenario.duration_s": 86_400, "scenario.warmup_s": 0},
}
WARM = 100
"""Decisions before the first that is measured: the warehouse fills up."""


@dataclass
class Rates:
    """What was measured, by name: per second, or milliseconds."""

    found: dict[str, list[float]]

    def add(self, name: str, value: float) -> None:
        """Take note of a round."""
        self.found.setdefault(name, []).append(value)

    def best(self, name: str) -> float:
        """Return the greatest rate, or the shortest time."""
        values = self.found[name]
        return min(values) if name.endswith("ms") else max(values)


class Ours:
    """One environment, whose first possible candidate is taken."""

    def __init__(self) -> None:
        self._env = DecisionEnv(**GIVEN)
        _, self._info = self._env.reset(seed=1)
        self.go(WARM)

    def go(self, steps: int) -> None:
        """Take decisions."""
        for _ in range(steps):
            *_, self._info = self._env.step(int(self._info["action_mask"].argmax()))


class Several:
    """A vector environment."""

    def __init__(self, count: int, workers: int) -> None:
        self._envs = DecisionVectorEnv(count, workers=workers, **GIVEN)
        _, self._info = self._envs.reset(seed=1)
        self._count = count
        self.work_s = self.longest_s = 0.0
        self.go(WARM * count)

    def go(self, steps: int) -> None:
        """Take decisions, so many in all."""
        self.work_s = self.longest_s = 0.0
        for _ in range(steps // self._count):
            before_s = time.process_time()
            *_, self._info = self._envs.step(self._info["action_mask"].argmax(axis=1))
            own_s, busy_s = time.process_time() - before_s, self._envs.busy_s
            self.work_s += busy_s.sum() + own_s
            self.longest_s += busy_s.max() + own_s

    def close(self) -> None:
        """End its processes."""
        self._envs.close()


class Rware:
    """RWARE with actions drawn at random."""

    def __init__(self, agents: int) -> None:
        self._env = gymnasium.make(f"rware:rware-small-{agents}ag-v2", disable_env_checker=True)
        self._env.reset(seed=1)
        self._env.action_space.seed(1)

    def go(self, steps: int) -> None:
        """Take steps."""
        env = self._env
        for _ in range(steps):
            _, _, over, cut, _ = env.step(env.action_space.sample())
            if over or cut:
                env.reset()


def rate(go: Callable[[int], None], steps: int, clock: Callable[[], float]) -> float:
    """Return steps per second of a clock."""
    before = clock()
    go(steps)
    return steps / (clock() - before)


def reset_ms(seed: int, env: DecisionEnv) -> float:
    """Return how long a reset takes, in processor time."""
    before = time.process_time()
    env.reset(seed=seed)
    return (time.process_time() - before) * 1e3


def measured(rounds: int, steps: int, count: int) -> Rates:
    """Measure everything in turn, so many times."""
    rates, ours = Rates({}), Ours()
    small = DecisionEnv("small", "small", problems=["ta", "pps"])
    reset_ms(0, small)
    grids = {agents: Rware(agents) for agents in (2, 16) if find_spec("rware") is not None}
    several = {workers: Several(count, workers) for workers in (1, 2)}
    for number in range(rounds):
        rates.add("rmfs, decisions", rate(ours.go, steps, time.process_time))
        for agents, grid in grids.items():
            name = f"RWARE {agents} agents, steps"
            rates.add(name, rate(grid.go, steps // agents, time.process_time))
        pair = {workers: rate(one.go, steps, time.perf_counter) for workers, one in several.items()}
        for workers, value in pair.items():
            rates.add(f"rmfs, {count} environments, {workers} process(es), per wall second", value)
        rates.add("two processes / one, per wall second", pair[2] / pair[1])
        both = several[2]
        rates.add("two processes, work / longest way", both.work_s / both.longest_s)
        rates.add("reset, small site, new seed, ms", reset_ms(number + 1, small))
        reset_ms(number + 1, small)  # the second time the run is kept
        rates.add("reset, small site, known seed, ms", reset_ms(number + 1, small))
    for one in several.values():
        one.close()
    return rates


def main(arguments: list[str] | None = None) -> int:
    """Print the best of all rounds, and their median."""
    options = argparse.ArgumentParser(description=__doc__)
    options.add_argument("--rounds", type=int, default=10)
    options.add_argument("--steps", type=int, default=800)
    options.add_argument("--environments", type=int, default=32)
    given = options.parse_args(arguments)
    rates = measured(given.rounds, given.steps, given.environments)
    print(f"{'':66}{'best':>9}{'median':>9}")
    for name, values in rates.found.items():
        print(f"{name:66}{rates.best(name):9.4g}{np.median(values):9.4g}")
    return 0


if __name__ == "__main__":
    sys.exit(main())

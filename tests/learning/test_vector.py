"""The vector environment: the same as single ones, and what is told when something is wrong."""

from __future__ import annotations

import gc
import multiprocessing
import weakref
from typing import Any

import gymnasium
import numpy as np
import pytest

from rmfs.errors import InputError
from rmfs.learning import NAME, DecisionEnv, DecisionVectorEnv, Reward
from rmfs.learning.episode import Episodes
from rmfs.learning.workers import RUNS_KEPT, Board, Stand, shapes_of

GIVEN: dict[str, Any] = {
    "layout": "small",
    "scenario": "small",
    "problems": ["ta", "pps"],
    "set": {"scenario.duration_s": 150, "layout.robots": 4},
}


@pytest.mark.parametrize("observation", ["dict", "flat"])
def test_several_do_what_single_ones_do(observation: str) -> None:
    """Through the ends of episodes, which begin anew in the step after the last one."""
    given = GIVEN | {"observation": observation}
    several = DecisionVectorEnv(3, workers=2, **given)
    single = [DecisionEnv(**given) for _ in range(3)]
    seen, info = several.reset(seed=5)
    last = [env.reset(seed=5 + number) for number, env in enumerate(single)]
    over, ended = [False] * 3, 0
    for _ in range(80):
        actions = info["action_mask"].argmax(axis=1)
        seen, rewards, terminated, truncated, info = several.step(actions)
        assert not terminated.any()
        for number, env in enumerate(single):
            reward = 0.0
            if over[number]:
                last[number], over[number] = env.reset(), False
            else:
                own, reward, _, over[number], told = env.step(actions[number])
                last[number] = own, told
            own, told = last[number]
            assert rewards[number] == reward
            assert truncated[number] == over[number]
            assert info["now_s"][number] == told["now_s"]
            assert (info["action_mask"][number] == told["action_mask"]).all()
            for name in own if observation == "dict" else [...]:
                mine = seen[name][number] if observation == "dict" else seen[number]
                assert (mine == own[name]).all()
            if over[number]:
                ended += 1
                theirs = info["footprint"][number]["units_picked"]
                assert info["_footprint"][number]
                assert theirs == told["footprint"]["units_picked"]
    several.close()
    assert ended > 2


def test_runs_that_have_ended_are_freed(monkeypatch: pytest.MonkeyPatch) -> None:
    """A process that works through many runs keeps a few of them, not all."""
    runs: list[weakref.ref[Any]] = []
    begin = Episodes.begin

    def remembered(self: Episodes, seed: int | None) -> Any:
        run = begin(self, seed)
        runs.append(weakref.ref(run))
        return run

    monkeypatch.setattr(Episodes, "begin", remembered)
    given = GIVEN | {"set": {"scenario.duration_s": 1, "layout.robots": 4}}
    board = Board.made(shapes_of(DecisionEnv(**given)), 2, multiprocessing.get_context("spawn"))
    stand = Stand(given, board, range(2))
    thresholds = gc.get_threshold()
    try:
        for seed in range(5):
            stand.reset({0: seed, 1: seed}, None)
            assert sum(run() is not None for run in runs) <= 2
        for _ in range(100):
            board.arrays["action"][:] = board.arrays["action_mask"].argmax(axis=1)
            stand.step()
            assert sum(run() is not None for run in runs) <= (RUNS_KEPT + 1) * 2
    finally:
        gc.unfreeze()
        gc.set_threshold(*thresholds)
        gc.freeze()  # as tests/conftest.py has done
    assert len(runs) > 30


def test_gymnasium_makes_it() -> None:
    several = gymnasium.make_vec(NAME, num_envs=2, workers=1, **GIVEN)
    assert isinstance(several.unwrapped, DecisionVectorEnv)
    seen, _ = several.reset(seed=1)
    assert several.observation_space.contains(seen)
    assert several.metadata["autoreset_mode"] is gymnasium.vector.AutoresetMode.NEXT_STEP
    several.close()


def test_what_is_wrong_is_told_at_once() -> None:
    with pytest.raises(InputError, match="problem pp: must be one of"):
        DecisionVectorEnv(2, problems=["pp"])
    with pytest.raises(InputError, match="num_envs 2, workers 3"):
        DecisionVectorEnv(2, workers=3, **GIVEN)


def test_a_closed_environment_says_so() -> None:
    several = DecisionVectorEnv(2, workers=2, **GIVEN)
    several.reset(seed=1)
    several.close()
    for call in (
        lambda: several.step(np.zeros(2, int)),
        lambda: several.reset(seed=1),
        several.action_masks,
    ):
        with pytest.raises(InputError, match=r"closed; create a new DecisionVectorEnv"):
            call()
    several.close()


class Broken(Reward):
    """Fails as soon as a unit is picked."""

    def unit_picked(self, *_: Any) -> None:
        raise ArithmeticError("no such sum")


def test_an_error_in_a_process_comes_through() -> None:
    several = DecisionVectorEnv(2, workers=2, **GIVEN | {"reward": Broken})
    _, info = several.reset(seed=1)
    with pytest.raises(RuntimeError, match="no such sum"):
        for _ in range(100):
            *_, info = several.step(np.asarray(info["action_mask"]).argmax(axis=1))
    with pytest.raises(InputError, match="closed"):
        several.reset(seed=1)

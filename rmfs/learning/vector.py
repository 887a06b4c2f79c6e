"""Several environments in parallel, as a vector environment of Gymnasium."""

from __future__ import annotations

import multiprocessing
import os
from typing import TYPE_CHECKING, Any

import numpy as np
from gymnasium.vector import AutoresetMode, VectorEnv
from gymnasium.vector.utils import batch_space

from rmfs.errors import InputError
from rmfs.learning.environment import DecisionEnv
from rmfs.learning.workers import Board, shapes_of, work

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

TOLD = ("action_mask", "elapsed_s", "now_s", "invalid")


class DecisionVectorEnv(VectorEnv[Any, Any, Any]):
    """Several `DecisionEnv` in worker processes, with observations in shared memory.

    Environments are divided among the processes, and `step` waits for the slowest process. The
    computing time up to the next decision varies greatly between environments; with 8 or more
    environments per process, these differences average out.

    If an environment's episode ends in a step, the next step ignores the action for the
    environment, starts its next episode and returns reward 0 (Gymnasium's mode `NEXT_STEP`).

    `info` contains the arrays `elapsed_s`, `now_s`, `invalid` and `kind`, each of shape (N,), and
    `action_mask`, shape (N, actions). The elements of `kind` are kinds of question (see the
    attribute `kinds`); each element is the kind of the environment's next question, or empty at the
    end of an episode. If episodes have just ended and runs are measured, `info` also contains the
    array `footprint`, shape (N,), with the footprints of the ended runs; the mask `_footprint` is
    true for the environments of these runs.

    `reset(seed=s)` gives environment i the seed s + i. Each environment then behaves like a single
    `DecisionEnv` with its seed.

    Parameters
    ----------
    num_envs
        Number N of environments.
    workers
        Number of processes. Default: one per core, at most N.
    given
        Arguments for creating each environment, as for `DecisionEnv`.

    Raises
    ------
    InputError
        If an argument is invalid.
    """

    metadata: dict[str, Any] = {"autoreset_mode": AutoresetMode.NEXT_STEP}  # noqa: RUF012

    def __init__(self, num_envs: int = 1, *, workers: int | None = None, **given: Any) -> None:
        count = workers if workers is not None else min(os.cpu_count() or 1, max(num_envs, 1))
        if not 1 <= count <= num_envs:
            raise InputError(
                f"num_envs {num_envs}, workers {count}: there must be at least one worker, and at "
                "least one environment per worker"
            )
        env = DecisionEnv(**given)  # reports errors here instead of in a process
        self.num_envs = num_envs
        self.kinds: Sequence[str] = env.observing.kinds
        self.single_observation_space = env.observation_space
        self.single_action_space = env.action_space
        self.observation_space = batch_space(env.observation_space, num_envs)
        self.action_space = batch_space(env.action_space, num_envs)
        context = multiprocessing.get_context("spawn")
        self._board = Board.made(shapes_of(env), num_envs, context)
        self._names = [name for name in self._board.arrays if name.startswith("seen ")]
        self._kind_names = np.array([*self.kinds, ""], object)
        self._pipes, self._processes = [], []
        self._places = [range(first, num_envs, count) for first in range(count)]
        for places in self._places:
            here, there = context.Pipe()
            process = context.Process(
                target=work, args=(given, self._board, places, there), daemon=True
            )
            process.start()
            there.close()
            self._pipes.append(here)
            self._processes.append(process)
        self._answers()

    def reset(
        self, *, seed: int | Sequence[int | None] | None = None, options: Any = None
    ) -> tuple[Any, dict[str, Any]]:
        """Start a run in every environment; return the observations and `info`.

        Raises
        ------
        InputError
            If the environment has been closed.
        """
        self._require_open()
        seeds: list[int | None]
        if seed is None or isinstance(seed, (int, np.integer)):
            seeds = [None if seed is None else int(seed) + i for i in range(self.num_envs)]
        else:
            seeds = list(seed)
        self._board.arrays["invalid"][:] = False
        for pipe, places in zip(self._pipes, self._places, strict=True):
            pipe.send(("reset", ({place: seeds[place] for place in places}, options)))
        return self._seen(), self._told(self._answers())

    def step(
        self, actions: Any
    ) -> tuple[Any, NDArray[np.float64], NDArray[np.bool_], NDArray[np.bool_], dict[str, Any]]:
        """Carry out an action in every environment; where an episode has ended, start the next.

        Raises
        ------
        InputError
            If the environment has been closed.
        """
        self._require_open()
        board = self._board.arrays
        board["action"][:] = actions
        for pipe in self._pipes:
            pipe.send(("step", ()))
        over = self._answers()
        never = np.zeros(self.num_envs, np.bool_)
        return (
            self._seen(),
            board["reward"].copy(),
            never,
            board["truncated"].copy(),
            self._told(over),
        )

    def action_masks(self) -> NDArray[np.bool_]:
        """Return whether each action is possible in each environment, shape (N, actions).

        Raises
        ------
        InputError
            If the environment has been closed.
        """
        self._require_open()
        return self._board.arrays["action_mask"].copy()

    @property
    def busy_s(self) -> NDArray[np.float64]:
        """Return the processor time (s) of each process in the last step, shape (workers,)."""
        return self._board.arrays["busy_s"][: len(self._processes)].copy()

    def close_extras(self, **_: Any) -> None:
        """Stop the worker processes."""
        for pipe in self._pipes:
            try:
                pipe.send(("close", ()))
                pipe.close()
            except OSError:
                continue  # it has ended already
        for process in self._processes:
            process.join(timeout=5)
            if process.is_alive():
                process.terminate()

    # --- inside ---------------------------------------------------------------------------------

    def _require_open(self) -> None:
        if self.closed:
            raise InputError("the environment has been closed; create a new DecisionVectorEnv")

    def _answers(self) -> dict[int, Any]:
        """Wait for all processes; return their messages, which complement the shared memory."""
        found: dict[int, Any] = {}
        for pipe, process in zip(self._pipes, self._processes, strict=True):
            try:
                said, what = pipe.recv()
            except (EOFError, ConnectionResetError):
                process.join(timeout=1)
                raise RuntimeError(f"a worker has died (exit code {process.exitcode})") from None
            if said == "failed":
                error, where = what
                self.close()
                if isinstance(error, InputError):
                    raise error
                raise RuntimeError(f"an environment failed in its worker:\n{where}")
            found |= what or {}
        return found

    def _seen(self) -> Any:
        board = self._board.arrays
        if self._names == ["seen "]:
            return board["seen "].copy()
        return {name.removeprefix("seen "): board[name].copy() for name in self._names}

    def _told(self, over: dict[int, Any]) -> dict[str, Any]:
        board = self._board.arrays
        everybody = np.ones(self.num_envs, np.bool_)
        info: dict[str, Any] = {}
        for name in TOLD:
            info[name], info[f"_{name}"] = board[name].copy(), everybody
        info["kind"], info["_kind"] = self._kind_names[board["kind"]], board["kind"] >= 0
        if any(footprint is not None for footprint in over.values()):
            footprints, whose = np.full(self.num_envs, None, object), np.zeros_like(everybody)
            for place, footprint in over.items():
                footprints[place], whose[place] = footprint, True
            info["footprint"], info["_footprint"] = footprints, whose
        return info

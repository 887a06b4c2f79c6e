"""Worker processes that run environments; observations and actions are in shared memory."""

from __future__ import annotations

import gc
import traceback
from dataclasses import dataclass, field
from time import process_time
from typing import TYPE_CHECKING, Any

import numpy as np
from gymnasium import spaces

from rmfs.learning.environment import DecisionEnv
from rmfs.simulation.collection import ALLOCATIONS

if TYPE_CHECKING:
    from collections.abc import Mapping
    from multiprocessing.connection import Connection

    from numpy.typing import NDArray

Shapes = dict[str, tuple[tuple[int, ...], str]]

RUNS_KEPT = 4
"""Ended runs are freed each time this many runs per environment have begun."""


def shapes_of(env: DecisionEnv) -> Shapes:
    """Return the shape and data type of each input and output of an environment, by name."""
    space = env.observation_space
    parts: dict[str, Any] = dict(space.spaces) if isinstance(space, spaces.Dict) else {"": space}
    return {
        **{f"seen {name}": (part.shape, part.dtype.str) for name, part in parts.items()},
        "action": ((), "i8"),
        "action_mask": ((env.actions,), "?"),
        "reward": ((), "f8"),
        "truncated": ((), "?"),
        "invalid": ((), "?"),
        "elapsed_s": ((), "f8"),
        "now_s": ((), "f8"),
        "kind": ((), "i4"),
        "busy_s": ((), "f8"),
    }


@dataclass
class Board:
    """Inputs and outputs of N environments: one array per name, with one row per environment.

    Attributes
    ----------
    shapes
        Shapes and data types for one environment, by name, as returned by `shapes_of`.
    buffers
        Shared memory of each array, by name; created by `multiprocessing.RawArray`.
    arrays
        The arrays by name; they are views of the shared memory.
    """

    shapes: Shapes
    buffers: dict[str, Any]
    arrays: dict[str, NDArray[Any]] = field(init=False)

    @classmethod
    def made(cls, shapes: Shapes, count: int, context: Any) -> Board:
        """Create a board, including its shared memory, for `count` environments."""
        sizes = {
            name: max(int(np.prod(shape)) * np.dtype(kind).itemsize * count, 1)
            for name, (shape, kind) in shapes.items()
        }
        return cls(shapes, {name: context.RawArray("b", size) for name, size in sizes.items()})

    def __post_init__(self) -> None:
        self.arrays = {
            name: np.frombuffer(self.buffers[name], kind).reshape(-1, *shape)
            if np.prod(shape)
            else np.zeros((1, *shape), kind)
            for name, (shape, kind) in self.shapes.items()
        }

    def __getstate__(self) -> dict[str, Any]:
        """Return the state without the arrays, which are views of the shared memory."""
        return {"shapes": self.shapes, "buffers": self.buffers}

    def __setstate__(self, state: dict[str, Any]) -> None:
        """Restore the arrays as views of the same shared memory."""
        self.__init__(**state)  # type: ignore[misc]


class Stand:
    """The environments of one process, and their rows in shared memory.

    Parameters
    ----------
    given
        Arguments for creating each environment, as for `DecisionEnv`.
    board
        The shared memory.
    places
        Rows of the arrays in shared memory that belong to these environments.
    """

    def __init__(self, given: Mapping[str, Any], board: Board, places: range) -> None:
        self._board = board.arrays
        self._envs = {place: DecisionEnv(**given) for place in places}
        self._first = places[0]
        self._over: set[int] = set()
        self._begun = 0
        """Number of runs begun since ended runs were last freed."""

    def reset(self, seeds: Mapping[int, int | None], options: Any) -> dict[int, Any]:
        """Start a run in each environment, with the seed given for its row (None: draw a seed)."""
        for place, seed in seeds.items():
            self._begin(place, seed, options)
        self._free()
        return {}

    def step(self) -> dict[int, Any]:
        """Carry out the actions in shared memory, one per environment.

        If the run of an environment ended in the last step, its next run is started instead.

        Returns
        -------
        dict
            Footprints of the runs that have ended in this step, by row.
        """
        board, found, before_s = self._board, {}, process_time()
        for place, env in self._envs.items():
            board["invalid"][place] = False
            if place in self._over:
                self._begin(place, None, None)
                continue
            seen, reward, _, over, info = env.step(board["action"][place])
            self._write(place, seen, info)
            board["reward"][place] = reward
            board["truncated"][place] = over
            board["invalid"][place] = info.get("invalid", False)
            if over:
                self._over.add(place)
                found[place] = info.get("footprint")
        board["busy_s"][self._first] = process_time() - before_s
        return found

    def _begin(self, place: int, seed: int | None, options: Any) -> None:
        seen, info = self._envs[place].reset(seed=seed, options=options)
        self._write(place, seen, info)
        self._over.discard(place)
        self._board["reward"][place] = 0.0
        self._board["truncated"][place] = False
        self._begun += 1
        if self._begun >= RUNS_KEPT * len(self._envs):
            self._free()

    def _free(self) -> None:
        """Free ended runs, and exclude the current runs from later garbage collections.

        Runs contain reference cycles, so only the garbage collector can free them. Scanning the
        current runs repeatedly would be useless, because their objects live long.
        """
        self._begun = 0
        gc.unfreeze()
        gc.collect()
        gc.freeze()
        gc.set_threshold(ALLOCATIONS, 20, 100)

    def _write(self, place: int, seen: Any, info: dict[str, Any]) -> None:
        board = self._board
        for name, values in seen.items() if isinstance(seen, dict) else [("", seen)]:
            board[f"seen {name}"][place] = values
        for name in ("action_mask", "elapsed_s", "now_s"):
            board[name][place] = info[name]
        kinds = self._envs[place].observing.kinds
        told = self._envs[place].options
        board["kind"][place] = -1 if told is None else kinds.index(told.kind)


def work(given: Mapping[str, Any], board: Board, places: range, pipe: Connection) -> None:
    """Run a worker process: carry out commands from a pipe up to `close` or the end of the pipe."""
    try:
        stand = Stand(given, board, places)
        pipe.send(("made", None))
        while True:
            name, arguments = pipe.recv()
            if name == "close":
                return
            pipe.send(("done", getattr(stand, name)(*arguments)))
    except (EOFError, KeyboardInterrupt):
        return
    except BaseException as error:
        pipe.send(
            ("failed", (error if isinstance(error, Exception) else None, traceback.format_exc()))
        )

"""Processes in which environments live; what they see lies in memory that all share."""

from __future__ import annotations

import gc
import traceback
from dataclasses import dataclass, field
from time import process_time
from typing import TYPE_CHECKING, Any

import numpy as np
from gymnasium import spaces

from rmfs.learning.environment import DecisionEnv

if TYPE_CHECKING:
    from collections.abc import Mapping
    from multiprocessing.connection import Connection

    from numpy.typing import NDArray

Shapes = dict[str, tuple[tuple[int, ...], str]]

FEW_COLLECTIONS = 50_000
"""Objects made between two looks for garbage; a run makes hardly any that holds itself."""


def shapes_of(env: DecisionEnv) -> Shapes:
    """Return shape and type of what an environment is told and tells, by name."""
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
    """What N environments are told and tell: an array per name, whose first axis is theirs.

    Attributes
    ----------
    shapes
        Per environment.
    buffers
        Memory by name, from `multiprocessing.RawArray`.
    """

    shapes: Shapes
    buffers: dict[str, Any]
    arrays: dict[str, NDArray[Any]] = field(init=False)

    @classmethod
    def made(cls, shapes: Shapes, count: int, context: Any) -> Board:
        """Make the memory."""
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
        """Leave the arrays out: they are views of the memory."""
        return {"shapes": self.shapes, "buffers": self.buffers}

    def __setstate__(self, state: dict[str, Any]) -> None:
        """Look at the same memory."""
        self.__init__(**state)  # type: ignore[misc]


class Stand:
    """Some environments, and their places on the board.

    Parameters
    ----------
    given
        How environments are made.
    places
        Rows of the board.
    """

    def __init__(self, given: Mapping[str, Any], board: Board, places: range) -> None:
        self._board = board.arrays
        self._envs = {place: DecisionEnv(**given) for place in places}
        self._first = places[0]
        self._over: set[int] = set()

    def reset(self, seeds: Mapping[int, int | None], options: Any) -> dict[int, Any]:
        """Begin a run in each of them."""
        for place, seed in seeds.items():
            self._begin(place, seed, options)
        return {}

    def step(self) -> dict[int, Any]:
        """Take the actions on the board; where a run was over, begin the next one instead.

        Returns
        -------
        The footprints of runs that are over now, by place.
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
    """Do what comes through the pipe, until nothing comes any more: the body of a process."""
    try:
        stand = Stand(given, board, places)
        pipe.send(("made", None))
        while True:
            name, arguments = pipe.recv()
            if name == "close":
                return
            pipe.send(("done", getattr(stand, name)(*arguments)))
            if name == "reset":
                # what lives as long as the run is not looked through again and again
                gc.collect()
                gc.freeze()
                gc.set_threshold(FEW_COLLECTIONS, 20, 100)
    except (EOFError, KeyboardInterrupt):
        return
    except BaseException as error:
        pipe.send(
            ("failed", (error if isinstance(error, Exception) else None, traceback.format_exc()))
        )

"""Checkpoints, from which killed runs can be resumed."""

from __future__ import annotations

from typing import TYPE_CHECKING, TypeVar

from rmfs.errors import InputError
from rmfs.simulation import saving

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from rmfs.simulation.kernel import Kernel

K = TypeVar("K", bound="Kernel")


class Checkpoints:
    """Runs a simulation to its end and saves it periodically.

    Pass an instance to `simulate` as `driver`. The checkpoint file is removed at the end of the
    simulation.

    Parameters
    ----------
    path
        The checkpoint file; each checkpoint replaces the one before.
    every_s
        Simulated seconds between checkpoints.

    Raises
    ------
    InputError
        If `every_s` is not positive.
    """

    def __init__(self, path: Path, every_s: float) -> None:
        if not every_s > 0:
            raise InputError(f"--checkpoint-every {every_s:g}: must be greater than 0")
        self._path = path
        self._every_s = every_s

    def __call__(
        self, simulation: Kernel, progress: Callable[[float, float], None] | None = None
    ) -> None:
        """Simulate to the end, and save the simulation at each checkpoint."""
        number = int(simulation.now_s // self._every_s)
        while not simulation.ended:
            number += 1
            simulation.run_until(min(number * self._every_s, simulation.end_s))
            if progress is not None:
                progress(simulation.now_s, simulation.end_s)
            if not simulation.ended:
                saving.save(simulation, self._path)
        self._path.unlink(missing_ok=True)


def resumed(path: Path, simulation: K) -> K:
    """Return the simulation saved in a checkpoint file, so that it can be continued.

    Parameters
    ----------
    simulation
        A simulation that has not started, with the same inputs as the saved one.

    Raises
    ------
    InputError
        If there is no such file, if the file cannot be read, or if it was written by a run with
        other inputs or by another version of the code.
    """
    if not path.is_file():
        raise InputError(
            f"{path}: there is no checkpoint to resume from; --out and --seed must be those of "
            "the run"
        )
    saving.refuse_other(path, simulation)
    return saving.load(type(simulation), path)

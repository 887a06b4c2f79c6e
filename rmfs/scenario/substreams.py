"""Independent random numbers for numbered items, such as orders: a substream for each item."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Callable

    from rmfs.random import Stream


class Substreams:
    """A random stream that is derived from a seed and divided into numbered substreams.

    A counter-based generator (Philox) computes its numbers from a key and a counter. The key is
    derived from the seed, the stream and the path, and the number of the substream is part of the
    counter. Switching to a substream therefore takes about one microsecond, whereas creating a
    generator would take about ten. A substream has 2**64 blocks of four numbers before it overlaps
    with the next one.

    Parameters
    ----------
    seed
        The run's seed, 0 or greater.
    stream
        Purpose of the random numbers, for example `Stream.ORDER_CONTENTS`.
    path
        Numbers that select a branch of the stream; each branch has its own substreams.

    Attributes
    ----------
    branch
        The stream and the path, as one tuple. Two objects with the same branch and seed give the
        same numbers.
    """

    def __init__(self, seed: int, stream: Stream, path: tuple[int, ...] = ()) -> None:
        self.branch = (int(stream), *path)
        sequence = np.random.SeedSequence(seed, spawn_key=self.branch)
        self._generator = np.random.Philox(key=sequence.generate_state(2, np.uint64))
        self._uniform: Callable[[], float] = np.random.Generator(self._generator).random
        self._start = self._generator.state
        self._counter = self._start["state"]["counter"]

    def at(self, ordinal: int) -> Callable[[], float]:
        """Return a function, each call of which returns the next number of a substream.

        The numbers are uniform in [0, 1). The function must not be used after the next call of
        `at`, because all substreams share one generator.

        Parameters
        ----------
        ordinal
            Index of the substream, which then starts from the beginning.
        """
        self._counter[1] = ordinal
        self._generator.state = self._start
        return self._uniform

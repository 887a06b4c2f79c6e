"""A tree of named random streams, derived from one seed.

Each stream is derived from the seed and the stream's own fixed number. Adding a stream therefore
never changes the others. Arms of an experiment that run with the same seed face the same demand.
"""

from __future__ import annotations

from enum import IntEnum

import numpy as np


class Stream(IntEnum):
    """The named streams.

    The random numbers of a stream depend on its value in this enumeration, so no value is ever
    changed or reused.
    """

    LAYOUT = 0
    SKUS = 1
    INITIAL_STOCK = 2
    ORDER_ARRIVALS = 3
    ORDER_CONTENTS = 4
    BUNDLE_ARRIVALS = 5
    BUNDLE_CONTENTS = 6
    SERVICE = 7
    TIE_BREAKS = 8
    CONTROLLERS = 9
    PACING = 10
    TRIPS = 11
    DISTURBANCES = 12
    VISITS = 13
    LOOK_AHEAD = 14
    TRAINING = 15
    BATTERIES = 20
    PACKING = 21
    PICKERS = 22


def generator(seed: int, stream: Stream, *path: int) -> np.random.Generator:
    """Return the random generator of a stream or of one of its substreams.

    Parameters
    ----------
    seed
        The run's (or layout's) seed, 0 or greater.
    path
        Numbers that select a substream, for example the ordinal of an order. Different paths give
        independent sequences. If the path is empty, the stream itself is selected.
    """
    sequence = np.random.SeedSequence(seed, spawn_key=(int(stream), *path))
    return np.random.Generator(np.random.PCG64(sequence))

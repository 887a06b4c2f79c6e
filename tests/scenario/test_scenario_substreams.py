"""Numbered substreams of a stream."""

from __future__ import annotations

import numpy as np
from scipy import stats

from rmfs.random import Stream
from rmfs.scenario.substreams import Substreams


def numbers(streams: Substreams, ordinal: int, n: int = 10) -> list[float]:
    uniform = streams.at(ordinal)
    return [uniform() for _ in range(n)]


def test_a_substream_starts_anew_each_time():
    streams = Substreams(1, Stream.ORDER_CONTENTS)
    first = numbers(streams, 5, 7)
    numbers(streams, 6, 3)
    assert numbers(streams, 5, 7) == first


def test_seed_stream_and_ordinal_all_matter():
    drawn = {
        tuple(numbers(Substreams(seed, stream), ordinal))
        for seed in (0, 1)
        for stream in (Stream.ORDER_CONTENTS, Stream.BUNDLE_CONTENTS)
        for ordinal in (0, 1, 2**40)
    }
    assert len(drawn) == 12
    assert len({number for sequence in drawn for number in sequence}) == 120


def test_numbers_across_and_along_substreams_are_uniform_and_unrelated():
    streams = Substreams(1, Stream.ORDER_CONTENTS)
    drawn = np.array([numbers(streams, ordinal, 5) for ordinal in range(4000)])
    for column in drawn.T:
        assert stats.kstest(column, "uniform").pvalue > 0.001
    correlation = np.corrcoef(np.hstack([drawn[:-1], drawn[1:]]).T)
    assert np.abs(correlation[np.triu_indices(10, 1)]).max() < 0.06

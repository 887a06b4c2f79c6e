"""What the core cannot go on with is an error like all others, never a panic."""

import random
import struct
import zlib

import numpy as np
import pytest
from random_tasks import RandomTasks

from rmfs.errors import InternalError
from rmfs.layout import load
from rmfs.traffic import Step, Traffic

HEAD = len(b"rmfs-traffic") + 1


def spoilt(saved, draw):
    """Saved bytes of which one is another one, with a checksum that hides it."""
    head, _, core = saved.partition(b"\n")
    body = bytearray(core[HEAD + 4 :])
    body[draw.randrange(len(body))] = draw.randrange(128)
    return head + b"\n" + core[:HEAD] + struct.pack("<I", zlib.crc32(body)) + bytes(body)


def test_spoilt_states_end_in_errors():
    """One byte of a saved state is changed at random: it is refused, goes on, or is a defect."""
    layout = load("default", [(["robots"], 6)])
    saved = RandomTasks(layout, 1).run(60).traffic.to_bytes()
    draw = random.Random(5)
    ends = {"refused": 0, "went on": 0, "defect": 0}
    for _ in range(400):
        try:
            traffic = Traffic.from_bytes(layout, spoilt(saved, draw))
        except ValueError:
            ends["refused"] += 1
            continue
        try:
            while traffic.now_us < 90_000_000 and traffic.advance(90_000_000):
                pass
            traffic.heat()
            ends["went on"] += 1
        except InternalError as error:
            assert ".rs:" in str(error)
            with pytest.raises(InternalError):
                traffic.advance(100_000_000)
            ends["defect"] += 1
    assert all(ends.values()), ends


@pytest.fixture
def traffic():
    return Traffic(load("default", [(["robots"], 2)]))


def test_numbers_that_do_not_exist(traffic):
    for ask in (
        lambda: traffic.travel_times_to(10**6, False),
        lambda: traffic.travel_times_from(10**6, False),
        lambda: traffic.command(0, [(Step.DRIVE, 10**6)]),
        lambda: traffic.command(0, [(Step.STATION, 99)]),
        lambda: traffic.command(7, []),
        lambda: traffic.plan(7),
        lambda: traffic.hold(0, -1),
        lambda: traffic.slow_down(0, 3),
        lambda: traffic.close([10**6]),
        lambda: traffic.regroup([(10**6, 0.0, 0), None]),
        lambda: traffic.regroup([None]),
    ):
        with pytest.raises(ValueError, match=r"no |rests for|a stop of"):
            ask()
    assert np.isfinite(traffic.travel_times_to(0, False)).any()

"""The base over a serial port: a pseudo-terminal with an emulated base at its other end."""

import math
import os
import select
import threading
import time
import tty

import numpy as np
import pytest

from rmfs.demonstrator.emulator.base import EmulatedBase
from rmfs.demonstrator.robot.create2 import (
    METRES_PER_COUNT,
    TRACK_M,
    BaseError,
    Counts,
    Create2,
)

serial = pytest.importorskip("serial")

PATIENCE_S = 20.0


class Port:
    """Keeps what is written; answers what it was told."""

    def __init__(self, answer=b""):
        self.written, self.answer = b"", answer

    def write(self, data):
        self.written += data

    def read(self, size):
        return self.answer[:size]


def test_commands_byte_by_byte():
    """As the Open Interface's document has them: 145 right high, right low, left high, left low."""
    port = Port()
    base = Create2(port)
    base.start()
    base.drive(0.2, -0.2)
    base.end()
    assert port.written == bytes(
        [
            *(128, 131),
            *(145, 0xFF, 0x38, 0x00, 0xC8),  # -200 mm/s is 0xFF38
            *(145, 0, 0, 0, 0),
            173,
        ]
    )


def test_speed_is_limited_to_what_the_base_can():
    port = Port()
    Create2(port).drive(9.0, -9.0)
    assert port.written == bytes([145, 0xFE, 0x0C, 0x01, 0xF4])


def test_counters_run_over():
    """65,536 counts are 29.1 m; one count after 65,535 is 0."""
    assert abs(65_536 * METRES_PER_COUNT - 29.14) < 0.01
    left, right = Counts(10, 65_526).rolled_m(Counts(65_526, 10))
    assert left == pytest.approx(20 * METRES_PER_COUNT)
    assert right == pytest.approx(-20 * METRES_PER_COUNT)


def test_a_base_that_does_not_answer():
    with pytest.raises(BaseError, match="3 of 4 bytes"):
        Create2(Port(b"abc")).counts()


@pytest.fixture
def emulated():
    """A base at the other end of a pseudo-terminal; the test lets its time pass."""
    master, slave = os.openpty()
    tty.setraw(slave)
    base = EmulatedBase(0.0, 0.0, 0.0, 1.0, 0.0, np.random.default_rng(0))
    ended = threading.Event()

    def serve():
        while not ended.is_set():
            if select.select([master], [], [], 0.01)[0]:
                base.write(os.read(master, 1024))
                os.write(master, base.read(1024))

    thread = threading.Thread(target=serve, daemon=True)
    thread.start()
    yield base, os.ttyname(slave)
    ended.set()
    thread.join()
    os.close(master)
    os.close(slave)


def wait_for(condition):
    end = time.monotonic() + PATIENCE_S
    while not condition() and time.monotonic() < end:
        time.sleep(0.005)
    assert condition()


def test_driving_and_turning_over_a_serial_port(emulated):
    floor, name = emulated
    with serial.Serial(name, 115_200, timeout=1.0) as port:
        base = Create2(port)
        base.start()
        before = base.counts()
        base.drive(0.2, 0.2)
        wait_for(lambda: floor._wanted_right == 0.2)
        for _ in range(100):
            floor.roll(0.05)
        left, right = base.counts().rolled_m(before)
        assert left == right == pytest.approx(floor.x_m, abs=2 * METRES_PER_COUNT)
        assert floor.x_m == pytest.approx(1.0, abs=0.02)
        base.drive(-0.1, 0.1)
        wait_for(lambda: floor._wanted_left == -0.1)
        before, heading = base.counts(), floor.heading_rad
        for _ in range(20):
            floor.roll(0.05)
        left, right = base.counts().rolled_m(before)
        turned = floor.heading_rad - heading
        assert (right - left) / TRACK_M == pytest.approx(turned, abs=0.01)
        assert turned == pytest.approx(2 * 0.1 / TRACK_M, rel=0.2)
        assert base.charge() == 1.0
        base.end()
        wait_for(lambda: not floor.is_on)
        with pytest.raises(BaseError):
            Create2(port).counts()  # it sleeps


def test_a_flat_battery_is_silence(emulated):
    floor, name = emulated
    with serial.Serial(name, 115_200, timeout=0.1) as port:
        base = Create2(port)
        base.start()
        floor.battery = 0.0
        with pytest.raises(BaseError, match="0 of 4"):
            base.counts()


def test_turning_rate_of_the_paper():
    """5.5 s a turn: the wheels then roll at 0.134 m/s."""
    assert 2 * math.pi / 5.5 * TRACK_M / 2 == pytest.approx(0.134, abs=0.001)

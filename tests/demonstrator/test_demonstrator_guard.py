"""The motors stop when the robot's program dies or hangs."""

import os
import select
import signal
import threading
import time
import tty

import numpy as np
import pytest

from rmfs.demonstrator.emulator.base import EmulatedBase
from rmfs.demonstrator.robot.guard import guarded

pytest.importorskip("serial")
pytest.importorskip("cv2")


def run(program, patience_s=0.5):
    stops = []
    code = guarded(program, lambda: stops.append(time.monotonic()), patience_s)
    assert len(stops) == 1
    return code


def test_a_program_that_ends(tmp_path):
    def program(alive):
        alive()
        (tmp_path / "ran").touch()

    assert run(program) == 0
    assert (tmp_path / "ran").exists()


def test_a_program_that_fails(capfd):
    def program(alive):
        alive()
        raise ValueError("a defect")

    assert run(program) == 1
    assert "a defect" in capfd.readouterr().err


def test_a_program_that_is_killed():
    assert run(lambda alive: os.kill(os.getpid(), signal.SIGKILL)) == -signal.SIGKILL


def test_a_program_that_hangs_is_killed():
    def program(alive):
        alive()
        time.sleep(60)

    assert run(program, 0.05) == -signal.SIGKILL


def test_a_slow_beginning_is_no_hanging():
    def program(alive):
        time.sleep(0.2)
        alive()

    assert run(program, 0.05) == 0


class Line:
    """A camera that sees a line, but dies after so many images."""

    def __init__(self, images):
        self._left = images
        self._image = np.full((32, 64, 3), 170, np.uint8)
        self._image[:, 28:36] = 35

    def frame(self):
        self._left -= 1
        if self._left < 0:
            os.kill(os.getpid(), signal.SIGKILL)
        return self._image


def test_the_program_of_a_real_robot_over_pseudo_terminals(tmp_path):
    """It connects, obeys an order, is killed in the midst of it; the guard stops the wheels."""
    from rmfs.demonstrator.robot.__main__ import main
    from rmfs.demonstrator.server.hub import Hub

    secret = tmp_path / "secret"
    secret.write_text("known to both\n")
    hub = Hub("127.0.0.1", 0, b"known to both", ["robot-0"])
    base = EmulatedBase(0.0, 0.0, 0.0, 1.0, 0.0, np.random.default_rng(0))
    masters, names = zip(*(terminal() for _ in range(2)), strict=True)
    heard, speeds, ended = [], [], threading.Event()

    def laboratory():
        last = begun = time.monotonic()
        while not ended.is_set():
            if select.select([masters[0]], [], [], 0.002)[0]:
                base.write(os.read(masters[0], 1024))
                os.write(masters[0], base.read(1024))
            now = time.monotonic()
            base.roll(now - last)
            speeds.append(base._wanted_left)
            last, now_us = now, round((now - begun) * 1e6)
            for _, message in hub.poll(now_us, 0.002):
                heard.append(message)
                if message["type"] == "state":
                    hub.send("robot-0", GO)
            hub.flush(now_us)

    thread = threading.Thread(target=laboratory, daemon=True)
    thread.start()
    given = {
        "server": "{}:{}".format(*hub.address),
        "robot": "robot-0",
        "secret": str(secret),
        "base": names[0],
        "tags": names[1],
        "memory": str(tmp_path / "memory.json"),
    }
    arguments = [part for key, value in given.items() for part in (f"--{key}", value)]
    try:
        assert main([*arguments, "--once"], camera=lambda: Line(20)) == 0
        time.sleep(0.1)
    finally:
        ended.set()
        thread.join()
        hub.close()
        for descriptor in masters:
            os.close(descriptor)
    assert [message["type"] for message in heard[:2]] == ["connected", "state"]
    assert max(speeds) > 0.1
    assert speeds[-1] == 0.0
    assert base.is_on
    assert base.x_m > 0.05


GO = {
    "type": "go",
    "id": 1,
    "actions": ["straight"],
    "start": "A",
    "tags": ["B"],
    "metres": [5.0],
    "granted": 1,
    "turned": True,
    "passed": 0,
}


def terminal():
    master, slave = os.openpty()
    tty.setraw(slave)
    return master, os.ttyname(slave)

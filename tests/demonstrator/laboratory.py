"""A server and an emulated room in one process, for tests."""

from __future__ import annotations

import threading
from contextlib import contextmanager

from rmfs import layout as layouts
from rmfs.demonstrator import settings
from rmfs.demonstrator.emulator.pace import RealTime
from rmfs.demonstrator.emulator.room import Address, Room
from rmfs.demonstrator.emulator.unkind import Unkindness
from rmfs.demonstrator.server.demonstration import Demonstration, expected
from rmfs.demonstrator.server.hub import Hub

SECRET = b"a secret of tests"
RADII_M = 0.34
"""Two robots of the layout `demonstrator` touch at this distance."""


class Laboratory:
    """All of a demonstration; `run` runs it and returns the run, `room.truth` knows what happened.

    `mischief(room)` is called after each tick of the room.
    """

    def __init__(self, folder, unkindness=None, *, real=None, mischief=None, in_step=True):
        self.plan = layouts.load("demonstrator")
        self.robots = settings.robots(self.plan, real)
        self.tags = settings.tags(self.plan, None)
        self._mischief, self._in_step = mischief, in_step
        self.journal = folder / "journal"
        self.start_server(0)
        self.address = Address(*self.hub.address, SECRET)
        self.room = Room(
            self.plan,
            self.robots,
            self.tags,
            self.address,
            unkindness or Unkindness(),
            7,
            pace=None if in_step else RealTime(),
        )

    def start_server(self, port, **options):
        names = expected(self.robots, is_emulated=self._in_step)
        self.hub = Hub("127.0.0.1", port, SECRET, names)
        self.demonstration = Demonstration(
            self.hub, self.robots, self.tags, self.journal, is_emulated=self._in_step, **options
        )

    @property
    def counts(self):
        return self.demonstration.traffic.guide.counts

    def run(self, duration_s, controllers="random", **options):
        with self.room_goes_on():
            return self.serve(duration_s, controllers, **options)

    def serve(self, duration_s, controllers="random", **options):
        overrides = [(["scenario", "duration_s"], duration_s), (["scenario", "warmup_s"], 0.0)]
        return self.demonstration.run(
            "demonstrator", "demonstrator", controllers, overrides=overrides, **options
        )

    @contextmanager
    def room_goes_on(self):
        failed = []

        def go_on():
            try:
                self.room.run(each=self._mischief)
            except BaseException as error:
                failed.append(error)
            finally:
                self.room.close()

        thread = threading.Thread(target=go_on, daemon=True)
        thread.start()
        try:
            yield
        finally:
            if not self._in_step:
                self.room.stop()
            thread.join(30)
        if failed:
            raise failed[0]

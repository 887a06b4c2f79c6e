"""Timing of a room of emulated robots: synchronised with the server, or by the wall clock."""

from __future__ import annotations

import time
from functools import partial
from typing import TYPE_CHECKING, Protocol

from rmfs.demonstrator.robot.client import Link, TcpWire
from rmfs.demonstrator.server.clock import ROOM
from rmfs.demonstrator.server.guide import TICK_US

if TYPE_CHECKING:
    from rmfs.demonstrator.emulator.room import Address, Room


class Pace(Protocol):
    """Controls when an emulated room proceeds from one tick (time step) to the next."""

    has_ended: bool
    """Whether the demonstration is over."""

    def begin(self) -> None:
        """Wait until the first tick may begin."""

    def tick(self, room: Room) -> bool:
        """Wait until the room may begin the next tick; return false if there is no next tick."""

    def close(self) -> None:
        """End the connection to the server, if there is one."""


class RealTime:
    """Timing by the wall clock. It is not synchronised with the server, which has its own clock."""

    def __init__(self) -> None:
        self.has_ended = False

    def begin(self) -> None:
        """Begin immediately."""
        self._zero = time.monotonic()

    def tick(self, room: Room) -> bool:
        """Sleep until the wall clock reaches the present time of the room; return true."""
        time.sleep(max(0.0, self._zero + room.now_us / 1e6 - time.monotonic()))
        return True

    def close(self) -> None:
        """Do nothing, as there is no connection."""


class InStep:
    """Synchronous timing: the room keeps the clock and waits for the server after each tick.

    Parameters
    ----------
    address
        Address of the server.
    """

    def __init__(self, address: Address) -> None:
        connect = partial(TcpWire, address.host, address.port)
        self._link = Link(connect, address.secret, ROOM)
        self._waited_us = 0
        self._tock_us = -1
        self.has_ended = False

    def begin(self) -> None:
        """Connect to the server, waiting until it is available."""
        while not self._link.is_up:
            self._greet(0)

    def tick(self, room: Room) -> bool:
        """Send the time to the server, and wait until the server has processed the tick.

        If there is no connection, try to connect, and wait for one tick of wall time if this fails.
        Return false if the server ends the demonstration instead of processing the tick, and true
        otherwise.
        """
        if not self._link.is_up:
            self._greet(room.now_us)  # nobody there: time goes on as it does
            return True
        self._link.send({"type": "tick", "time_us": room.now_us, "sent": room.sent()})
        self._link.flush(room.now_us)
        while self._link.is_up and self._tock_us < room.now_us and not self.has_ended:
            self._link.wait(0.2)
            for message in self._link.poll(room.now_us):
                if message["type"] == "tock":
                    self._tock_us = message["time_us"]
                    room.fetch(message["sent"])
                self.has_ended = self.has_ended or message["type"] == "end"
        return self._tock_us >= room.now_us or not self.has_ended

    def close(self) -> None:
        """End the connection."""
        self._link.close()

    def _greet(self, now_us: int) -> None:
        """Try to connect to the server; if there is still no session, sleep for one tick."""
        self._waited_us = max(self._waited_us, now_us) + TICK_US
        self._link.poll(self._waited_us)
        if not self._link.is_up:
            time.sleep(TICK_US / 1e6)

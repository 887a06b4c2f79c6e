"""The clock of a demonstration: the wall clock, or that of an emulated room.

One clock governs plans, heartbeats and timeouts. An emulated room is a program that emulates robots
on a floor. If the room keeps the clock, it synchronises with the server in every tick: it sends the
time, and the number of bytes that each robot has sent so far. When the server has received these
bytes and has done everything due at this time, the server answers with the number of bytes that it
has sent to each robot.

    room -> server   tick: time_us, sent (number of bytes for each robot)
    server -> room   tock: time_us, sent (number of bytes for each robot)
"""

from __future__ import annotations

import time
from typing import TYPE_CHECKING, Protocol

if TYPE_CHECKING:
    from rmfs.demonstrator.robot.protocol import Message
    from rmfs.demonstrator.server.hub import Hub

ROOM = "room"
"""Name with which an emulated room identifies itself."""

PATIENCE_S = 60.0
"""Wall time, in s, after which an emulated room that sends no message counts as gone."""


class RoomGoneError(RuntimeError):
    """Raised if the emulated room has stopped responding."""


class Clock(Protocol):
    """The clock of a demonstration."""

    def wait(self, hub: Hub, time_us: int) -> list[tuple[str, Message]]:
        """Wait until a time is reached, and return the messages received from robots meanwhile."""

    def passed(self, hub: Hub, time_us: int) -> None:
        """Signal that everything due at the time `time_us` has been done."""


class WallClock:
    """The wall clock; the demonstration's time is `begin_us` when the clock is created."""

    def __init__(self, begin_us: int = 0) -> None:
        self._zero = time.monotonic() - begin_us / 1e6

    def wait(self, hub: Hub, time_us: int) -> list[tuple[str, Message]]:
        """Receive messages until a time is reached, and return them."""
        messages: list[tuple[str, Message]] = []
        while (left_s := time_us / 1e6 - (time.monotonic() - self._zero)) > 0:
            messages += hub.poll(time_us, left_s)
        return messages + hub.poll(time_us, 0.0)

    def passed(self, hub: Hub, time_us: int) -> None:
        """Do nothing; the wall clock runs by itself."""


class RoomClock:
    """The clock of an emulated room."""

    def __init__(self) -> None:
        self._room_us = -1
        self._expected: dict[str, int] = {}

    def wait(self, hub: Hub, time_us: int) -> list[tuple[str, Message]]:
        """Wait until the room has reached a time, and return the messages of its robots.

        The wait ends when all bytes that the robots have sent up to this time have been received.

        Raises
        ------
        RoomGoneError
            If the room has sent no `tick` message for `PATIENCE_S`.
        """
        messages: list[tuple[str, Message]] = []
        begun = time.monotonic()
        while not self._is_complete(hub, time_us):
            for name, message in hub.poll(time_us, 0.5):
                if name != ROOM:
                    messages.append((name, message))
                elif message["type"] == "tick":
                    self._hear(hub, message, time_us)
                    begun = time.monotonic()
            if time.monotonic() - begun > PATIENCE_S:
                raise RoomGoneError(f"the emulated room has sent no message for {PATIENCE_S:.0f} s")
        return messages

    def passed(self, hub: Hub, time_us: int) -> None:
        """Tell the room to continue, since everything due at this time has been done."""
        if self._room_us == time_us:
            self._answer(hub, time_us)

    def _hear(self, hub: Hub, tick: Message, time_us: int) -> None:
        self._room_us = int(tick["time_us"])
        self._expected = {str(name): int(size) for name, size in tick["sent"].items()}
        if self._room_us < time_us:
            # a tick already done before the server was started again
            self._answer(hub, self._room_us)

    def _is_complete(self, hub: Hub, time_us: int) -> bool:
        arrived = all(
            name in hub.dropped or hub.traffic_of(name)[0] >= size
            for name, size in self._expected.items()
        )
        return self._room_us >= time_us and arrived

    def _answer(self, hub: Hub, time_us: int) -> None:
        sent = {name: hub.traffic_of(name)[1] for name in hub.present if name != ROOM}
        hub.send(ROOM, {"type": "tock", "time_us": time_us, "sent": sent})
        hub.flush(time_us)

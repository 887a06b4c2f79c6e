"""A connection that loses and delays frames, that is, encoded messages."""

from __future__ import annotations

import select
from collections import deque
from typing import TYPE_CHECKING

from rmfs.demonstrator.robot.client import TcpWire

if TYPE_CHECKING:
    import numpy as np

    from rmfs.demonstrator.emulator.unkind import Unkindness

_HEAD = 36  # bytes of a frame before its text


class UnkindWire:
    """A TCP connection that delays frames and loses some, but not the first frame of either side.

    Parameters
    ----------
    tcp
        The connection.
    unkindness
        Imperfections of the room; only `lost_messages` and `delay_us` are used.
    rng
        Random stream from which losses and delays are drawn.

    Attributes
    ----------
    now_us
        Present time in microseconds, which the room sets.
    written, received
        Number of bytes written to and received from the connection.
    """

    def __init__(
        self, tcp: TcpWire, unkindness: Unkindness, rng: np.random.Generator, now_us: int
    ) -> None:
        self._tcp, self._unkindness, self._rng = tcp, unkindness, rng
        self.now_us = now_us
        self.written = self.received = 0
        self.is_closed = False
        self._out: deque[tuple[int, bytes]] = deque()
        self._in: deque[tuple[int, bytes]] = deque()
        self._half = b""
        self._frames_in = self._frames_out = 0

    def write(self, frame: bytes) -> None:
        """Queue a frame, to be sent after its delay, unless the frame is lost."""
        self._frames_out += 1
        if self._frames_out == 1 or not self._is_lost():
            self._out.append((self._arrival_us(self._out), frame))
        self.pump()

    def read(self) -> bytes | None:
        """Return the bytes of the frames whose delay is over; None if the connection is closed."""
        self.fetch()
        due = []
        while self._in and self._in[0][0] <= self.now_us:
            due.append(self._in.popleft()[1])
        return None if self.is_closed and not due else b"".join(due)

    def close(self) -> None:
        """Close the connection."""
        self.is_closed = True
        self._tcp.close()

    def pump(self) -> None:
        """Send all queued frames whose delay is over."""
        while self._out and self._out[0][0] <= self.now_us and not self.is_closed:
            frame = self._out.popleft()[1]
            self._tcp.write(frame)
            self.written += len(frame)

    def fetch(self, upto: int | None = None, timeout_s: float = 5.0) -> None:
        """Read the bytes that have arrived; with `upto`, read until `received` reaches `upto`.

        Reading also ends if nothing arrives for `timeout_s` or the connection is closed.
        """
        while not self.is_closed:
            data = self._tcp.read()
            if data is None:
                self.close()
                return
            self._cut(data)
            if upto is None or self.received >= upto:
                return
            if not data and not select.select([self._tcp.fileno()], [], [], timeout_s)[0]:
                return

    def await_frame(self, timeout_s: float = 5.0) -> None:
        """Read until the first frame has arrived; stop if nothing arrives for `timeout_s`."""
        self.fetch(_HEAD, timeout_s)
        while not self.is_closed and not self._frames_in:
            before = self.received
            self.fetch(before + 1, timeout_s)
            if self.received == before:
                return

    def _cut(self, data: bytes) -> None:
        self.received += len(data)
        self._half += data
        while len(self._half) >= _HEAD:
            size = _HEAD + int.from_bytes(self._half[:4], "big")
            if len(self._half) < size:
                return
            frame, self._half = self._half[:size], self._half[size:]
            self._frames_in += 1
            if self._frames_in == 1 or not self._is_lost():
                self._in.append((self._arrival_us(self._in), frame))

    def _is_lost(self) -> bool:
        return bool(self._rng.random() < self._unkindness.lost_messages)

    def _arrival_us(self, before: deque[tuple[int, bytes]]) -> int:
        late = int(self._rng.integers(self._unkindness.delay_us + 1))
        return max(self.now_us + late, before[-1][0] if before else 0)

"""The robot's link to the server: connects, introduces itself, and comes back when it is cut off.

    link = Link(lambda: TcpWire("warehouse.local", 7888), secret, "robot-1")
    while True:
        now_us = time.monotonic_ns() // 1000
        for message in link.poll(now_us):
            ...
        link.send({"type": "tag", ...})
        link.flush(now_us)

Nothing here blocks, but for the opening of a connection. A session begins so: each side proves that
it knows the secret, then both have a key.

    server -> robot   welcome: version, nonce
    robot -> server   hello: version, name of the robot, nonce      (for this welcome only)
"""

from __future__ import annotations

import contextlib
import logging
import secrets
import select
import socket
from collections.abc import Callable
from typing import Protocol

from . import protocol
from .channel import SILENCE_US, Channel
from .protocol import Message, ProtocolError, Unpacker

RETRY_US = 1_000_000
"""So long after a failure the robot tries again."""

_log = logging.getLogger("rmfs.robot")


class Wire(Protocol):
    """Bytes to and from the server."""

    def read(self) -> bytes | None:
        """Return what has arrived, possibly nothing; None when the other side is gone."""

    def write(self, frame: bytes) -> None:
        """Send a whole frame."""

    def close(self) -> None:
        """Give up the connection."""


class TcpWire:
    """A TCP connection that never blocks once it stands."""

    def __init__(self, host: str, port: int, timeout_s: float = 2.0) -> None:
        self._socket = socket.create_connection((host, port), timeout_s)
        self._socket.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        self._socket.setblocking(False)
        self._unsent = bytearray()

    def fileno(self) -> int:
        """Return the file descriptor, for `select`."""
        return self._socket.fileno()

    def read(self) -> bytes | None:
        """Return what has arrived."""
        self._push()
        try:
            return self._socket.recv(65_536) or None
        except (BlockingIOError, InterruptedError):
            return b""
        except OSError:
            return None

    def write(self, frame: bytes) -> None:
        """Send a frame, now or when there is room."""
        self._unsent += frame
        self._push()

    def close(self) -> None:
        """Close the connection."""
        self._socket.close()

    def _push(self) -> None:
        # a connection that is gone shows when it is read
        with contextlib.suppress(OSError):
            while self._unsent:
                sent = self._socket.send(self._unsent)
                del self._unsent[:sent]


class Link:
    """A robot's session with the server.

    Parameters
    ----------
    connect
        Opens a wire; raises OSError if that fails.
    secret
        Known to the server too.
    robot
        The robot's name.
    """

    def __init__(self, connect: Callable[[], Wire], secret: bytes, robot: str) -> None:
        self._connect, self._secret, self._robot = connect, secret, robot
        self._wire: Wire | None = None
        self._unpacker = Unpacker()
        self._channel: Channel | None = None
        self._opened_us = self._retry_us = 0

    @property
    def is_up(self) -> bool:
        """Whether there is a session."""
        return self._channel is not None

    def poll(self, now_us: int) -> list[Message]:
        """Return what the server has said; connects first if need be.

        The first message of every session is `{"type": "connected"}`, from this link itself.
        """
        if self._wire is None and not self._open(now_us):
            return []
        assert self._wire is not None
        data = self._wire.read()
        try:
            if data is None:
                raise ProtocolError("the server has closed the connection")
            if self._channel is None:
                return self._introduce(data, now_us)
            messages = self._channel.receive(data, now_us)
            if self._channel.is_silent(now_us):
                raise ProtocolError("the server is silent")
            return messages
        except ProtocolError as error:
            self._cut(now_us, str(error))
            return []

    def send(self, message: Message) -> bool:
        """Take a message for the server; false if there is no session, and the message is lost."""
        if self._channel is None:
            return False
        self._channel.send(message)
        return True

    def flush(self, now_us: int) -> None:
        """Write what is due."""
        if self._channel is not None and self._wire is not None:
            for frame in self._channel.outgoing(now_us):
                self._wire.write(frame)

    def wait(self, timeout_s: float) -> None:
        """Return when something has arrived or the time is over; only over a plain connection."""
        if isinstance(self._wire, TcpWire):
            select.select([self._wire.fileno()], [], [], timeout_s)

    def close(self) -> None:
        """End the session."""
        if self._wire is not None:
            self._wire.close()
        self._wire = self._channel = None

    def _open(self, now_us: int) -> bool:
        if now_us < self._retry_us:
            return False
        try:
            self._wire = self._connect()
        except OSError as error:
            self._retry_us = now_us + RETRY_US
            _log.info("%s: no connection: %s", self._robot, error)
            return False
        self._unpacker, self._opened_us = Unpacker(), now_us
        return True

    def _introduce(self, data: bytes, now_us: int) -> list[Message]:
        """Answer the welcome."""
        assert self._wire is not None
        for welcome in self._unpacker.feed(data, self._secret, protocol.WELCOME):
            if welcome.get("type") != "welcome" or welcome.get("version") != protocol.VERSION:
                raise ProtocolError(f"no welcome of version {protocol.VERSION}: {welcome}")
            theirs, own = protocol.text_of(welcome, "nonce"), secrets.token_hex(16)
            hello = {
                "type": "hello",
                "version": protocol.VERSION,
                "robot": self._robot,
                "nonce": own,
            }
            self._wire.write(protocol.pack(hello, self._secret, protocol.HELLO + theirs.encode()))
            key = protocol.session_key(self._secret, theirs, own)
            self._channel = Channel(key, protocol.ROBOT, protocol.SERVER, now_us)
            return [{"type": "connected"}]
        if now_us - self._opened_us > SILENCE_US:
            raise ProtocolError("no welcome")
        return []

    def _cut(self, now_us: int, why: str) -> None:
        _log.warning("%s: %s", self._robot, why)
        self.close()
        self._retry_us = now_us + RETRY_US

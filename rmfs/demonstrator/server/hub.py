"""Sessions over TCP with clients: robots and, if these are emulated, the emulated room.

An emulated room is a program that emulates robots on a floor (see the module `clock`).

If a client does not know the secret, uses another version of the protocol, or sends a frame that is
invalid or too long, its connection is closed, and this is logged. Other sessions are not affected.
"""

from __future__ import annotations

import logging
import selectors
import socket
import time
from typing import TYPE_CHECKING

from rmfs.demonstrator.robot.channel import Channel
from rmfs.demonstrator.robot.protocol import ROBOT, SERVER, Message, ProtocolError
from rmfs.demonstrator.server.greeting import Greeting, Guest

if TYPE_CHECKING:
    from collections.abc import Collection

_log = logging.getLogger("rmfs.demonstrator")

MOST_CONNECTIONS = 256
"""Maximum number of open connections, including those that have not identified themselves."""
UNKNOWN_S = 5.0
"""Wall time, in s, within which a client must identify itself."""


class _Connection:
    """The socket of a client, and the state of the connection."""

    def __init__(self, sock: socket.socket, peer: str, secret: bytes) -> None:
        self.socket, self.peer = sock, peer
        self.greeting: Greeting | None = Greeting(secret)
        self.channel: Channel | None = None
        self.name = ""
        self.opened = time.monotonic()
        self.received = 0
        self.sent = 0
        self._unsent = bytearray()
        self.write(self.greeting.welcome())

    def write(self, data: bytes) -> None:
        """Send as much as the socket accepts, and keep the rest until the next call."""
        self.sent += len(data)
        self._unsent += data
        try:
            while self._unsent:
                del self._unsent[: self.socket.send(self._unsent)]
        except (BlockingIOError, InterruptedError):
            if len(self._unsent) > 1_000_000:
                raise ProtocolError(
                    "the other side does not read the messages sent to it"
                ) from None
        except OSError as error:
            raise ProtocolError(str(error)) from None


class Hub:
    """Accepts connections of clients and exchanges messages with them.

    Parameters
    ----------
    host, port
        Address and port on which to listen; port 0 selects a free one.
    secret
        Secret shared with the clients.
    names
        Names of the clients that may connect.

    Attributes
    ----------
    refused
        Number of connections that were closed before a session began.
    dropped
        Names of the clients whose last session has ended and that have not reconnected since.
    """

    def __init__(self, host: str, port: int, secret: bytes, names: Collection[str]) -> None:
        self._secret, self._names = secret, frozenset(names)
        self._selector = selectors.DefaultSelector()
        self._listener = socket.create_server((host, port), backlog=32)
        self._listener.setblocking(False)
        self._selector.register(self._listener, selectors.EVENT_READ)
        self._connections: dict[int, _Connection] = {}
        self._sessions: dict[str, _Connection] = {}
        self._inbox: list[tuple[str, Message]] = []
        self.refused = 0
        self.dropped: set[str] = set()

    @property
    def address(self) -> tuple[str, int]:
        """Host and port on which the hub listens."""
        host, port = self._listener.getsockname()[:2]
        return str(host), int(port)

    @property
    def present(self) -> frozenset[str]:
        """Names of the clients that have a session."""
        return frozenset(self._sessions)

    def silent(self, now_us: int) -> frozenset[str]:
        """Return the names of the clients that have a session but have sent nothing for 3 s."""
        return frozenset(
            name
            for name, session in self._sessions.items()
            if session.channel is not None and session.channel.is_silent(now_us)
        )

    def traffic_of(self, name: str) -> tuple[int, int]:
        """Return the numbers of bytes received from and sent to a client in its present session."""
        session = self._sessions.get(name)
        return (session.received, session.sent) if session else (0, 0)

    def poll(self, now_us: int, timeout_s: float) -> list[tuple[str, Message]]:
        """Wait for data for at most `timeout_s`; return the new messages in order of arrival.

        Each message is returned with the name of its sender.

        The beginning of a session is reported as `{"type": "connected"}`, its end as
        `{"type": "gone"}`.
        """
        for key, _ in self._selector.select(timeout_s):
            if key.fileobj is self._listener:
                self._accept()
            else:
                self._read(self._connections[key.fd], now_us)
        self._forget_strangers()
        inbox, self._inbox = self._inbox, []
        return inbox

    def send(self, name: str, message: Message) -> None:
        """Queue a message for a client, or drop it if the client has no session.

        A dropped message to a robot does no harm: when the robot begins its next session, the
        server sends the robot's unfinished route order again, with the current progress.
        """
        session = self._sessions.get(name)
        if session is not None and session.channel is not None:
            session.channel.send(message)

    def flush(self, now_us: int) -> None:
        """Send the frames that are due."""
        for session in list(self._sessions.values()):
            assert session.channel is not None
            try:
                for frame in session.channel.outgoing(now_us):
                    session.write(frame)
            except ProtocolError as error:
                self._drop(session, str(error))

    def close(self) -> None:
        """End all sessions, and stop listening."""
        for connection in list(self._connections.values()):
            connection.socket.close()
        self._selector.close()
        self._listener.close()

    # --- connections --------------------------------------------------------------------------

    def _accept(self) -> None:
        try:
            sock, peer = self._listener.accept()
        except OSError:
            return
        if len(self._connections) >= MOST_CONNECTIONS:
            _log.warning("%s refused: %d connections are open", peer[0], MOST_CONNECTIONS)
            self.refused += 1
            sock.close()
            return
        sock.setblocking(False)
        sock.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        try:
            connection = _Connection(sock, f"{peer[0]}:{peer[1]}", self._secret)
        except ProtocolError:
            self.refused += 1
            sock.close()
            return
        self._connections[sock.fileno()] = connection
        self._selector.register(sock, selectors.EVENT_READ)

    def _read(self, connection: _Connection, now_us: int) -> None:
        try:
            data = connection.socket.recv(65_536)
        except (BlockingIOError, InterruptedError):
            return
        except OSError as error:
            self._drop(connection, str(error))
            return
        connection.received += len(data)
        try:
            if not data:
                raise ProtocolError("closed by the other side")
            self._understand(connection, data, now_us)
        except ProtocolError as error:
            self._drop(connection, str(error))

    def _understand(self, connection: _Connection, data: bytes, now_us: int) -> None:
        if connection.greeting is not None:
            guest = connection.greeting.receive(data)
            if guest is None:
                return
            self._begin(connection, guest, now_us)
            data = b""
        assert connection.channel is not None
        before = connection.channel.refused
        for message in connection.channel.receive(data, now_us):
            self._inbox.append((connection.name, message))
        if connection.channel.refused > before:
            _log.debug("%s: a message is out of sequence", connection.name)

    def _begin(self, connection: _Connection, guest: Guest, now_us: int) -> None:
        name = guest.name
        if name not in self._names:
            raise ProtocolError(f"no robot named {name!r} is expected")
        older = self._sessions.get(name)
        if older is not None:
            self._drop(older, "the robot has connected again")
        connection.name, connection.greeting = name, None
        connection.channel = Channel(guest.key, SERVER, ROBOT, now_us, guest.rest)
        self._sessions[name] = connection
        self.dropped.discard(name)
        self._inbox.append((name, {"type": "connected"}))
        _log.info("%s: connected from %s", name, connection.peer)

    def _drop(self, connection: _Connection, why: str) -> None:
        self._selector.unregister(connection.socket)
        del self._connections[connection.socket.fileno()]
        connection.socket.close()
        if connection.name and self._sessions.get(connection.name) is connection:
            del self._sessions[connection.name]
            self.dropped.add(connection.name)
            self._inbox.append((connection.name, {"type": "gone"}))
            _log.warning("%s: session ended: %s", connection.name, why)
        else:
            self.refused += 1
            _log.warning("%s refused: %s", connection.peer, why)

    def _forget_strangers(self) -> None:
        limit = time.monotonic() - UNKNOWN_S
        for connection in list(self._connections.values()):
            if connection.greeting is not None and connection.opened < limit:
                self._drop(connection, "it has sent no valid hello in time")

"""The server's side of the handshake."""

from __future__ import annotations

import secrets
from typing import NamedTuple

from rmfs.demonstrator.robot.protocol import (
    HELLO,
    VERSION,
    WELCOME,
    ProtocolError,
    Unpacker,
    pack,
    session_key,
    text_of,
)


class Guest(NamedTuple):
    """A client that has identified itself.

    It has a name, the key of its session, and the bytes received after its first message.
    """

    name: str
    key: bytes
    rest: bytes


class Greeting:
    """The handshake of a connection: the server's welcome, and the client's hello in reply to it.

    A hello is valid for one welcome only.

    Parameters
    ----------
    secret
        Secret shared with the robots.
    """

    def __init__(self, secret: bytes) -> None:
        self._secret = secret
        self._nonce = secrets.token_hex(16)
        self._unpacker = Unpacker()

    def welcome(self) -> bytes:
        """Return the first frame of the connection, the welcome."""
        message = {"type": "welcome", "version": VERSION, "nonce": self._nonce}
        return pack(message, self._secret, WELCOME)

    def receive(self, data: bytes) -> Guest | None:
        """Add received bytes; return the client if it has identified itself by then, else None.

        Raises
        ------
        ProtocolError
            If the client does not know the secret, or uses another version.
        """
        for hello in self._unpacker.feed(data, self._secret, HELLO + self._nonce.encode()):
            if hello.get("type") != "hello" or hello.get("version") != VERSION:
                raise ProtocolError(f"expected hello, version {VERSION}: {hello}")
            key = session_key(self._secret, self._nonce, text_of(hello, "nonce"))
            return Guest(text_of(hello, "robot"), key, bytes(self._unpacker.rest))
        return None

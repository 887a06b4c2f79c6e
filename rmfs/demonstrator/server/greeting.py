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

    Attributes
    ----------
    name
        Name of the client.
    key
        Key of the client's session.
    rest
        Bytes received after the client's first frame.
    """

    name: str
    key: bytes
    rest: bytes


class Greeting:
    """The handshake of a connection: the server's welcome, and the client's hello in reply to it.

    Both are frames. A hello is valid only as the reply to one particular welcome.

    Parameters
    ----------
    secret
        Secret shared with the clients.
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
        """Process received bytes; return the client if its hello is now complete, otherwise None.

        Raises
        ------
        ProtocolError
            If the client does not know the secret, uses another version of the protocol, or sends
            an invalid hello.
        """
        for hello in self._unpacker.feed(data, self._secret, HELLO + self._nonce.encode()):
            if hello.get("type") != "hello" or hello.get("version") != VERSION:
                raise ProtocolError(f"expected hello, version {VERSION}: {hello}")
            key = session_key(self._secret, self._nonce, text_of(hello, "nonce"))
            return Guest(text_of(hello, "robot"), key, bytes(self._unpacker.rest))
        return None

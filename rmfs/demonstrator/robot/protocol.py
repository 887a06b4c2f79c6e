"""The format of frames: a length, an authentication code, and a JSON object.

    frame := length (4 bytes, big-endian) code (32 bytes, HMAC-SHA256) text (length bytes, UTF-8)

The code covers the text (the JSON object) and a label, which is not sent. The first frame of the
server (welcome), the first frame of the robot (hello), and the later frames of each direction have
different labels, so that no frame is accepted in place of another kind of frame. The label of the
hello contains the server's nonce (a random text used only once), so that a hello recorded in an
earlier session is not accepted. The codes of welcome and hello use a secret that both sides know.
All later codes use a key derived from this secret and from a nonce of each side.
"""

from __future__ import annotations

import hashlib
import hmac
import json
from collections.abc import Iterator
from typing import Any

VERSION = 1
LARGEST = 65_536
"""Maximum length of a text in bytes; a longer one is refused before it is read."""
WELCOME, HELLO, SERVER, ROBOT = b"welcome", b"hello/", b"server", b"robot"
"""Labels of the server's first frame, of the robot's first frame (followed by the server's nonce),
and of later frames in each direction."""
_LENGTH, _HEAD = 4, 36

Message = dict[str, Any]


class ProtocolError(Exception):
    """Raised if the other side violates the protocol; the connection must then be closed."""


def code(key: bytes, label: bytes, text: bytes) -> bytes:
    """Return the authentication code of a label and a text."""
    return hmac.digest(key, len(label).to_bytes(2, "big") + label + text, hashlib.sha256)


def session_key(secret: bytes, server_nonce: str, robot_nonce: str) -> bytes:
    """Return the key of a session, derived from the secret and the nonces of both sides."""
    return code(secret, b"session", f"{server_nonce}/{robot_nonce}".encode())


def pack(message: Message, key: bytes, label: bytes) -> bytes:
    """Return a message as a frame; raise ValueError if its text is longer than `LARGEST`."""
    text = json.dumps(message, separators=(",", ":"), allow_nan=False).encode()
    if len(text) > LARGEST:
        raise ValueError(f"a message has {len(text)} bytes; at most {LARGEST} are allowed")
    return len(text).to_bytes(_LENGTH, "big") + code(key, label, text) + text


class Unpacker:
    """Divides received bytes into frames; the bytes of an incomplete frame are kept in `rest`."""

    def __init__(self, rest: bytes = b"") -> None:
        self.rest = bytearray(rest)

    def feed(self, data: bytes, key: bytes, label: bytes) -> Iterator[Message]:
        """Add received bytes, and yield the messages that are now complete.

        Raises
        ------
        ProtocolError
            If a frame is too long, has a wrong code, or contains no JSON object.
        """
        self.rest += data
        while len(self.rest) >= _LENGTH:
            size = int.from_bytes(self.rest[:_LENGTH], "big")
            if size > LARGEST:
                raise ProtocolError(f"a frame has {size} bytes; at most {LARGEST} are allowed")
            if len(self.rest) < _HEAD + size:
                return
            proof, text = bytes(self.rest[_LENGTH:_HEAD]), bytes(self.rest[_HEAD : _HEAD + size])
            del self.rest[: _HEAD + size]
            if not hmac.compare_digest(proof, code(key, label, text)):
                raise ProtocolError("a frame has a wrong authentication code")
            try:
                message = json.loads(text)
            except (ValueError, RecursionError) as error:
                raise ProtocolError(f"not JSON: {error}") from None
            if not isinstance(message, dict):
                raise ProtocolError("not a JSON object")
            yield message


def text_of(message: Message, name: str, longest: int = 64) -> str:
    """Return the text in a field; raise ProtocolError if the text is missing, empty or too long."""
    value = message.get(name)
    if not isinstance(value, str) or not 0 < len(value) <= longest:
        raise ProtocolError(f"{name} must have 1 to {longest} characters (given: {value!r})")
    return value


def whole(message: Message, name: str) -> int:
    """Return the value of a field; raise ProtocolError if the value is not an integer >= 0."""
    value = message.get(name)
    if not isinstance(value, int) or isinstance(value, bool) or value < 0:
        raise ProtocolError(f"{name} must be a whole number, 0 or more (given: {value!r})")
    return value

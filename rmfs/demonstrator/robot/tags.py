"""Readers of tags in the floor."""

from __future__ import annotations

from typing import Protocol


class TagReader(Protocol):
    """A reader of the tags over which the robot drives."""

    def read(self) -> str | None:
        """Return the tag detected since the previous call; None if there is none."""


class SerialTagReader:
    """A tag reader that sends each tag over a serial port, as a line of hexadecimal digits.

    Parameters
    ----------
    port
        The serial port, in non-blocking mode.
    """

    def __init__(self, port: ReadablePort) -> None:
        self._port = port
        self._line = bytearray()
        self._last: str | None = None

    def read(self) -> str | None:
        """Return the last tag received since the previous call; None if there is none.

        A tag that is received several times in a row is returned only once.
        """
        found = None
        for byte in self._port.read(256):
            if byte not in b"\r\n":
                self._line.append(byte)
                continue
            tag = self._line.decode("ascii", "replace").strip().upper()
            self._line.clear()
            if tag and tag != self._last:
                found = self._last = tag
        return found


class ReadablePort(Protocol):
    """A serial port that can be read."""

    def read(self, size: int) -> bytes:
        """Return up to `size` bytes that have arrived."""

"""Readers of the tags in the floor."""

from __future__ import annotations

from typing import Protocol


class TagReader(Protocol):
    """Tells which tag is beneath the robot."""

    def read(self) -> str | None:
        """Return a tag that was not there the last time, or None."""


class SerialTagReader:
    """A reader that writes each tag as a line of hexadecimal digits to a serial port.

    Parameters
    ----------
    port
        The serial port, set not to wait.
    """

    def __init__(self, port: ReadablePort) -> None:
        self._port = port
        self._line = bytearray()
        self._last: str | None = None

    def read(self) -> str | None:
        """Return a tag that has come into reach."""
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
    """Bytes from a serial port."""

    def read(self, size: int) -> bytes:
        """Return up to `size` bytes that have arrived."""

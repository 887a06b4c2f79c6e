"""Driver of the iRobot Create 2 over its serial port (Create 2 Open Interface)."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple, Protocol

TRACK_M = 0.235
"""Distance between the wheels, in m."""
METRES_PER_COUNT = math.pi * 0.072 / 508.8
"""Distance per count of a wheel's counter, in m: a wheel of 72 mm diameter turns once in 508.8
counts."""
FASTEST_MM_S = 500

_START, _SAFE, _STOP, _DRIVE_DIRECT, _QUERY_LIST = 128, 131, 173, 145, 149
_LEFT_COUNTS, _RIGHT_COUNTS, _CHARGE, _CAPACITY = 43, 44, 25, 26
_COUNTS = bytes([_QUERY_LIST, 2, _LEFT_COUNTS, _RIGHT_COUNTS])
_BATTERY = bytes([_QUERY_LIST, 2, _CHARGE, _CAPACITY])


class SerialPort(Protocol):
    """A serial port connected to the robot's base."""

    def write(self, data: bytes) -> object:
        """Send bytes."""

    def read(self, size: int) -> bytes:
        """Return `size` bytes, or fewer if the time limit has passed."""


class BaseError(Exception):
    """Raised if the base does not answer."""


class Counts(NamedTuple):
    """The 16-bit counters of the left and the right wheel, which overflow after 29 m."""

    left: int
    right: int

    def rolled_m(self, since: Counts) -> tuple[float, float]:
        """Return how far, in m, the left and the right wheel rolled since an earlier reading."""
        return _metres(self.left, since.left), _metres(self.right, since.right)


@dataclass
class Create2:
    """The base of a robot.

    Parameters
    ----------
    port
        Serial port of the base (115,200 baud), with a time limit for reading.
    """

    port: SerialPort

    def start(self) -> None:
        """Put the base in safe mode: it obeys commands, but stops by itself at a cliff (a drop)."""
        self.port.write(bytes([_START, _SAFE]))

    def drive(self, left_m_s: float, right_m_s: float) -> None:
        """Set the speeds of the wheels, each limited to 0.5 m/s forwards and backwards."""
        right, left = (_millimetres(speed) for speed in (right_m_s, left_m_s))
        self.port.write(bytes([_DRIVE_DIRECT]) + _two_bytes(right) + _two_bytes(left))

    def stop(self) -> None:
        """Stop both wheels."""
        self.drive(0.0, 0.0)

    def end(self) -> None:
        """Stop the wheels; the base then ignores commands until `start` is called."""
        self.stop()
        self.port.write(bytes([_STOP]))

    def counts(self) -> Counts:
        """Return the wheels' counters.

        Raises
        ------
        BaseError
            If the base does not answer.
        """
        return Counts(*self._ask(_COUNTS))

    def charge(self) -> float:
        """Return the charge level of the battery, as a share of its capacity.

        Raises
        ------
        BaseError
            If the base does not answer.
        """
        charge, capacity = self._ask(_BATTERY)
        return charge / capacity if capacity else 0.0

    def _ask(self, question: bytes) -> tuple[int, int]:
        self.port.write(question)
        answer = self.port.read(4)
        if len(answer) < 4:
            raise BaseError(f"the base sent only {len(answer)} of 4 bytes")
        return int.from_bytes(answer[:2], "big"), int.from_bytes(answer[2:4], "big")


def _millimetres(speed_m_s: float) -> int:
    return max(-FASTEST_MM_S, min(FASTEST_MM_S, round(speed_m_s * 1000)))


def _two_bytes(value: int) -> bytes:
    return value.to_bytes(2, "big", signed=True)


def _metres(now: int, before: int) -> float:
    return ((now - before + 32_768) % 65_536 - 32_768) * METRES_PER_COUNT

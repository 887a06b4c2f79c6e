"""An emulated iRobot Create 2: its serial interface, and the motion of its wheels."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

from rmfs.demonstrator.robot.create2 import METRES_PER_COUNT, TRACK_M

if TYPE_CHECKING:
    import numpy as np

_LENGTHS = {128: 1, 131: 1, 132: 1, 173: 1, 145: 5, 137: 5}
_SENSORS = {43, 44, 25, 26}
CAPACITY_MAH = 2_696
WHEEL_ACCELERATION_M_S2 = 1.5


@dataclass
class EmulatedBase:
    """An emulated Create 2, the base of a robot: its serial interface and its true position.

    Attributes
    ----------
    x_m, y_m, heading_rad
        True position on the floor in m, and heading in rad: 0 along x, positive anticlockwise.
    speed_factor
        Ratio of the actual to the commanded speed of the wheels.
    slip
        Maximum share of a wheel's travel that is lost to slip; the share is drawn at each step.
    rng
        Random stream from which the slip is drawn.
    """

    x_m: float
    y_m: float
    heading_rad: float
    speed_factor: float
    slip: float
    rng: np.random.Generator
    is_on: bool = False
    battery: float = 1.0
    _left: float = 0.0
    _right: float = 0.0
    _wanted_left: float = 0.0
    _wanted_right: float = 0.0
    _left_rolled: float = 0.0
    _right_rolled: float = 0.0
    _inbox: bytes = b""
    _outbox: bytes = b""

    # --- serial port ---------------------------------------------------------------------------

    def write(self, data: bytes) -> int:
        """Execute commands of the Create 2 Open Interface; return the number of bytes in `data`."""
        self._inbox += data
        while (size := self._command_size()) and len(self._inbox) >= size:
            command, self._inbox = self._inbox[:size], self._inbox[size:]
            self._obey(command)
        return len(data)

    def read(self, size: int) -> bytes:
        """Return up to `size` bytes of the answers to commands."""
        answer, self._outbox = self._outbox[:size], self._outbox[size:]
        return answer

    def _command_size(self) -> int:
        while self._inbox:
            code = self._inbox[0]
            if code == 149:
                return 2 + self._inbox[1] if len(self._inbox) > 1 else 2
            if code in _LENGTHS:
                return _LENGTHS[code]
            self._inbox = self._inbox[1:]  # a byte that begins no command is ignored
        return 0

    def _obey(self, command: bytes) -> None:
        code = command[0]
        if self.battery <= 0:
            return
        if code in (128, 131, 132):
            self.is_on = True
        elif code == 173:
            self.is_on = False
            self._wanted_left = self._wanted_right = 0.0
        elif code == 145 and self.is_on:
            self._wanted_right = int.from_bytes(command[1:3], "big", signed=True) / 1000
            self._wanted_left = int.from_bytes(command[3:5], "big", signed=True) / 1000
        elif code == 149 and self.is_on and set(command[2:]) <= _SENSORS:
            self._outbox += b"".join(self._sensor(packet) for packet in command[2:])

    def _sensor(self, packet: int) -> bytes:
        value = {
            43: int(self._left_rolled / METRES_PER_COUNT),
            44: int(self._right_rolled / METRES_PER_COUNT),
            25: round(self.battery * CAPACITY_MAH),
            26: CAPACITY_MAH,
        }[packet]
        return (value % 65_536).to_bytes(2, "big")

    # --- floor ---------------------------------------------------------------------------------

    def stop(self) -> None:
        """Stop the wheels, as a robot's guard process does when the robot's program dies."""
        self._wanted_left = self._wanted_right = 0.0

    def roll(self, seconds: float) -> None:
        """Simulate the motion of the wheels and the base during the next `seconds`."""
        if self.battery <= 0:
            self.stop()
        change = WHEEL_ACCELERATION_M_S2 * seconds
        self._left += _within(self._wanted_left * self.speed_factor - self._left, change)
        self._right += _within(self._wanted_right * self.speed_factor - self._right, change)
        self._left_rolled += self._left * seconds
        self._right_rolled += self._right * seconds
        left, right = (
            speed * seconds * (1 - self.slip * self.rng.random())
            for speed in (self._left, self._right)
        )
        turned, moved = (right - left) / TRACK_M, (left + right) / 2
        middle = self.heading_rad + turned / 2
        self.x_m += moved * math.cos(middle)
        self.y_m += moved * math.sin(middle)
        self.heading_rad += turned


def _within(value: float, limit: float) -> float:
    return max(-limit, min(limit, value))

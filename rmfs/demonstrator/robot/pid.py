"""A PID controller."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass
class Pid:
    """A PID controller, which drives an error towards zero.

    Attributes
    ----------
    proportional, integral, derivative
        Weights of the error, of its integral over time and of its derivative. If the error is in m
        and the output in rad/s, the units of the weights are rad/(m s), rad/(m s^2) and rad/m.
    limit
        Maximum absolute output; while the output would be greater, the integral is not updated.
    """

    proportional: float
    integral: float
    derivative: float
    limit: float
    _sum: float = 0.0
    _last: float | None = None

    def output(self, error: float, seconds: float) -> float:
        """Return the correction for an error; `seconds` is the time since the previous call."""
        change = 0.0 if self._last is None or seconds <= 0 else (error - self._last) / seconds
        self._last = error
        total = self._sum + error * seconds
        wanted = self.proportional * error + self.integral * total + self.derivative * change
        if abs(wanted) <= self.limit:
            self._sum = total
        return max(-self.limit, min(self.limit, wanted))

    def reset(self) -> None:
        """Forget the integral and the last error; called before each straight run."""
        self._sum, self._last = 0.0, None

"""The pace of a live run: as fast as possible, at a given speed, in steps, or paused."""

from __future__ import annotations

from math import ceil

from rmfs.errors import InputError
from rmfs.simulation.agenda import NEVER_US

QUANTUM_S = 0.02
"""Wall time, in s, between two advances of a run with limited speed."""

LAGGING_S = 0.5
"""Lag of a run behind its speed, in s of wall time, beyond which it does not try to catch up."""

FASTEST = 1e6
"""Largest speed, in simulated seconds per wall second; the smallest is its reciprocal."""

LONGEST_STEP_S = 1e9
"""Maximum simulated time of one step, in s (about 30 years)."""


class Pace:
    """Determines up to which simulated time a run may advance.

    Parameters
    ----------
    speed
        Simulated seconds per wall second. Default: as fast as possible.

    Raises
    ------
    InputError
        If the speed is not from 1e-6 to 1e6.
    """

    def __init__(self, speed: float | None = None) -> None:
        _check(speed)
        self._usual = speed
        self._since: tuple[float, int] | None = None
        self._until_us: int | None = None
        self._one_event = False
        self.speed = speed
        self.paused = False

    @property
    def is_free(self) -> bool:
        """Whether the run is neither paused nor limited in speed."""
        return self.speed is None and not self.paused

    def run(self, speed: float | None) -> None:
        """Resume at a speed in simulated seconds per wall second; None: as fast as possible."""
        _check(speed)
        self.speed, self.paused = speed, False
        self._since = self._until_us = None
        self._one_event = False

    def pause(self) -> None:
        """Pause the run."""
        self.paused = True
        self._until_us = None
        self._one_event = False

    def step(self, now_us: int, by_s: float = 0.0) -> None:
        """Let the run advance by a simulated time in s (0: to the next event), and then pause.

        Raises
        ------
        InputError
            If the time is negative or greater than `LONGEST_STEP_S`.
        """
        if not 0 <= by_s <= LONGEST_STEP_S:
            raise InputError(f"step {by_s}: must be 0 to {LONGEST_STEP_S:.0f} seconds")
        self.pause()
        if by_s > 0:
            self._until_us = now_us + round(by_s * 1e6)
        else:
            self._one_event = True

    def let_go(self) -> None:
        """Resume at the initial speed, because no page is left."""
        self.run(self._usual)

    def limit_us(self, now_us: int, wall_s: float) -> int | None:
        """Return the simulated time in us up to which the run may advance; None if it must wait.

        Parameters
        ----------
        wall_s
            Time on a monotonic clock, in s.
        """
        if self._one_event:
            self._one_event = False
            return NEVER_US
        if self._until_us is not None:
            if now_us < self._until_us:
                return self._until_us
            self._until_us = None
        if self.paused:
            return None
        if self.speed is None:
            return NEVER_US
        paid_us = self._paid_us(now_us, wall_s, self.speed)
        return paid_us if paid_us >= now_us + self._quantum_us(self.speed) else None

    def wait_s(self, now_us: int, wall_s: float) -> float | None:
        """Return how long to wait before the next call of `limit_us`, in s of wall time.

        Return None if only a request can change the result of `limit_us`.
        """
        if self.paused or self.speed is None:
            return None
        missing_us = (
            now_us + self._quantum_us(self.speed) - self._paid_us(now_us, wall_s, self.speed)
        )
        return max(missing_us / 1e6 / self.speed, 0.001)

    def _paid_us(self, now_us: int, wall_s: float, speed: float) -> int:
        """Return the simulated time, in us, that the run should have reached at its speed."""
        if self._since is None:
            self._since = (wall_s, now_us)
        since_s, since_us = self._since
        paid_us = since_us + int((wall_s - since_s) * speed * 1e6)
        if paid_us - now_us > (LAGGING_S + QUANTUM_S) * speed * 1e6:
            self._since = (wall_s - QUANTUM_S, now_us)
            return now_us + self._quantum_us(speed)
        return paid_us

    @staticmethod
    def _quantum_us(speed: float) -> int:
        return ceil(QUANTUM_S * speed * 1e6)


def _check(speed: float | None) -> None:
    if speed is not None and not 1 / FASTEST <= speed <= FASTEST:
        raise InputError(
            f"speed {speed:g}: must be {1 / FASTEST:g} to {FASTEST:.0f} simulated seconds per "
            "wall second"
        )

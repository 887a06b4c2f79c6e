"""Sensors of emulated robots: a camera and a tag reader, which observe the emulated floor."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from rmfs.demonstrator.emulator.base import EmulatedBase
    from rmfs.demonstrator.emulator.floor import Floor

REACH_M = 0.02


@dataclass(frozen=True)
class FloorCamera:
    """An emulated camera that a robot carries above the floor."""

    floor: Floor
    base: EmulatedBase
    rng: np.random.Generator

    def frame(self) -> NDArray[np.uint8]:
        """Return the present image."""
        return self.floor.view(self.base.x_m, self.base.y_m, self.base.heading_rad, self.rng)


class FloorTags:
    """An emulated tag reader that a robot carries above the floor.

    Parameters
    ----------
    tags, x_m, y_m
        The N tags and their positions in m, shape (N,).
    base
        The base of the robot that carries the reader.
    missed
        Probability that a tag is missed when the reader passes over it.
    rng
        Random stream that determines which tags are missed.
    """

    def __init__(
        self,
        tags: list[str],
        x_m: NDArray[np.float64],
        y_m: NDArray[np.float64],
        base: EmulatedBase,
        missed: float,
        rng: np.random.Generator,
    ) -> None:
        self._tags, self._x, self._y = tags, x_m, y_m
        self._base, self._missed, self._rng = base, missed, rng
        self._here: tuple[float, float] | None = None
        self._above: int | None = None
        self._found: str | None = None

    def look(self) -> None:
        """Detect a tag that has come into range, or miss it; to be called after each move."""
        here = (self._base.x_m, self._base.y_m)
        if here == self._here:
            return
        self._here = here
        distance = np.hypot(self._x - here[0], self._y - here[1])
        nearest = int(distance.argmin())
        above = nearest if distance[nearest] <= REACH_M else None
        if above is not None and above != self._above and self._rng.random() >= self._missed:
            self._found = self._tags[above]
        self._above = above

    def read(self) -> str | None:
        """Return the tag detected since the previous call; None if there is none."""
        found, self._found = self._found, None
        return found

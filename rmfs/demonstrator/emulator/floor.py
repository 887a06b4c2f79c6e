"""The floor as a camera sees it, with tape along each edge of the graph of waypoints."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import cv2
import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from rmfs.demonstrator.emulator.unkind import Unkindness
    from rmfs.layout.model import Layout

PIXEL_M = 0.0025
TAPE_M = 0.02
MARGIN_M = 0.5
_FLOOR, _TAPE = 170, 35

NEAR_M, DEEP_M, WIDE_M = 0.17, 0.12, 0.24
"""Field of view of a camera, in m: distance from the robot's centre to the near edge of the field,
depth, and width."""
IMAGE = (64, 32)
"""Width and height of an image, in pixels."""


class Floor:
    """A picture of the floor, from which the images of the robots' cameras are taken.

    Parameters
    ----------
    layout
        The layout; tape lies along each edge between two waypoints.
    unkindness
        Imperfections of the room; only `glare`, `noise` and `gap_m` are used.
    rng
        Random stream for the noise patterns, one of which is added to each image.
    """

    def __init__(self, layout: Layout, unkindness: Unkindness, rng: np.random.Generator) -> None:
        self._unkindness = unkindness
        self._origin = (float(layout.x_m.min()) - MARGIN_M, float(layout.y_m.max()) + MARGIN_M)
        wide = float(np.ptp(layout.x_m)) + 2 * MARGIN_M
        high = float(np.ptp(layout.y_m)) + 2 * MARGIN_M
        self._picture = np.full((round(high / PIXEL_M), round(wide / PIXEL_M)), _FLOOR, np.uint8)
        self._lay_tape(layout)
        noise = rng.normal(0.0, unkindness.noise, (8, IMAGE[1], IMAGE[0]))
        self._noise = noise.astype(np.int16)

    def view(
        self, x_m: float, y_m: float, heading_rad: float, rng: np.random.Generator
    ) -> NDArray[np.uint8]:
        """Return an image of the floor ahead of the robot, shape (height, width, 3).

        The lower edge of the image is the one nearest to the robot.

        Parameters
        ----------
        x_m, y_m, heading_rad
            Position and heading of the robot; heading 0 points along x, positive angles
            turn anticlockwise.
        rng
            Random stream for glare and for the choice of the noise pattern.
        """
        # one pixel to the right, and one down, in the picture; its rows run against y
        right = WIDE_M / IMAGE[0] / PIXEL_M
        down = DEEP_M / IMAGE[1] / PIXEL_M
        cos, sin = math.cos(heading_rad), math.sin(heading_rad)
        far = NEAR_M + DEEP_M
        left, top = self._origin
        corner_x = (x_m + far * cos - WIDE_M / 2 * sin - left) / PIXEL_M
        corner_y = (top - y_m - far * sin - WIDE_M / 2 * cos) / PIXEL_M
        to_picture = np.array(
            [[right * sin, -down * cos, corner_x], [right * cos, down * sin, corner_y]]
        )
        flags = cv2.INTER_NEAREST | cv2.WARP_INVERSE_MAP
        grey: Any = cv2.warpAffine(
            self._picture, to_picture, IMAGE, flags=flags, borderMode=cv2.BORDER_REPLICATE
        )
        return np.asarray(cv2.cvtColor(self._spoilt(grey, rng), cv2.COLOR_GRAY2BGR), np.uint8)

    def _spoilt(self, grey: NDArray[np.uint8], rng: np.random.Generator) -> NDArray[np.uint8]:
        if self._unkindness.noise > 0:
            noise = self._noise[rng.integers(len(self._noise))]
            grey = np.asarray(cv2.add(grey, noise, dtype=cv2.CV_8U), np.uint8)
        if rng.random() < self._unkindness.glare:
            at = (int(rng.integers(IMAGE[0])), int(rng.integers(IMAGE[1])))
            cv2.circle(grey, at, int(rng.integers(3, 9)), 250, -1)
        return grey

    def _lay_tape(self, layout: Layout) -> None:
        thick = max(1, round(TAPE_M / PIXEL_M))
        ends = set()
        for v in range(len(layout.x_m)):
            for w in layout.edge_target[layout.edge_start[v] : layout.edge_start[v + 1]]:
                ends.add((min(v, int(w)), max(v, int(w))))
        gap = self._unkindness.gap_m
        for number, (v, w) in enumerate(sorted(ends)):
            a = np.array([layout.x_m[v], layout.y_m[v]])
            b = np.array([layout.x_m[w], layout.y_m[w]])
            self._stroke(a, b, _TAPE, thick)
            if gap > 0 and number % 3 == 0:
                middle, along = (a + b) / 2, (b - a) / np.linalg.norm(b - a)
                self._stroke(middle - gap / 2 * along, middle + gap / 2 * along, _FLOOR, thick + 4)

    def _stroke(
        self, a: NDArray[np.float64], b: NDArray[np.float64], grey: int, thick: int
    ) -> None:
        first, last = (tuple(round(c) for c in self._pixel(end)) for end in (a, b))
        cv2.line(self._picture, first, last, grey, thick)

    def _pixel(self, point: NDArray[np.float64]) -> NDArray[np.float64]:
        left, top = self._origin
        return np.array([(point[0] - left) / PIXEL_M, (top - point[1]) / PIXEL_M])

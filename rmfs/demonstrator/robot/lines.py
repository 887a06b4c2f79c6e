"""The line on the floor, found in a camera image (paper, section 4).

Colours in a range are kept, specks are eroded away, the largest contour is taken for the line, and
the middle of its lower end says where it is.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Protocol

import cv2
import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray


class Camera(Protocol):
    """Looks at the floor in front of the robot."""

    def frame(self) -> NDArray[np.uint8]:
        """Return an image, shape (height, width, 3), blue, green, red; the robot is below it."""


class VideoCamera:
    """A camera that OpenCV opens by its number.

    Raises
    ------
    OSError
        If there is none, or it gives no image.
    """

    def __init__(self, number: int) -> None:
        self._video = cv2.VideoCapture(number)
        self._video.set(cv2.CAP_PROP_BUFFERSIZE, 1)  # the image of now, not of a second ago
        if not self._video.isOpened():
            raise OSError(f"no camera {number}")

    def frame(self) -> NDArray[np.uint8]:
        """Return an image."""
        good, image = self._video.read()
        if not good:
            raise OSError("the camera gives no image")
        return np.asarray(image, np.uint8)


@dataclass(frozen=True)
class LineSettings:
    """What a line looks like.

    Attributes
    ----------
    lowest, highest
        Range of hue (0-179), saturation and value (0-255) of the tape.
    erode_px
        Side of the square that has to fit into what is kept.
    smallest_share
        Of the image, for a contour to count.
    widest_share
        Of the image's width; a lower end wider than this is a crossing line.
    lower_share
        The line has to reach into this part of the image, from below.
    """

    lowest: tuple[int, int, int] = (0, 0, 0)
    highest: tuple[int, int, int] = (179, 255, 90)
    erode_px: int = 3
    smallest_share: float = 0.01
    widest_share: float = 0.35
    lower_share: float = 0.5


def line_offset(image: NDArray[np.uint8], settings: LineSettings) -> float | None:
    """Return where the line is: from -1 (right edge) to 1 (left edge); None where none is seen.

    Parameters
    ----------
    image
        Shape (height, width, 3), blue, green, red.
    settings
        What a line looks like.
    """
    height, width = image.shape[:2]
    hsv = cv2.cvtColor(image, cv2.COLOR_BGR2HSV)
    mask: Any = cv2.inRange(hsv, np.array(settings.lowest), np.array(settings.highest))
    mask = cv2.erode(mask, np.ones((settings.erode_px, settings.erode_px), np.uint8))
    contours, _ = cv2.findContours(mask, cv2.RETR_EXTERNAL, cv2.CHAIN_APPROX_NONE)
    if not contours:
        return None
    largest = max(contours, key=cv2.contourArea)
    if cv2.contourArea(largest) < settings.smallest_share * height * width:
        return None
    points = largest[:, 0, :]
    lowest = int(points[:, 1].max())
    if lowest < (1 - settings.lower_share) * height:
        return None
    end = points[points[:, 1] >= lowest - 2, 0]
    left, right = int(end.min()), int(end.max())
    if right - left > settings.widest_share * width:
        return None
    return float(1.0 - (left + right + 1) / width)


@dataclass(frozen=True)
class CameraLine:
    """The line sensor of a robot with a camera.

    Attributes
    ----------
    camera
        Where images come from.
    half_width_m
        Half of what the lower edge of an image shows of the floor.
    settings
        What a line looks like.
    """

    camera: Camera
    half_width_m: float = 0.12
    settings: LineSettings = LineSettings()

    def offset_m(self) -> float | None:
        """Return how far left of the middle the line is; None where none is seen."""
        offset = line_offset(self.camera.frame(), self.settings)
        return None if offset is None else offset * self.half_width_m

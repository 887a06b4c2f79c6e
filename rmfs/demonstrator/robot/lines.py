"""Detection of the line on the floor in a camera image, as in RAWSim-O.

Pixels within a colour range are kept, small specks are removed by erosion, and the largest contour
is taken as the line. The position of the line is the middle of the lower end of this contour.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Protocol

import cv2
import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray


class Camera(Protocol):
    """A camera that sees the floor in front of the robot."""

    def frame(self) -> NDArray[np.uint8]:
        """Return an image, shape (height, width, 3), with the channels blue, green and red.

        The lower edge of the image is the one closest to the robot.
        """


class VideoCamera:
    """A camera, identified by its number in OpenCV.

    Raises
    ------
    OSError
        If there is no such camera.
    """

    def __init__(self, number: int) -> None:
        self._video = cv2.VideoCapture(number)
        self._video.set(cv2.CAP_PROP_BUFFERSIZE, 1)  # the image of now, not of a second ago
        if not self._video.isOpened():
            raise OSError(f"no camera {number}")

    def frame(self) -> NDArray[np.uint8]:
        """Return an image (see `Camera`).

        Raises
        ------
        OSError
            If the camera returns no image.
        """
        good, image = self._video.read()
        if not good:
            raise OSError("the camera gives no image")
        return np.asarray(image, np.uint8)


@dataclass(frozen=True)
class LineSettings:
    """Settings of the detection of a line.

    Attributes
    ----------
    lowest, highest
        Lowest and highest hue (0-179), saturation and value (each 0-255) of the tape.
    erode_px
        Side of the square used for erosion, in pixels.
    smallest_share
        Minimum area of the line, as a share of the area of the image.
    widest_share
        Maximum width of the line's lower end, as a share of the image's width. A wider contour is
        probably a line that crosses the robot's line; no line is detected then.
    lower_share
        Height of the lower part of the image into which the line must reach, as a share of the
        image's height.
    """

    lowest: tuple[int, int, int] = (0, 0, 0)
    highest: tuple[int, int, int] = (179, 255, 90)
    erode_px: int = 3
    smallest_share: float = 0.01
    widest_share: float = 0.35
    lower_share: float = 0.5


def line_offset(image: NDArray[np.uint8], settings: LineSettings) -> float | None:
    """Return the position of the line, from -1 (right edge) to 1 (left edge); None without a line.

    Parameters
    ----------
    image
        The image, shape (height, width, 3), with the channels blue, green and red.
    settings
        Settings of the detection.
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
        The camera.
    half_width_m
        Half the width, in m, of the floor that the lower edge of an image shows.
    settings
        Settings of the detection of the line.
    """

    camera: Camera
    half_width_m: float = 0.12
    settings: LineSettings = LineSettings()

    def offset_m(self) -> float | None:
        """Return how far, in m, the line is to the left of the image's centre; None without a line.

        The distance is negative if the line is to the right of the centre.
        """
        offset = line_offset(self.camera.frame(), self.settings)
        return None if offset is None else offset * self.half_width_m

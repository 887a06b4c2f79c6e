"""Imperfections of an emulated room."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Unkindness:
    """What goes wrong, and how often.

    Attributes
    ----------
    speed_error
        Each robot's wheels are up to this share too slow or too fast, for good.
    slip
        Up to this share of a wheel's way is lost, anew at each step.
    missed_tags
        Share of passages in which the reader does not find the tag.
    lost_messages
        Share of frames that never arrive, each way.
    delay_us
        Frames arrive up to this much later.
    glare, noise
        Share of images with a bright spot; grey values of noise (standard deviation).
    gap_m
        Length of a gap in the tape in the middle of every third edge.
    """

    speed_error: float = 0.05
    slip: float = 0.01
    missed_tags: float = 0.02
    lost_messages: float = 0.01
    delay_us: int = 40_000
    glare: float = 0.02
    noise: float = 8.0
    gap_m: float = 0.03


KIND = Unkindness(0.0, 0.0, 0.0, 0.0, 0, 0.0, 0.0, 0.0)
"""A room in which nothing goes wrong."""

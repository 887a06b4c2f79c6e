"""Imperfections of an emulated room."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Unkindness:
    """Imperfections of an emulated room: how often they occur, and how large they are.

    Attributes
    ----------
    speed_error
        Maximum relative error of the speed of a robot's wheels; the error is constant over time.
    slip
        Maximum share of a wheel's travel that is lost to slip; the share is drawn at each step.
    missed_tags
        Probability that a tag is missed when the reader passes over it.
    lost_messages
        Share of messages that are lost, in each direction.
    delay_us
        Maximum delay of a message in microseconds.
    glare, noise
        Share of camera images with a bright spot, and standard deviation of the noise that is added
        to the grey values (0 to 255) of an image.
    gap_m
        Length, in m, of the gap in the tape at the middle of every third edge.
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
"""A room without imperfections."""

"""Repositioning none: stored pods are never moved."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rmfs.control.base import Controller, NoParameters
from rmfs.control.repositioning import Move, Repositioning

if TYPE_CHECKING:
    from rmfs.world.robots import Robot


class NoMoves(Repositioning[NoParameters]):
    """Never moves a pod."""

    never = True
    next_event_s = Controller.next_event_s  # there is no pause that could end

    def move(self, robot: Robot) -> Move | None:
        """Return None: no move."""
        return None

    def is_ready(self, robot: Robot) -> bool:
        """Return False, since the rule never moves a pod."""
        return False

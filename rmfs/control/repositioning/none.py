"""Repositioning none: pods stay where they were stored."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rmfs.control.base import NoParameters
from rmfs.control.repositioning import Move, Repositioning

if TYPE_CHECKING:
    from rmfs.world.robots import Robot


class NoMoves(Repositioning[NoParameters]):
    """Moves no pod."""

    never = True

    def move(self, robot: Robot) -> Move | None:
        """Find nothing."""
        return None

    def is_ready(self, robot: Robot) -> bool:
        """Never."""
        return False

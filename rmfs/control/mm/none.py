"""MM none: the controllers stay as they are."""

from __future__ import annotations

from rmfs.control.base import NoParameters
from rmfs.control.mm import MethodManagement


class NoExchange(MethodManagement[NoParameters]):
    """Never exchanges a controller."""

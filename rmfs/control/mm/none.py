"""MM none: the controllers stay as they are."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rmfs.control.base import NoParameters
from rmfs.control.mm import MethodManagement

if TYPE_CHECKING:
    from collections.abc import Iterator

    from rmfs.control.decisions import Exchange
    from rmfs.control.problems import Trigger

_NEVER: frozenset[Trigger] = frozenset()


class NoExchange(MethodManagement[NoParameters]):
    """Never exchanges a controller."""

    triggers = _NEVER

    def decide(self) -> Iterator[Exchange]:
        """Yield nothing."""
        yield from ()

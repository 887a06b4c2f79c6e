"""The traffic layer of a demonstration, which has the interface of `Traffic` but real robots."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NoReturn

from rmfs.demonstrator.server.clock import ROOM
from rmfs.demonstrator.server.guide import TICK_US, Guide
from rmfs.errors import InternalError
from rmfs.traffic import Traffic

if TYPE_CHECKING:
    from collections.abc import Sequence

    from rmfs.demonstrator.robot.protocol import Message
    from rmfs.demonstrator.server.clock import Clock
    from rmfs.demonstrator.server.hub import Hub
    from rmfs.demonstrator.server.journal import Journal
    from rmfs.layout.model import Layout


class GuidedTraffic(Traffic):
    """The traffic layer of a demonstration; simulated time follows the demonstration's clock.

    Parameters
    ----------
    layout
        The layout of the warehouse.
    robots
        Index in the layout of each real or emulated robot, by the robot's name.
    tags
        The tag of every waypoint.
    hub
        The sessions with these robots.
    clock
        Clock of the demonstration.
    journal
        Journal of received messages.
    options
        Further parameters of `Traffic`.
    """

    def __init__(
        self,
        layout: Layout,
        robots: dict[str, int],
        tags: Sequence[str],
        hub: Hub,
        clock: Clock,
        journal: Journal,
        **options: Any,
    ) -> None:
        super().__init__(layout, **options)
        self.guide = Guide(layout, self, list(robots.values()), tags)
        self._index, self._name = robots, {index: name for name, index in robots.items()}
        self._hub, self._clock, self._journal = hub, clock, journal
        self._tick_us = 0
        self._is_live = self._failed = False
        self._advance_core = self.advance
        self.advance = self._advance_guided

    def fork(self, memo: dict[int, Any] | None = None) -> NoReturn:
        """Refuse to copy the traffic layer, since real robots cannot be copied.

        Raises
        ------
        TypeError
            Always.
        """
        raise TypeError("traffic with real robots cannot be copied")

    def _advance_guided(self, until_us: int, ignored: int = 0) -> list[tuple[int, int, int, int]]:
        """Advance to the next event like `Traffic.advance`, synchronised with the real robots."""
        while True:
            limit_us = min(until_us, self._tick_us)
            events = self._advance_core(limit_us, ignored)
            if events or limit_us < self._tick_us:
                return events
            self._tick()
            self._tick_us += TICK_US
            if limit_us == until_us:
                return []

    def _tick(self) -> None:
        now_us = self._tick_us
        if now_us <= self._journal.begins_us:
            self._guide(now_us, *self._journal.heard_at(now_us))
            return
        heard = self._clock.wait(self._hub, now_us)
        messages = [(self._index[name], message) for name, message in heard if name in self._index]
        if not self._is_live:
            # whoever was there before this server was started has to come again
            self._is_live = True
            messages = [(robot, {"type": "gone"}) for robot in self._name] + messages
        quiet = self._hub.silent(now_us)
        silent = frozenset(self._index[name] for name in quiet if name in self._index)
        if messages or silent:
            self._journal.note(now_us, messages, silent)
        told = self._guide(now_us, messages, silent)
        if told and not (messages or silent):
            # orders sent to robots must survive a restart
            self._journal.note(now_us, [], frozenset())
        for robot, message in told:
            self._hub.send(self._name[robot], message)
        self._hub.flush(now_us)
        self._clock.passed(self._hub, now_us)

    def _guide(
        self, now_us: int, messages: list[tuple[int, Message]], silent: frozenset[int]
    ) -> list[tuple[int, Message]]:
        """Return the messages to be sent in a tick; mark a failure in the journal, and raise it."""
        is_left_out = now_us in self._journal.left_out
        if is_left_out:
            self.guide.forget_strayed()
        try:
            return self.guide.tick(messages, silent, regroups=not is_left_out)
        except Exception as error:
            self._failed = True
            self._journal.note_failure(now_us, repr(error))
            raise InternalError(
                f"{error!r}, at {now_us / 1e6:.2f} s of the demonstration; to resume without the "
                "messages received then, repeat the command with --past-failure"
            ) from error

    def end(self) -> None:
        """End the demonstration: notify the emulated room, if there is one, and close all sessions.

        After a failure of the server, the room is not notified; like the robots, it then waits
        until the server has been restarted.
        """
        if not self._failed:
            self._hub.send(ROOM, {"type": "end"})
            self._hub.flush(self._tick_us)
        self._hub.close()
        self._journal.close()

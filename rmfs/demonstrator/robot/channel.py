"""A session in which every message arrives exactly once and in order, despite losses.

Each side numbers its messages and acknowledges the last number received from the other. A message
that is not acknowledged in time is sent again, with all later ones. This module uses neither a
clock nor a socket; the caller provides the time and the received bytes.

    message := {"n": number or absent, "ack": number, "clock": microseconds, "type": name, ...}

A message without a number only acknowledges received messages and shows that the sender is alive.
"""

from __future__ import annotations

from collections import deque

from .protocol import Message, ProtocolError, Unpacker, pack, whole

RESEND_US = 300_000
"""Time, in microseconds, after which an unacknowledged message is sent again."""
HEARTBEAT_US = 500_000
"""Interval, in microseconds, at which each side shows that it is alive."""
SILENCE_US = 3_000_000
"""Time, in microseconds, without a message after which the other side counts as silent."""
MOST_WAITING = 10_000
"""Maximum number of unacknowledged messages; a greater number indicates a defective other side."""


class Channel:
    """One side of a session.

    Parameters
    ----------
    key, own, other
        Key of the session, label (see `protocol`) of the frames that this side sends, and label of
        the frames that it receives.
    now_us
        Present time in microseconds.
    rest
        Bytes of the session that arrived before the channel was created.
    """

    def __init__(
        self, key: bytes, own: bytes, other: bytes, now_us: int, rest: bytes = b""
    ) -> None:
        self._key, self._own, self._other = key, own, other
        self._unpacker = Unpacker(rest)
        self._waiting: deque[Message] = deque()
        self._number = self._sent_upto = self._seen = self._acknowledged = self.refused = 0
        self._sent_us = self.heard_us = self.clock_us = now_us

    def send(self, message: Message) -> None:
        """Queue a message; raise ProtocolError if `MOST_WAITING` messages are unacknowledged."""
        if len(self._waiting) >= MOST_WAITING:
            raise ProtocolError(f"{MOST_WAITING} messages are not acknowledged")
        self._number += 1
        self._waiting.append({"n": self._number, **message})

    def receive(self, data: bytes, now_us: int) -> list[Message]:
        """Process the bytes that have arrived, and return the new messages, in order.

        Raises
        ------
        ProtocolError
            If the other side violates the protocol.
        """
        new = []
        for message in self._unpacker.feed(data, self._key, self._other):
            self.heard_us = now_us
            self.clock_us = max(self.clock_us, whole(message, "clock"))
            acknowledged = whole(message, "ack")
            while self._waiting and self._waiting[0]["n"] <= acknowledged:
                self._waiting.popleft()
            if "n" not in message:
                continue
            if whole(message, "n") == self._seen + 1:
                self._seen += 1
                new.append(message)
            else:
                # sent again, played again by somebody, or after one that was lost
                self.refused += 1
        return new

    def outgoing(self, now_us: int) -> list[bytes]:
        """Return the frames to be sent now."""
        late = self._waiting and now_us - self._sent_us >= RESEND_US
        upto = 0 if late else self._sent_upto
        due = [message for message in self._waiting if message["n"] > upto]
        quiet = now_us - self._sent_us >= HEARTBEAT_US or self._acknowledged != self._seen
        if not due and quiet:
            due = [{"type": "alive"}]
        if due:
            self._sent_us = now_us
            self._sent_upto = self._number
            self._acknowledged = self._seen
        stamp = {"ack": self._seen, "clock": now_us}
        return [pack({**message, **stamp}, self._key, self._own) for message in due]

    def is_silent(self, now_us: int) -> bool:
        """Return whether the other side has been silent for longer than `SILENCE_US`."""
        return now_us - self.heard_us > SILENCE_US

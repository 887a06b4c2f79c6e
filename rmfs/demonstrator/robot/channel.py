"""A session in which every message arrives once and in order, whatever is lost on the way.

Both sides number their messages and say which number they have seen last. What is not acknowledged
within a time is sent again, it and all after it. Nothing here reads a clock or a socket: time and
bytes come from outside.

    message := {"n": number or absent, "ack": number, "clock": microseconds, "type": name, ...}

A message without number only acknowledges and shows that the sender lives.
"""

from __future__ import annotations

from collections import deque

from .protocol import Message, ProtocolError, Unpacker, pack, whole

RESEND_US = 300_000
"""After so long without acknowledgement a message is sent again."""
HEARTBEAT_US = 500_000
"""So often a side shows that it lives."""
SILENCE_US = 3_000_000
"""After so long without a sign the other side counts as silent."""
MOST_WAITING = 10_000
"""Messages that may wait for acknowledgement; more is a defect of the other side."""


class Channel:
    """One side of a session.

    Parameters
    ----------
    key, own, other
        Key of the session, and labels of what this side writes and of what it reads.
    now_us
        Present time.
    rest
        Bytes that have arrived already.
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
        """Take a message for the other side."""
        if len(self._waiting) >= MOST_WAITING:
            raise ProtocolError(f"{MOST_WAITING} messages without acknowledgement")
        self._number += 1
        self._waiting.append({"n": self._number, **message})

    def receive(self, data: bytes, now_us: int) -> list[Message]:
        """Return new messages, in order.

        Raises
        ------
        ProtocolError
            If the other side does not keep the protocol.
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
        """Say whether the other side has given no sign for too long."""
        return now_us - self.heard_us > SILENCE_US

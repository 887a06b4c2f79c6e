"""The protocol in any order of events: hypothesis plays the network, and a stranger on it."""

from __future__ import annotations

import secrets

import hypothesis.strategies as st
from hypothesis import given, settings
from hypothesis.stateful import RuleBasedStateMachine, invariant, precondition, rule

from rmfs.demonstrator.robot.channel import RESEND_US, Channel
from rmfs.demonstrator.robot.protocol import ROBOT, SERVER, ProtocolError, pack
from rmfs.demonstrator.server.greeting import Greeting

KEY = b"k" * 32
SIDES = st.sampled_from([0, 1])


class Session(RuleBasedStateMachine):
    """Two channels, and between them a network that loses, repeats and delays frames."""

    def __init__(self) -> None:
        super().__init__()
        self.now_us = 0
        self.ends = (Channel(KEY, SERVER, ROBOT, 0), Channel(KEY, ROBOT, SERVER, 0))
        self.sent: tuple[list[int], list[int]] = ([], [])
        self.came: tuple[list[int], list[int]] = ([], [])
        self.flying: tuple[list[bytes], list[bytes]] = ([], [])
        self.seen: list[bytes] = []

    @rule(side=SIDES, value=st.integers())
    def send(self, side: int, value: int) -> None:
        self.ends[side].send({"type": "x", "value": value})
        self.sent[side].append(value)

    @rule(side=SIDES, us=st.integers(0, 2 * RESEND_US))
    def time_passes(self, side: int, us: int) -> None:
        self.now_us += us
        self.flying[side].extend(self.ends[side].outgoing(self.now_us))

    @rule(side=SIDES, cut=st.integers(1, 40))
    @precondition(lambda self: any(self.flying))
    def deliver(self, side: int, cut: int) -> None:
        """What one side has sent comes, in pieces."""
        data = b"".join(self.flying[side])
        self.seen += self.flying[side]
        self.flying[side].clear()
        for start in range(0, len(data), cut):
            self._receive(1 - side, data[start : start + cut])

    @rule(side=SIDES, which=st.integers(0, 20))
    def lose(self, side: int, which: int) -> None:
        if self.flying[side]:
            del self.flying[side][which % len(self.flying[side])]

    @rule(side=SIDES, which=st.integers(0, 20))
    def repeat(self, side: int, which: int) -> None:
        """A stranger plays a frame of this side again."""
        if self.flying[side]:
            self.flying[side].append(self.flying[side][which % len(self.flying[side])])

    @rule(side=SIDES, data=st.binary(min_size=4, max_size=200))
    def a_stranger_writes(self, side: int, data: bytes) -> None:
        """It ends a session, and nothing of it is ever taken for a message."""
        stranger = Channel(KEY, *((SERVER, ROBOT) if side == 0 else (ROBOT, SERVER)), 0)
        try:
            taken = stranger.receive(data, 0)
        except ProtocolError:
            return
        assert taken == []

    @rule(side=SIDES, which=st.integers(0, 20), at=st.integers(4, 300), bit=st.integers(0, 7))
    @precondition(lambda self: self.seen)
    def a_bit_changes(self, side: int, which: int, at: int, bit: int) -> None:
        frame = bytearray(self.seen[which % len(self.seen)])
        frame[4 + at % (len(frame) - 4)] ^= 1 << bit
        copy = Channel(KEY, *((SERVER, ROBOT) if side == 0 else (ROBOT, SERVER)), 0)
        try:
            assert copy.receive(bytes(frame), 0) == []
        except ProtocolError:
            return
        raise AssertionError("a changed frame was taken")

    def _receive(self, side: int, data: bytes) -> None:
        self.came[side].extend(m["value"] for m in self.ends[side].receive(data, self.now_us))

    @invariant()
    def what_came_is_what_was_sent_so_far(self) -> None:
        for side in (0, 1):
            sent = self.sent[1 - side]
            assert self.came[side] == sent[: len(self.came[side])]

    def teardown(self) -> None:
        """Without losses, all comes in the end."""
        for _ in range(4):
            self.now_us += RESEND_US
            for side in (0, 1):
                frames = [*self.flying[side], *self.ends[side].outgoing(self.now_us)]
                self.flying[side].clear()
                self._receive(1 - side, b"".join(frames))
        assert self.came == (self.sent[1], self.sent[0])


TestSession = Session.TestCase
TestSession.settings = settings(max_examples=60, stateful_step_count=30, deadline=None)


@settings(max_examples=300, deadline=None)
@given(data=st.lists(st.binary(max_size=80), max_size=8))
def test_whatever_a_stranger_says_to_the_server(data: list[bytes]) -> None:
    greeting = Greeting(secrets.token_bytes(16))
    greeting.welcome()
    for piece in data:
        try:
            assert greeting.receive(piece) is None
        except ProtocolError:
            return


JSON = st.recursive(
    st.none()
    | st.booleans()
    | st.integers()
    | st.floats(allow_nan=False, allow_infinity=False)
    | st.text(max_size=80),
    lambda below: st.lists(below, max_size=3) | st.dictionaries(st.text(max_size=9), below),
    max_leaves=9,
)
FIELDS = st.sampled_from(["n", "ack", "clock", "type", "robot", "nonce", "version", "x"])


@settings(max_examples=300, deadline=None)
@given(messages=st.lists(st.dictionaries(FIELDS, JSON, max_size=6), max_size=6))
def test_whatever_a_robot_with_the_secret_says(messages: list[dict]) -> None:
    """A defect of a robot ends its session, and not the server."""
    server = Channel(KEY, SERVER, ROBOT, 0)
    try:
        for message in messages:
            server.receive(pack(message, KEY, ROBOT), 0)
    except ProtocolError:
        return
    assert all(isinstance(message.get("ack"), int) for message in messages)

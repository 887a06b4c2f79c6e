"""Frames and channels, without sockets."""

import ast
import hashlib
import hmac
import json
import sys
from pathlib import Path

import pytest

from rmfs.demonstrator.robot import channel as channels
from rmfs.demonstrator.robot.channel import HEARTBEAT_US, RESEND_US, SILENCE_US, Channel
from rmfs.demonstrator.robot.protocol import (
    LARGEST,
    ROBOT,
    SERVER,
    ProtocolError,
    Unpacker,
    pack,
    session_key,
)

KEY = b"k" * 32
ROBOT_SIDE = Path(channels.__file__).parent
LIBRARY = ("protocol.py", "channel.py", "client.py")


def test_a_frame_byte_by_byte():
    """Length, HMAC-SHA256 over label and text, text; computed here from the document alone."""
    text = b'{"n":1,"type":"tag"}'
    proof = hmac.new(KEY, b"\x00\x05robot" + text, hashlib.sha256).digest()
    assert pack({"n": 1, "type": "tag"}, KEY, ROBOT) == b"\x00\x00\x00\x14" + proof + text


def test_frames_may_arrive_in_any_pieces():
    frames = pack({"a": 1}, KEY, ROBOT) + pack({"b": "ü"}, KEY, ROBOT)
    for cut in range(len(frames)):
        unpacker = Unpacker()
        first = list(unpacker.feed(frames[:cut], KEY, ROBOT))
        assert first + list(unpacker.feed(frames[cut:], KEY, ROBOT)) == [{"a": 1}, {"b": "ü"}]


def framed(text):
    proof = hmac.new(KEY, b"\x00\x05robot" + text, hashlib.sha256).digest()
    return len(text).to_bytes(4, "big") + proof + text


@pytest.mark.parametrize(
    ("data", "why"),
    [
        (pack({"a": 1}, b"another key", ROBOT), "wrong authentication code"),
        (pack({"a": 1}, KEY, SERVER), "wrong authentication code"),
        ((LARGEST + 1).to_bytes(4, "big"), "a frame has 65537 bytes"),
        (b"GET / HTTP/1.1\r\n\r\n", "a frame has"),
        (framed(b"{]"), "not JSON"),
        (framed(b"\xff"), "not JSON"),
        (framed(b"[" * 60_000), "not JSON"),
        (framed(b"[1]"), "not a JSON object"),
    ],
)
def test_what_is_no_frame_is_refused(data, why):
    with pytest.raises(ProtocolError, match=why):
        list(Unpacker().feed(data, KEY, ROBOT))


def test_a_changed_bit_anywhere_is_noticed():
    frame = pack({"type": "tag", "tag": "W7"}, KEY, ROBOT)
    for place in range(4, len(frame)):
        spoilt = bytearray(frame)
        spoilt[place] ^= 1
        with pytest.raises(ProtocolError):
            list(Unpacker().feed(bytes(spoilt), KEY, ROBOT))


def test_too_long_a_message_is_not_sent():
    with pytest.raises(ValueError, match="at most 65536"):
        pack({"a": "x" * LARGEST}, KEY, ROBOT)


def test_session_keys_differ_by_secret_and_by_each_nonce():
    keys = {
        session_key(*given)
        for given in [(b"s", "1", "2"), (b"t", "1", "2"), (b"s", "3", "2"), (b"s", "1", "3")]
    }
    assert len(keys) == 4


# --- channels ------------------------------------------------------------------------------------


@pytest.fixture
def pair():
    return Channel(KEY, SERVER, ROBOT, 0), Channel(KEY, ROBOT, SERVER, 0)


def types(messages):
    return [message["type"] for message in messages]


def pass_on(one, other, now_us, lost=()):
    frames = one.outgoing(now_us)
    return other.receive(b"".join(f for i, f in enumerate(frames) if i not in lost), now_us)


def test_messages_arrive_once_and_in_order_whatever_is_lost(pair):
    server, robot = pair
    for name in "abcd":
        server.send({"type": name})
    assert types(pass_on(server, robot, 0, lost=[1])) == ["a"]  # c and d come too early
    assert robot.refused == 2
    assert pass_on(robot, server, 10) == []
    assert pass_on(server, robot, RESEND_US - 1) == []
    assert types(pass_on(server, robot, RESEND_US)) == ["b", "c", "d"]
    pass_on(robot, server, RESEND_US)
    assert server.outgoing(2 * RESEND_US) == []


def test_the_same_frame_again_is_refused(pair):
    server, robot = pair
    server.send({"type": "go"})
    (frame,) = server.outgoing(0)
    assert types(robot.receive(frame, 0)) == ["go"]
    assert robot.receive(frame * 3, 1) == []
    assert robot.refused == 3


def test_a_frame_sent_back_to_its_sender_is_refused(pair):
    server, _ = pair
    server.send({"type": "go"})
    with pytest.raises(ProtocolError):
        server.receive(server.outgoing(0)[0], 0)


def test_heartbeat_and_silence(pair):
    server, robot = pair
    assert robot.outgoing(HEARTBEAT_US - 1) == []
    (alive,) = robot.outgoing(HEARTBEAT_US)
    assert json.loads(alive[36:]) == {"type": "alive", "ack": 0, "clock": HEARTBEAT_US}
    assert server.receive(alive, HEARTBEAT_US) == []
    assert not server.is_silent(HEARTBEAT_US + SILENCE_US)
    assert server.is_silent(HEARTBEAT_US + SILENCE_US + 1)


def test_the_clock_of_the_other_side_is_known(pair):
    server, robot = pair
    server.send({"type": "go"})
    pass_on(server, robot, 1234)
    assert robot.clock_us == 1234


@pytest.mark.parametrize("field", [{"ack": -1}, {"ack": True}, {"n": "1"}, {"clock": 1.5}])
def test_wrong_numbers_are_refused(pair, field):
    _, robot = pair
    frame = pack({"n": 1, "ack": 0, "clock": 0, "type": "go", **field}, KEY, SERVER)
    with pytest.raises(ProtocolError, match=next(iter(field))):
        robot.receive(frame, 0)


def test_a_side_that_never_acknowledges_is_given_up(pair, monkeypatch):
    monkeypatch.setattr(channels, "MOST_WAITING", 3)
    for _ in range(3):
        pair[0].send({"type": "go"})
    with pytest.raises(ProtocolError, match="3 messages"):
        pair[0].send({"type": "go"})


# --- the library ---------------------------------------------------------------------------------


def test_the_client_library_has_less_than_400_lines():
    lines = sum(len((ROBOT_SIDE / name).read_text().splitlines()) for name in LIBRARY)
    assert 300 < lines < 400


def test_what_a_small_computer_runs_needs_the_standard_library_only():
    """But for the camera and the serial port themselves; and the client needs itself alone."""
    for file in ROBOT_SIDE.glob("*.py"):
        for module, level in imports(file):
            if level:
                allowed = {name.removesuffix(".py") for name in LIBRARY} | {""}
                assert file.name not in LIBRARY or module in allowed, file
            elif file.name not in ("lines.py", "__main__.py"):
                assert module.split(".")[0] in sys.stdlib_module_names, file


def imports(file):
    for node in ast.walk(ast.parse(file.read_text())):
        if isinstance(node, ast.Import):
            yield from ((alias.name, 0) for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            yield node.module or "", node.level

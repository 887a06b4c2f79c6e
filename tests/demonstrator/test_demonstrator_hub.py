"""Sessions over TCP: who belongs there stays, everybody else is refused and written down."""

import logging
import socket
import time

import pytest

from rmfs.demonstrator.robot.client import Link, TcpWire
from rmfs.demonstrator.robot.protocol import HELLO, LARGEST, ROBOT, ProtocolError, pack
from rmfs.demonstrator.server import hub as hubs
from rmfs.demonstrator.server.hub import Hub

PATIENCE_S = 20.0

SECRET = b"known to both"


class Tap(TcpWire):
    """A connection whose bytes somebody keeps."""

    def __init__(self, *address):
        super().__init__(*address)
        self.kept = []

    def write(self, frame):
        self.kept.append(frame)
        super().write(frame)


@pytest.fixture
def hub():
    hub = Hub("127.0.0.1", 0, SECRET, ["robot-0", "robot-1"])
    yield hub
    hub.close()


def link_to(hub, name="robot-0", secret=SECRET, taps=None):
    def connect():
        wire = Tap(*hub.address)
        if taps is not None:
            taps.append(wire)
        return wire

    return Link(connect, secret, name)


def heard(hub, links, until, now_us=0):
    """Let all do what they have to do until something has been heard, no longer than PATIENCE_S."""
    messages, end = [], time.monotonic() + PATIENCE_S
    while not until(messages) and time.monotonic() < end:
        for link in links:
            link.poll(now_us)
            link.flush(now_us)
        messages += hub.poll(now_us, 0.005)
        hub.flush(now_us)
    assert until(messages), messages
    return messages


def begun(hub, *links):
    names = {f"robot-{number}" for number in range(len(links))}
    heard(hub, links, lambda messages: {name for name, _ in messages} == names)


def still_works(hub, link, name="robot-0"):
    link.send({"type": "tag", "tag": "W1"})
    heard(hub, [link], lambda m: (name, "tag") in [(who, what["type"]) for who, what in m])


def stranger(hub, data):
    """Connect, write, and return whether the server closes the connection."""
    with socket.create_connection(hub.address, PATIENCE_S) as sock:
        sock.sendall(data)
        end = time.monotonic() + PATIENCE_S
        sock.setblocking(False)
        while time.monotonic() < end:
            hub.poll(0, 0.005)
            try:
                if not sock.recv(4096):
                    return True
            except BlockingIOError:
                continue
            except ConnectionResetError:
                return True
    return False


def test_messages_go_both_ways(hub):
    link = link_to(hub)
    begun(hub, link)
    hub.send("robot-0", {"type": "go", "id": 1})
    hub.flush(0)
    end = time.monotonic() + PATIENCE_S
    while not (got := link.poll(0)) and time.monotonic() < end:
        time.sleep(0.002)
    assert [(message["type"], message["id"]) for message in got] == [("go", 1)]
    still_works(hub, link)


def test_what_follows_a_hello_at_once_is_not_lost(hub):
    link = link_to(hub)
    while not link.is_up:
        link.poll(0)
        hub.poll(0, 0.005) if not link.is_up else None
    link.send({"type": "state"})
    link.flush(0)  # hello and state wait together for the server
    time.sleep(0.02)
    messages = heard(hub, [], lambda m: len(m) == 2)
    assert [message["type"] for _, message in messages] == ["connected", "state"]


@pytest.mark.parametrize(
    "data",
    [
        b"GET / HTTP/1.1\r\nHost: x\r\n\r\n",
        bytes(200),
        (LARGEST + 1).to_bytes(4, "big"),
        b"\xff" * 4,
        pack({"type": "hello"}, SECRET, HELLO + b"a nonce of another time"),
    ],
)
def test_garbage_oversized_frames_and_old_hellos_are_refused(hub, data, caplog):
    link = link_to(hub)
    begun(hub, link)
    with caplog.at_level(logging.WARNING):
        assert stranger(hub, data)
    assert hub.refused == 1
    assert "refused" in caplog.text
    assert hub.present == {"robot-0"}
    still_works(hub, link)


def test_a_wrong_secret_is_refused(hub, caplog):
    link = link_to(hub)
    begun(hub, link)
    other = link_to(hub, "robot-1", b"a wrong secret")
    with caplog.at_level(logging.WARNING):
        end = time.monotonic() + PATIENCE_S
        while "authentication code" not in caplog.text and time.monotonic() < end:
            other.poll(0)
            hub.poll(0, 0.005)
    assert "robot-1: a frame has a wrong authentication code" in caplog.text
    assert not other.is_up
    still_works(hub, link)


def test_a_thief_of_the_welcome_cannot_answer_it(hub):
    """Who does not check the server, but answers its welcome with another secret, is refused."""
    link = link_to(hub)
    begun(hub, link)
    forged = pack({"type": "hello", "version": 1, "robot": "robot-1", "nonce": "1"}, b"no", HELLO)
    assert stranger(hub, forged)
    assert hub.present == {"robot-0"}
    still_works(hub, link)


def test_a_name_that_is_not_expected_is_refused(hub, caplog):
    guest = link_to(hub, "robot-9")
    with caplog.at_level(logging.WARNING):
        end = time.monotonic() + PATIENCE_S
        while "is expected" not in caplog.text and time.monotonic() < end:
            guest.poll(0)
            hub.poll(0, 0.005)
    assert "no robot named 'robot-9' is expected" in caplog.text
    assert hub.present == frozenset()


def test_messages_played_again_are_refused(hub):
    """In their own session they are not counted twice; in another they end the connection."""
    taps = []
    link, other = link_to(hub, taps=taps), link_to(hub, "robot-1")
    begun(hub, link, other)
    still_works(hub, link)
    hello, *frames = taps[0].kept
    TcpWire.write(taps[0], b"".join(frames))
    link.send({"type": "tag", "tag": "W2"})
    messages = heard(hub, [link, other], lambda m: len(m) >= 1)
    assert [message["tag"] for _, message in messages] == ["W2"]
    assert stranger(hub, hello + b"".join(frames))
    assert hub.present == {"robot-0", "robot-1"}
    still_works(hub, link)
    still_works(hub, other, "robot-1")


def test_a_session_that_turns_to_garbage_ends_alone(hub, caplog):
    taps = []
    link, other = link_to(hub, taps=taps), link_to(hub, "robot-1")
    begun(hub, link, other)
    TcpWire.write(taps[0], b"\x00\x00\x00\x02" + bytes(34))
    with caplog.at_level(logging.WARNING):
        messages = heard(hub, [other], lambda m: m)
    assert messages == [("robot-0", {"type": "gone"})]
    assert "robot-0: session ended: a frame has a wrong" in caplog.text
    still_works(hub, other, "robot-1")


def test_a_robot_that_comes_again_takes_the_place_of_its_old_session(hub):
    old, new = link_to(hub), link_to(hub)
    begun(hub, old)
    messages = heard(hub, [new], lambda m: len(m) == 2)
    assert [message["type"] for _, message in messages] == ["gone", "connected"]
    still_works(hub, new)


def test_a_robot_comes_back_after_it_was_cut_off(hub):
    taps = []
    link = link_to(hub, taps=taps)
    begun(hub, link)
    taps[0].close()
    link.poll(0)
    assert not link.is_up
    heard(hub, [], lambda m: m == [("robot-0", {"type": "gone"})])
    heard(hub, [link], lambda m: m == [("robot-0", {"type": "connected"})], now_us=1_000_000)


def test_who_says_nothing_is_closed(hub, monkeypatch, caplog):
    monkeypatch.setattr(hubs, "UNKNOWN_S", 0.05)
    with caplog.at_level(logging.WARNING):
        assert stranger(hub, b"")
    assert "sent no valid hello in time" in caplog.text


def test_more_connections_than_allowed_are_refused(hub, monkeypatch):
    monkeypatch.setattr(hubs, "MOST_CONNECTIONS", 1)
    link = link_to(hub)
    begun(hub, link)
    assert stranger(hub, b"")
    still_works(hub, link)


def test_a_connection_that_cannot_be_greeted_is_refused(hub, monkeypatch):
    def fail(*_):
        raise ProtocolError("not now")

    monkeypatch.setattr(hubs, "_Connection", fail)
    assert stranger(hub, b"")
    assert hub.refused == 1


def test_a_message_of_the_session_key_alone_is_no_hello(hub):
    assert stranger(hub, pack({"n": 1, "ack": 0, "clock": 0, "type": "tag"}, SECRET, ROBOT))

"""What others on this machine, or in the browser, cannot do; see docs/robustness.md."""

from __future__ import annotations

import http.client
import itertools
import json
import shutil
import socket
import threading
import time
from collections.abc import Iterator
from pathlib import Path

import pytest

from rmfs.measure import RunFolder, load_run
from rmfs.measure.report import write_report
from rmfs.view import server as servers
from rmfs.view.export import export
from rmfs.view.server import Answer, Server

JSON = {"Content-Type": "application/json"}


@pytest.fixture
def done() -> list[object]:
    return []


@pytest.fixture
def server(done: list[object], monkeypatch: pytest.MonkeyPatch) -> Iterator[Server]:
    monkeypatch.setattr(servers, "PATIENCE_S", 1.0)

    def change(wish: object) -> Answer:
        done.append(wish)
        return Answer.json({})

    with Server({"/session": lambda _: Answer.json({"runs": 0})}, {"/control": change}) as made:
        threading.Thread(target=made.serve_forever, daemon=True).start()
        yield made
        made.shutdown()


def ask(
    server: Server, path: str, body: bytes | None = None, **headers: str
) -> http.client.HTTPResponse:
    connection = http.client.HTTPConnection("127.0.0.1", server.server_port, timeout=20)
    method = "GET" if body is None else "POST"
    connection.request(method, path, body, headers={} if body is None else {**JSON, **headers})
    return connection.getresponse()


def admitted(server: Server) -> str:
    answer = ask(server, server.url.removeprefix(f"http://127.0.0.1:{server.server_port}"))
    assert (answer.status, answer.headers["Location"]) == (303, "/")
    cookie = answer.headers["Set-Cookie"]
    assert "HttpOnly" in cookie and "SameSite=Strict" in cookie
    return cookie.partition(";")[0]


def test_the_printed_address_lets_a_page_change_the_run(server: Server, done: list[object]) -> None:
    cookie = admitted(server)
    assert ask(server, "/control", b'{"a": 1}', Cookie=cookie).status == 200
    assert ask(server, "/control", b'{"a": 2}', Cookie=f"other=1; {cookie}").status == 200
    assert done == [{"a": 1}, {"a": 2}]


def test_without_the_token_nothing_changes(server: Server, done: list[object]) -> None:
    """Another user of the machine reaches the port, but has not seen the address."""
    name = server.cookie
    for cookie in ("", f"{name}=", f"{name}=x", "nonsense", f"{name}={'ä'}", ";=;", "a" * 4000):
        answer = ask(server, "/control", b"{}", Cookie=cookie.encode().decode("latin-1"))
        assert answer.status == 403
        assert "address that rmfs printed" in json.loads(answer.read())["error"]
    assert ask(server, "/?token=guess").status == 403
    assert ask(server, "/?token=%C3%A4").status == 403
    assert ask(server, "/control?token=" + server.token, b"{}").status == 403
    assert ask(server, "/session").status == 200  # looking is allowed
    assert not done


def test_two_servers_have_two_tokens(server: Server) -> None:
    with Server({}) as other:
        assert other.token != server.token
        assert other.cookie != server.cookie
        assert len(other.token) >= 32


def test_pages_from_elsewhere_change_nothing(server: Server, done: list[object]) -> None:
    """Even with the cookie: the browser tells where a request comes from."""
    cookie = admitted(server)
    for headers in (
        {"Origin": "http://evil.example"},
        {"Origin": "null"},
        {"Origin": f"http://127.0.0.1:{server.server_port + 1}"},
        {"Host": "evil.example"},
        {"Host": f"127.0.0.1.evil.example:{server.server_port}"},
        {"Content-Type": "text/plain"},
        {"Content-Type": "application/x-www-form-urlencoded"},
    ):
        assert ask(server, "/control", b"{}", Cookie=cookie, **headers).status in (400, 403)
    assert not done


@pytest.mark.parametrize("length", ["-1", "x", "1e3", "99999999999999999999", "1000001", "٣"])
def test_lengths_that_are_none(server: Server, done: list[object], length: str) -> None:
    with socket.create_connection(("127.0.0.1", server.server_port), timeout=20) as line:
        head = f"POST /control HTTP/1.1\r\nHost: 127.0.0.1:{server.server_port}\r\n"
        more = f"Content-Type: application/json\r\nContent-Length: {length}\r\n\r\n"
        line.sendall((head + more).encode())
        assert line.recv(100).startswith(b"HTTP/1.1 400")
    assert not done


@pytest.mark.parametrize("body", [b"", b"{", b"[" * 200_000, b"\xff", b"9" * 9_000])
def test_bodies_that_are_none(server: Server, done: list[object], body: bytes) -> None:
    answer = ask(server, "/control", body, Cookie=admitted(server))
    assert answer.status == 400
    assert ask(server, "/session").status == 200


@pytest.mark.parametrize(
    "start",
    [
        b"",
        b"GET /session HT",
        b"GET /session HTTP/1.1\r\nHost: x\r\nX-A: ",
        b"POST /control HTTP/1.1\r\nContent-Type: application/json\r\nContent-Length: 9\r\n\r\n{",
    ],
)
def test_slow_clients_are_hung_up_on(server: Server, start: bytes) -> None:
    """A letter now and then does not keep a connection: the request as a whole has its time."""
    with socket.create_connection(("127.0.0.1", server.server_port), timeout=20) as line:
        line.sendall(start)
        line.settimeout(0.2)
        end = time.monotonic() + 20
        while time.monotonic() < end:
            try:
                if line.recv(1000) == b"":
                    break
            except TimeoutError:
                try:
                    line.sendall(b"a" if start else b"")
                except OSError:
                    break
            except OSError:
                break
        else:
            pytest.fail("the connection is still open")
    assert ask(server, "/session").status == 200


@pytest.mark.parametrize("late", [None, 31], ids=["in-time", "a-thread-starts-late"])
def test_a_flood_of_connections_leaves_room_after_it(
    server: Server, monkeypatch: pytest.MonkeyPatch, late: int | None
) -> None:
    """Those that ask for nothing are hung up on when others come, the oldest first."""
    monkeypatch.setattr(servers, "MOST_CONNECTIONS", 8)
    monkeypatch.setattr(servers, "PATIENCE_S", 60.0)
    serve, started = Server.process_request_thread, itertools.count()
    most_connected = threading.Event()

    def start(self: Server, request: object, client_address: object) -> None:
        if next(started) == late:
            most_connected.wait(20)
        serve(self, request, client_address)

    monkeypatch.setattr(Server, "process_request_thread", start)
    lines = []
    for _ in range(40):
        lines.append(socket.create_connection(("127.0.0.1", server.server_port), timeout=20))
        time.sleep(0.01)
        if len(lines) == 36:
            most_connected.set()
            time.sleep(0.1)
    refused = 0
    for line in lines[:32]:
        line.settimeout(10)
        try:
            refused += line.recv(1) == b""
        except ConnectionError:
            refused += 1
    assert refused == 32
    assert threading.active_count() < 30
    for line in lines:
        line.close()
    end = time.monotonic() + 20
    while time.monotonic() < end:
        try:
            assert ask(server, "/session").status == 200
            return
        except (OSError, http.client.HTTPException):
            time.sleep(0.1)
    pytest.fail("nobody is served any more")


def test_many_requests_at_once_are_all_answered(server: Server) -> None:
    """200 at once, of which 8 are served at a time."""
    told: list[int] = []

    def one() -> None:
        told.append(ask(server, "/session").status)

    threads = [threading.Thread(target=one) for _ in range(200)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join(30)
    assert told == [200] * 200


def test_a_defect_of_ours_is_the_request_s_concern(server: Server, capfd) -> None:
    def fail(_: object) -> Answer:
        raise ZeroDivisionError("of ours")

    server.gets["/defect"] = fail
    answer = ask(server, "/defect")
    assert answer.status == 500
    assert json.loads(answer.read()) == {"error": "ZeroDivisionError: of ours"}
    with socket.create_connection(("127.0.0.1", server.server_port), timeout=20) as line:
        head = f"Host: 127.0.0.1:{server.server_port}\r\n\r\n"
        line.sendall(f"GET http://[ HTTP/1.1\r\n{head}".encode())
        assert line.recv(100).startswith(b"HTTP/1.1 400")
    assert capfd.readouterr().err == ""


def test_headers_without_end(server: Server) -> None:
    with socket.create_connection(("127.0.0.1", server.server_port), timeout=20) as line:
        line.sendall(b"GET /session HTTP/1.1\r\n" + b"X: 1\r\n" * 200 + b"\r\n")
        assert line.recv(100).startswith(b"HTTP/1.1 431")
    with socket.create_connection(("127.0.0.1", server.server_port), timeout=20) as line:
        line.sendall(b"GET /" + b"a" * 70_000 + b" HTTP/1.1\r\n\r\n")
        assert line.recv(100).startswith(b"HTTP/1.1 414")


def test_markup_in_names_stays_text(runs: list[RunFolder], tmp_path: Path) -> None:
    """A run of a stranger, whose layout is called like a script, in report and exported page."""
    evil = "<script>alert(1)</script><img src=x onerror=alert(1)>"
    folder = tmp_path / "run"
    shutil.copytree(runs[0].path, folder)
    told = json.loads((folder / "run.json").read_text())
    for part in ("layout", "scenario", "controllers"):
        told[part]["name"] = evil
    (folder / "run.json").write_text(json.dumps(told))
    run = load_run(folder)
    write_report(run, tmp_path / "report.html")
    export([run], tmp_path / "page.html")
    for name in ("report.html", "page.html"):
        html = (tmp_path / name).read_text("utf-8")
        assert "<script>alert" not in html and "<img src=x" not in html

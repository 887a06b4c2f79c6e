"""The server: loopback, a fixed table of paths, and refusals with a reason."""

import http.client
import json
import socket
import threading
from collections.abc import Iterator
from pathlib import Path

import pytest

from rmfs.errors import InputError
from rmfs.measure import RunFolder
from rmfs.view.answers import replay_server
from rmfs.view.container import unpack
from rmfs.view.server import Server


@pytest.fixture
def server(runs: list[RunFolder]) -> Iterator[Server]:
    with replay_server(runs) as made:
        threading.Thread(target=made.serve_forever, daemon=True).start()
        yield made
        made.shutdown()


def ask(
    server: Server, path: str, method: str = "GET", body: bytes | None = None, **headers: str
) -> http.client.HTTPResponse:
    connection = http.client.HTTPConnection("127.0.0.1", server.server_port, timeout=20)
    named = {name.replace("_", "-"): value for name, value in headers.items()}
    connection.request(method, path, body=body, headers=named)
    return connection.getresponse()


def test_it_binds_to_loopback_only(server: Server) -> None:
    assert server.server_address[0] == "127.0.0.1"
    assert server.socket.getsockname()[0] == "127.0.0.1"


def test_the_page_comes_with_a_policy(server: Server) -> None:
    for path in ("/", "/app.js", "/app.css"):
        answer = ask(server, path)
        assert answer.status == 200
        policy = answer.headers["Content-Security-Policy"]
        assert "default-src 'none'" in policy
        assert "script-src 'self'" in policy
        assert "unsafe" not in policy
        assert answer.headers["X-Content-Type-Options"] == "nosniff"


def test_scenes_are_served(server: Server, runs: list[RunFolder]) -> None:
    assert json.loads(ask(server, "/session").read())["runs"] == 2
    for number, run in enumerate(runs):
        header, arrays = unpack(ask(server, f"/runs/{number}").read())
        assert header["title"] == run.path.name
        assert len(arrays["motion.t0_us"]) == len(run.trace)
        assert len(arrays["events.kind"]) == len(run.events)


@pytest.mark.parametrize(
    "path",
    [
        "/run.json",
        "/../run.json",
        "/runs/../run.json",
        "/runs/0/../../../../etc/passwd",
        "/%2e%2e/%2e%2e/etc/passwd",
        "/..%2frun.json",
        "/runs/%2e%2e%2frun.json",
        "//etc/passwd",
        "/static/../server.py",
        "/app.js/../../server.py",
        "/runs/2",
        "/runs/-1",
        "/runs/0%00",
        "/index.html",
    ],
)
def test_nothing_else_is_served(server: Server, path: str) -> None:
    answer = ask(server, path)
    assert answer.status == 404
    assert json.loads(answer.read()) == {"error": "no such page"}


def test_other_hosts_and_origins_are_refused(server: Server) -> None:
    port = server.server_port
    assert ask(server, "/", Host=f"localhost:{port}").status == 200
    assert ask(server, "/", Host="evil.example").status == 403
    assert ask(server, "/", Host=f"evil.example:{port}").status == 403
    assert ask(server, "/session", Origin="http://evil.example").status == 403
    assert ask(server, "/session", Origin=f"http://127.0.0.1:{port}").status == 200


def test_only_json_can_be_sent(server: Server) -> None:
    assert ask(server, "/session", "POST", b"a=1", Content_Type="text/plain").status == 400
    assert ask(server, "/session", "POST", b"{}", Content_Type="application/json").status == 404
    assert ask(server, "/session", "PUT", b"{}").status == 501


def test_a_damaged_run_is_answered_with_the_reason(runs: list[RunFolder], tmp_path: Path) -> None:
    for file in runs[0].path.iterdir():
        (tmp_path / file.name).write_bytes(file.read_bytes())
    trace = tmp_path / "trace.parquet"
    trace.write_bytes(trace.read_bytes()[:1000])
    damaged = RunFolder(tmp_path, runs[0].parameters)
    with replay_server([damaged]) as server:
        threading.Thread(target=server.serve_forever, daemon=True).start()
        answer = ask(server, "/runs/0")
        assert answer.status == 422
        assert "truncated or not a trace" in json.loads(answer.read())["error"]
        server.shutdown()


def test_a_port_in_use_is_said(runs: list[RunFolder]) -> None:
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        taken.listen()
        port = taken.getsockname()[1]
        with pytest.raises(InputError, match=f"port {port}: cannot be used"):
            replay_server(runs, port)

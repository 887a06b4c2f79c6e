"""The server behind the page: loopback only, and nothing but the page and its runs.

What can be asked for is a fixed table of paths: none of them is looked up in a file system, so no
path leads out of the run folder. Requests that name another host (a page elsewhere that had its
name point here) or come from another origin are refused.
"""

from __future__ import annotations

import json
from dataclasses import dataclass
from http import HTTPStatus
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from typing import TYPE_CHECKING, Any
from urllib.parse import parse_qs, urlsplit

from rmfs.errors import InputError
from rmfs.view import container, pages

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

HOST = "127.0.0.1"
LONGEST_REQUEST = 1_000_000
"""Bytes a request may bring along."""

JSON = "application/json"


@dataclass(frozen=True, slots=True)
class Answer:
    """What a request is answered with."""

    body: bytes
    kind: str = JSON
    status: HTTPStatus = HTTPStatus.OK

    @classmethod
    def json(cls, value: object, status: HTTPStatus = HTTPStatus.OK) -> Answer:
        """Answer with a value as JSON."""
        return cls(json.dumps(value).encode(), JSON, status)

    @classmethod
    def scene(cls, packed: bytes) -> Answer:
        """Answer with a container."""
        return cls(packed, container.MIME)


class Server(ThreadingHTTPServer):
    """Serves the page, and what it asks for, on loopback.

    Parameters
    ----------
    get, post
        What is answered, by path: functions of the query and of the JSON sent.
    port
        Default any free one.
    """

    daemon_threads = True

    def __init__(
        self,
        get: Mapping[str, Callable[[Mapping[str, str]], Answer]],
        post: Mapping[str, Callable[[Any], Answer]] | None = None,
        port: int = 0,
    ) -> None:
        self.gets = {path: _file(*entry) for path, entry in pages.FILES.items()} | dict(get)
        self.posts = dict(post or {})
        try:
            super().__init__((HOST, port), _Handler)
        except OSError as error:
            raise InputError(f"port {port}: cannot be used ({error.strerror})") from None

    @property
    def url(self) -> str:
        """Where the page is."""
        return f"http://{HOST}:{self.server_port}/"


def _file(name: str, kind: str) -> Callable[[Mapping[str, str]], Answer]:
    return lambda _: Answer(pages.content(name), kind)


class _Handler(BaseHTTPRequestHandler):
    server: Server
    protocol_version = "HTTP/1.1"

    def do_GET(self) -> None:
        asked = urlsplit(self.path)
        handle = self.server.gets.get(asked.path)
        query = {name: values[-1] for name, values in parse_qs(asked.query).items()}
        self._answer(None if handle is None else lambda: handle(query))

    def do_POST(self) -> None:
        handle = self.server.posts.get(urlsplit(self.path).path)
        length = int(self.headers.get("Content-Length") or 0)
        if length > LONGEST_REQUEST or self.headers.get("Content-Type") != JSON:
            self.close_connection = True
            self._send(_refusal(HTTPStatus.BAD_REQUEST, "expected JSON"))
            return
        body = self.rfile.read(length)
        self._answer(None if handle is None else lambda: handle(json.loads(body)))

    def _answer(self, handle: Callable[[], Answer] | None) -> None:
        if not self._is_ours():
            answer = _refusal(HTTPStatus.FORBIDDEN, "not for this host or origin")
        elif handle is None:
            answer = _refusal(HTTPStatus.NOT_FOUND, "no such page")
        else:
            try:
                answer = handle()
            except InputError as error:
                answer = _refusal(HTTPStatus.UNPROCESSABLE_ENTITY, str(error))
            except (ValueError, KeyError, TypeError) as error:
                answer = _refusal(HTTPStatus.BAD_REQUEST, f"cannot be understood: {error}")
        self._send(answer)

    def _is_ours(self) -> bool:
        """Whether the request names this server, and comes from its page if from any."""
        port = self.server.server_port
        hosts = {f"{HOST}:{port}", f"localhost:{port}"}
        origin = self.headers.get("Origin")
        allowed = origin is None or origin in {f"http://{host}" for host in hosts}
        return self.headers.get("Host") in hosts and allowed

    def _send(self, answer: Answer) -> None:
        self.send_response(answer.status)
        for name, value in {
            "Content-Type": answer.kind,
            "Content-Length": str(len(answer.body)),
            "Content-Security-Policy": pages.POLICY,
            "X-Content-Type-Options": "nosniff",
            "Referrer-Policy": "no-referrer",
            "Cross-Origin-Resource-Policy": "same-origin",
            "Cache-Control": "no-store",
        }.items():
            self.send_header(name, value)
        self.end_headers()
        self.wfile.write(answer.body)

    def handle(self) -> None:
        """Serve one connection; a page that goes away is nothing to complain about."""
        try:
            super().handle()
        except (ConnectionError, TimeoutError):
            self.close_connection = True

    def log_message(self, format: str, *args: object) -> None:
        """Say nothing: the terminal belongs to the run."""


def _refusal(status: HTTPStatus, message: str) -> Answer:
    return Answer.json({"error": message}, status)

"""The server of the viewer's page and of its data, on the loopback interface only.

The path of a request is looked up in a fixed table, never in the file system, so that a request
cannot reach files outside this table. Requests that name another host (DNS rebinding) or come from
another origin (`Sec-Fetch-Site`, `Origin`) are refused. Requests that change something need a
token, which is part of the printed address. Other users of the machine can reach the port but do
not have the token: they can watch a run but not control it. The number of connections and the size
of requests are limited, and slow clients are disconnected. If a request fails, the answer states
the error; other requests are not affected.
"""

from __future__ import annotations

import json
import secrets
import socket
import threading
import time
from contextlib import suppress
from dataclasses import dataclass, field
from http import HTTPStatus
from http.cookies import CookieError, SimpleCookie
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from typing import TYPE_CHECKING, Any
from urllib.parse import parse_qs, urlsplit

from rmfs.errors import InputError
from rmfs.view import container, pages

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

HOST = "127.0.0.1"
LONGEST_REQUEST = 1_000_000
"""Maximum size of a request body in bytes."""
MOST_CONNECTIONS = 64
"""Maximum number of open connections. A page uses at most six; idle connections are closed in
favour of new ones."""
PATIENCE_S = 20.0
"""Wall time, in s, after which a connection that has not sent a request is closed."""

JSON = "application/json"


@dataclass(frozen=True, slots=True)
class Answer:
    """The answer to a request."""

    body: bytes
    kind: str = JSON
    status: HTTPStatus = HTTPStatus.OK
    headers: Mapping[str, str] = field(default_factory=dict)

    @classmethod
    def json(cls, value: object, status: HTTPStatus = HTTPStatus.OK) -> Answer:
        """Create an answer from a value, as JSON."""
        return cls(json.dumps(value).encode(), JSON, status)

    @classmethod
    def scene(cls, packed: bytes) -> Answer:
        """Create an answer from a packed scene."""
        return cls(packed, container.MIME)


class Server(ThreadingHTTPServer):
    """Serves the page and its requests on the loopback interface.

    Parameters
    ----------
    get, post
        Handlers of GET and POST requests by path: functions of the query (GET) or of the JSON that
        was sent (POST).
    port
        Port to use. Default: any free one.

    Attributes
    ----------
    token
        Secret that a page must know to make requests that change something.

    Raises
    ------
    InputError
        If the port cannot be used.
    """

    daemon_threads = True
    request_queue_size = 256

    def __init__(
        self,
        get: Mapping[str, Callable[[Mapping[str, str]], Answer]],
        post: Mapping[str, Callable[[Any], Answer]] | None = None,
        port: int = 0,
    ) -> None:
        self.gets = {path: _file(*entry) for path, entry in pages.FILES.items()} | dict(get)
        self.posts = dict(post or {})
        self.token = secrets.token_urlsafe(24)
        self._reading: dict[socket.socket, float] = {}
        self._open = 0
        self._lock = threading.Lock()
        try:
            super().__init__((HOST, port), _Handler)
        except OSError as error:
            raise InputError(f"port {port}: cannot be used ({error.strerror})") from None

    @property
    def url(self) -> str:
        """Address of the page, including the token."""
        return f"http://{HOST}:{self.server_port}/?token={self.token}"

    @property
    def cookie(self) -> str:
        """Name of the cookie with the token.

        The name contains the port, as servers on different ports of a host share cookies.
        """
        return f"rmfs-{self.server_port}"

    def process_request(self, request: Any, client_address: Any) -> None:
        """Serve a connection in a new thread.

        If `MOST_CONNECTIONS` are open, the one that has been idle longest is closed in favour of
        the new one. If none is idle, or twice `MOST_CONNECTIONS` are open, the new one is refused.
        """
        with self._lock:
            crowded, full = self._open >= MOST_CONNECTIONS, self._open >= 2 * MOST_CONNECTIONS
            idle = min(self._reading, key=self._reading.__getitem__, default=None)
            refused = full or (crowded and idle is None)
            self._open += not refused
            if crowded and idle is not None:
                del self._reading[idle]
        if crowded and idle is not None:
            _hang_up(idle)
        if refused:
            self.shutdown_request(request)
            return
        self.reads(request)
        super().process_request(request, client_address)

    def process_request_thread(self, request: Any, client_address: Any) -> None:
        """Serve a connection, then count it as closed."""
        try:
            super().process_request_thread(request, client_address)
        finally:
            with self._lock:
                self._open -= 1
                self._reading.pop(request, None)

    def reads(self, request: socket.socket, *, over: bool = False) -> None:
        """Record that a request is awaited on a connection or, if `over`, has arrived."""
        with self._lock:
            if over:
                self._reading.pop(request, None)
            else:
                self._reading[request] = time.monotonic()

    def service_actions(self) -> None:
        """Disconnect clients that take too long to send a request; called at least every 0.5 s."""
        limit = time.monotonic() - PATIENCE_S
        with self._lock:
            slow = [request for request, since in self._reading.items() if since < limit]
        for request in slow:
            _hang_up(request)


def _hang_up(request: socket.socket) -> None:
    with suppress(OSError):
        request.shutdown(socket.SHUT_RDWR)


def _file(name: str, kind: str) -> Callable[[Mapping[str, str]], Answer]:
    return lambda _: Answer(pages.content(name), kind)


class _Handler(BaseHTTPRequestHandler):
    server: Server
    protocol_version = "HTTP/1.1"
    timeout = PATIENCE_S  # of a single read or write

    def do_GET(self) -> None:
        self.server.reads(self.connection, over=True)
        self._answer(self._got)

    def _got(self) -> Answer:
        asked = urlsplit(self.path)
        query = {name: values[-1] for name, values in parse_qs(asked.query).items()}
        if asked.path == "/" and "token" in query:
            return self._admitted(query["token"])
        handle = self.server.gets.get(asked.path)
        if handle is None:
            return _refusal(HTTPStatus.NOT_FOUND, "no such page")
        if asked.path not in pages.FILES and not self._is_from_here():
            return _NOT_OURS
        if not self._is_trusted():
            # who may only look is nobody a run waits for
            query.pop("page", None)
        return handle(query)

    def do_POST(self) -> None:
        told = self.headers.get("Content-Length") or ""
        length = int(told) if told.isascii() and told.isdigit() and len(told) < 9 else -1
        if not 0 <= length <= LONGEST_REQUEST or self.headers.get("Content-Type") != JSON:
            self.close_connection = True
            self._send(_refusal(HTTPStatus.BAD_REQUEST, "expected JSON"))
            return
        body = self.rfile.read(length)
        self.server.reads(self.connection, over=True)
        self._answer(lambda: self._posted(body))

    def _posted(self, body: bytes) -> Answer:
        handle = self.server.posts.get(urlsplit(self.path).path)
        if handle is None:
            return _refusal(HTTPStatus.NOT_FOUND, "no such page")
        if not self._is_from_here():
            return _NOT_OURS
        if not self._is_trusted():
            told = "open the address that rmfs printed, which contains a token"
            return _refusal(HTTPStatus.FORBIDDEN, told)
        return handle(json.loads(body))

    def _admitted(self, token: str) -> Answer:
        """Replace the token in an address by a cookie, so that the address bar does not show it."""
        if not secrets.compare_digest(token.encode(), self.server.token.encode()):
            return _refusal(HTTPStatus.FORBIDDEN, "this token does not belong to the run")
        cookie = f"{self.server.cookie}={self.server.token}; HttpOnly; SameSite=Strict; Path=/"
        moved = {"Set-Cookie": cookie, "Location": "/"}
        return Answer(b"", "text/plain", HTTPStatus.SEE_OTHER, moved)

    def _is_trusted(self) -> bool:
        """Whether the request has the token."""
        try:
            cookies = SimpleCookie(self.headers.get("Cookie", ""))
        except CookieError:
            return False
        given = cookies.get(self.server.cookie)
        token = "" if given is None else given.value
        return secrets.compare_digest(token.encode(), self.server.token.encode())

    def _answer(self, handle: Callable[[], Answer]) -> None:
        """Answer a request; if it fails, the answer states the error."""
        try:
            answer = handle() if self._is_ours() else _NOT_OURS
        except InputError as error:
            answer = _refusal(HTTPStatus.UNPROCESSABLE_ENTITY, str(error))
        except _NOT_UNDERSTOOD as error:
            answer = _refusal(HTTPStatus.BAD_REQUEST, f"invalid request: {error}")
        except Exception as error:
            told = f"{type(error).__name__}: {error}"
            answer = _refusal(HTTPStatus.INTERNAL_SERVER_ERROR, told)
        self._send(answer)

    def _is_ours(self) -> bool:
        """Whether the request names this server and does not come from a page of another server."""
        port = self.server.server_port
        hosts = {f"{HOST}:{port}", f"localhost:{port}"}
        origin = self.headers.get("Origin")
        allowed = origin is None or origin in {f"http://{host}" for host in hosts}
        return self.headers.get("Host") in hosts and allowed

    def _is_from_here(self) -> bool:
        """Whether `Sec-Fetch-Site`, which only browsers send, names no other site."""
        return self.headers.get("Sec-Fetch-Site", "none") in ("none", "same-origin")

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
            **answer.headers,
        }.items():
            self.send_header(name, value)
        self.end_headers()
        self.wfile.write(answer.body)

    def handle_one_request(self) -> None:
        """Answer a request, and await the next on the same connection, not for ever."""
        super().handle_one_request()
        if not self.close_connection:
            self.server.reads(self.connection)

    def handle(self) -> None:
        """Serve one connection; ignore the error if the page disconnects."""
        try:
            super().handle()
        except (ConnectionError, TimeoutError):
            self.close_connection = True

    def log_message(self, format: str, *args: object) -> None:
        """Log nothing, since the terminal shows the output of the run."""


def _refusal(status: HTTPStatus, message: str) -> Answer:
    return Answer.json({"error": message}, status)


_NOT_OURS = _refusal(HTTPStatus.FORBIDDEN, "requests from this host or origin are refused")
_NOT_UNDERSTOOD = (
    *(ValueError, KeyError, TypeError, AttributeError),
    *(OverflowError, RecursionError),
)

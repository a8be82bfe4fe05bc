"""Only who has the viewer's address may talk to the viewer: other pages, programs and users reach this machine's ports, too."""

import gzip
import hmac
import secrets
import socket
from collections.abc import Iterator
from contextlib import contextmanager
from html import escape
from http import HTTPStatus
from typing import Any, Final
from unittest.mock import patch
from urllib.parse import parse_qs, urlsplit

from ...errors import StatedError, how_to_install

LOOPBACK_NAMES: Final = ("127.0.0.1", "localhost", "[::1]")
TITLE: Final = b"<title>Viser</title>"
"""Of the viewer's page as its library has it."""
PATIENCE: Final = 10.0
"""For the viewer's own server to answer [s]."""


class UnguardedError(StatedError):
    """The viewer's server would answer anybody, or nobody: viser or websockets have changed."""

    why: str

    def __str__(self) -> str:
        return f"the viewer is not started, for {self.why}; install viser and websockets by {how_to_install('view')}"


class Guard:
    """What a request must bring: a token, in the address or in the cookie that the page with it sets, and of a websocket a page of ours.

    Args:
        port: Of the server; 0 until it is known, and nothing is answered.
        names: Hosts by which pages may call it; None: any, for who has exposed it knows them.
    """

    def __init__(self, port: int, names: tuple[str, ...] | None = LOOPBACK_NAMES) -> None:
        self.port, self.token, self.title = port, secrets.token_urlsafe(16), "Clamber"
        self._names = names

    def admits(self, path: str, headers: Any) -> bool:
        """Whether it answers a request.

        Args:
            path: What it asks for.
            headers: Of the request, of `websockets`.
        """
        if any(len(headers.get_all(name)) > 1 for name in ("Host", "Origin", "Upgrade", "Cookie")):
            return False
        host = headers.get("Host", "")
        name, _, port = host.rpartition(":")
        if self._names is not None and (name not in self._names or port != str(self.port)):  # a name that leads here
            return False
        if "Upgrade" in headers and headers.get("Origin") not in (f"http://{host}", f"https://{host}"):
            return False
        return self._is_token(self._in_path(path)) or self._is_token(self._in_cookie(headers.get("Cookie", "")))

    def answer(self, path: str, response: Any) -> None:
        """Have the browser bring the token from now on, where the address had it, and call the page by what it shows."""
        if response.headers.get("Content-Type") == "text/html":
            packed = response.headers.get("Content-Encoding") == "gzip"
            page = gzip.decompress(response.body) if packed else response.body
            titled = page.replace(TITLE, f"<title>{escape(self.title)}</title>".encode())
            response.body = gzip.compress(titled, 1) if packed else titled
            del response.headers["Content-Length"]
            response.headers["Content-Length"] = str(len(response.body))
        if self._is_token(self._in_path(path)):
            response.headers["Set-Cookie"] = f"clamber-{self.port}={self.token}; Path=/; HttpOnly; SameSite=Strict"
        response.headers["Referrer-Policy"] = "no-referrer"

    def _is_token(self, said: str) -> bool:
        return hmac.compare_digest(said.encode("utf-8", "replace"), self.token.encode())

    def _in_path(self, path: str) -> str:
        return parse_qs(urlsplit(path).query, max_num_fields=8).get("token", [""])[0]

    def _in_cookie(self, cookies: str) -> str:
        for cookie in cookies.split(";"):
            name, _, value = cookie.strip().partition("=")
            if name == f"clamber-{self.port}":
                return value
        return ""


@contextmanager
def guarded(guard: Guard) -> Iterator[None]:
    """A block in which viser starts one server, which refuses with 403 whatever a guard does not admit.

    viser has no setting for this, so the function of `websockets` that it calls is given one here. Whether that was heeded is for
    `check_guarded` to see.
    """
    from websockets.asyncio import server

    serve = server.serve

    def serve_guarded(*words: Any, process_request: Any = None, **options: Any) -> Any:
        def process(connection: Any, request: Any) -> Any:
            try:
                admitted = guard.admits(request.path, request.headers)
            except ValueError:  # no address
                admitted = False
            if not admitted:
                return connection.respond(
                    HTTPStatus.FORBIDDEN, "open the whole address that clamber view has printed\n"
                )
            response = None if process_request is None else process_request(connection, request)
            if response is not None:
                guard.answer(request.path, response)
            return response

        return serve(*words, process_request=process, **options)

    with patch.object(server, "serve", serve_guarded):
        yield


def check_guarded(host: str, port: int, guard: Guard) -> None:
    """Make sure that a server answers who has its token, and refuses all others.

    Args:
        host: Where it listens.
        port: Where it listens.
        guard: Its guard.

    Raises:
        UnguardedError: If it does not.
    """
    near = {"0.0.0.0": "127.0.0.1", "::": "::1"}.get(host, host)
    named = f"[{near}]:{port}" if ":" in near else f"{near}:{port}"
    socket_words = [
        "Upgrade: websocket",
        "Connection: Upgrade",
        "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==",
        "Sec-WebSocket-Version: 13",
    ]
    foreign = [*socket_words, "Origin: http://example.invalid"]
    own = f"/?token={guard.token}"
    for path, words, status, what in (
        ("/", [], 403, "its page is answered without a token"),
        ("/", [*socket_words, f"Origin: http://{named}"], 403, "its websocket is answered without a token"),
        (own, socket_words, 403, "its websocket is answered without an origin"),
        (own, foreign, 403, "its websocket is answered to a page of others"),
        (own, [], 200, "its page is not answered with its token"),
    ):
        try:
            with socket.create_connection((near, port), timeout=PATIENCE) as line:
                line.sendall("\r\n".join([f"GET {path} HTTP/1.1", f"Host: {named}", *words, "", ""]).encode())
                answer = line.recv(1000)
        except OSError as error:
            raise UnguardedError(f"its server does not answer ({error.strerror or error})") from None
        if not answer.startswith(f"HTTP/1.1 {status} ".encode()):
            raise UnguardedError(what)

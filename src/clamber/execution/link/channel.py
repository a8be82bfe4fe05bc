"""One end of a link: addresses on this machine, sockets, whole messages in and out."""

import os
import re
import select
import socket
import stat
import time
from collections import deque
from dataclasses import dataclass
from typing import Final, Literal

from ...errors import StatedError
from .messages import Inbox, Kind, Message, frame

PIECE: Final = 65536
"""Most bytes read at once."""
LONGEST_PATH: Final = 100
"""Of a Unix domain socket: some systems take 104 bytes with its end."""
_TCP: Final = re.compile(r"tcp://(127\.\d{1,3}\.\d{1,3}\.\d{1,3}|localhost):(\d{1,5})")
ALLOWED: Final = "state tcp://127.0.0.1:PORT or unix:PATH; plants are driven on their own machine only"


class LinkError(StatedError):
    """There is no link to a plant at an address, or none can be made there."""

    says = "plant at {address}: {problem}; {allowed}"
    address: str
    problem: str
    allowed: str


class ConnectionEndedError(Exception):
    """The other end is gone."""


@dataclass(frozen=True, slots=True)
class Address:
    """Where a plant is served on this machine."""

    kind: Literal["tcp", "unix"]
    host: str
    """Of TCP, a loopback address; else the socket's path."""
    port: int = 0
    """0: any that is free."""

    def __str__(self) -> str:
        return f"tcp://{self.host}:{self.port}" if self.kind == "tcp" else f"unix:{self.host}"


def read_address(text: str) -> Address:
    """An address such as tcp://127.0.0.1:4000 or unix:/run/robot.

    Raises:
        LinkError: If it is none, or none of this machine.
    """
    if text.startswith("unix:") and len(text) > len("unix:"):
        path = text.removeprefix("unix:")
        if len(os.fsencode(path)) > LONGEST_PATH or "\0" in path:
            raise LinkError(text, "its path is too long", f"take at most {LONGEST_PATH} bytes")
        return Address("unix", path)
    match = _TCP.fullmatch(text)
    if match is None or not int(match[2]) < 2**16 or max(map(int, re.findall(r"\d+", match[1])), default=0) > 255:
        raise LinkError(text, "is no address of a plant", ALLOWED)
    return Address("tcp", "127.0.0.1" if match[1] == "localhost" else match[1], int(match[2]))


def listen(address: Address) -> tuple[socket.socket, Address]:
    """A socket that clients may connect to, and its address, with the port that it got.

    Raises:
        LinkError: If it cannot be had.
    """
    try:
        if address.kind == "tcp":
            server = socket.create_server((address.host, address.port), backlog=4)
            return server, Address("tcp", address.host, server.getsockname()[1])
        server = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)
        before = os.umask(0o177)  # nobody but the user may connect
        try:
            server.bind(address.host)
        finally:
            os.umask(before)
        server.listen(4)
    except OSError as error:
        raise LinkError(
            str(address),
            f"cannot listen there ({error.strerror or error})",
            "take another, or remove what a killed server left",
        ) from None
    return server, address


def address_of(listener: socket.socket) -> Address:
    """Where a socket of `listen` listens."""
    if listener.family == socket.AF_INET:
        return Address("tcp", *listener.getsockname())
    return Address("unix", listener.getsockname())


def unlink(address: Address) -> None:
    """Remove the file of a Unix domain socket that `listen` made."""
    if address.kind == "unix" and os.path.exists(address.host) and stat.S_ISSOCK(os.stat(address.host).st_mode):
        os.unlink(address.host)


def connect(address: Address, timeout: float) -> "Channel":
    """A channel to whoever listens.

    Raises:
        LinkError: If nobody does.
    """
    try:
        if address.kind == "tcp":
            made = socket.create_connection((address.host, address.port), timeout=timeout)
        else:
            made = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)
            made.settimeout(timeout)
            made.connect(address.host)
    except OSError as error:
        why = error.strerror or str(error)
        raise LinkError(str(address), f"nothing answers there ({why})", "start it with `clamber plant serve`") from None
    return Channel(made)


class Channel:
    """Whole messages over a connected socket."""

    def __init__(self, made: socket.socket) -> None:
        made.setblocking(False)
        if made.family == socket.AF_INET:
            made.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        self.socket = made
        self._inbox, self._waiting = Inbox(), deque[Message]()
        self.sent = 0
        """Number of the last message that was sent."""

    @property
    def partial(self) -> bool:
        """Whether a message has begun to come and not ended."""
        return self._inbox.partial

    def send(self, kind: Kind, payload: bytes = b"", timeout: float = 1.0) -> None:
        """Send a message.

        Raises:
            ConnectionEndedError: If the other end is gone, or takes nothing in for so long [s].
        """
        self.sent += 1
        raw = memoryview(frame(kind, self.sent, payload))
        until = time.monotonic() + timeout
        while raw:
            try:
                raw = raw[self.socket.send(raw) :]
            except BlockingIOError:
                left = until - time.monotonic()
                if left <= 0.0 or not select.select([], [self.socket], [], left)[1]:
                    raise ConnectionEndedError("it takes nothing in") from None
            except OSError as error:
                raise ConnectionEndedError(error.strerror or str(error)) from None

    def read(self) -> list[Message]:
        """All messages that are there, without waiting.

        Raises:
            ConnectionEndedError: If the other end is gone and has said nothing more.
            MessageError: If it says what is no message.
        """
        found = list(self._waiting)
        self._waiting.clear()
        try:
            piece = self.socket.recv(PIECE)
        except BlockingIOError:
            return found
        except OSError as error:
            raise ConnectionEndedError(error.strerror or str(error)) from None
        if not piece:
            if found:
                return found
            raise ConnectionEndedError("in the middle of a message" if self._inbox.partial else "it has hung up")
        return found + self._inbox.feed(piece)

    def wait(self, timeout: float) -> Message:
        """The next message.

        Raises:
            ConnectionEndedError: If the other end is gone, or says nothing for so long [s].
            MessageError: If it says what is no message.
        """
        until = time.monotonic() + timeout
        while not self._waiting:
            left = until - time.monotonic()
            if left <= 0.0 or not select.select([self.socket], [], [], left)[0]:
                raise ConnectionEndedError(f"it has said nothing for {timeout:g} s")
            self._waiting.extend(self.read())
        return self._waiting.popleft()

    def hang_up(self) -> None:
        """Close the socket."""
        self.socket.close()

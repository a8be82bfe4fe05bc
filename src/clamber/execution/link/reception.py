"""Connections that do not drive a plant: those that have said nothing yet, and those that are let go."""

import contextlib
import socket
import struct
from collections.abc import Callable, Iterator
from typing import Final

from .channel import PIECE, Channel, ConnectionEndedError
from .messages import Kind, Message, MessageError, pack_refusal

PATIENCE: Final = 2.0
"""For a client's first message, and for the rest of one that has begun [s]."""
MOST_WAITING: Final = 8
"""Connections that may wait with their first word, and that may be hanging up, at once; the eldest goes first. Knocking often must not use
up what the system lets a process open."""
Now = Callable[[], float]


class Reception:
    """Takes connections in, hears their first message, and sees them out.

    Args:
        listener: Where they come.
        now: Time [s].
    """

    def __init__(self, listener: socket.socket, now: Now) -> None:
        listener.setblocking(False)
        self._listener, self._now = listener, now
        self._waiting: list[tuple[Channel, float]] = []
        """Those that have said nothing, and until when they may."""
        self._leaving: list[tuple[Channel, float]] = []
        """Those that have been let go, and until when."""

    @property
    def busy(self) -> bool:
        """Whether there is anyone that has only so long."""
        return bool(self._waiting or self._leaving)

    def sockets(self) -> list[socket.socket]:
        """All that may be read from."""
        return [self._listener, *(channel.socket for channel, _ in (*self._waiting, *self._leaving))]

    def first_words(self, ready: list[socket.socket]) -> Iterator[tuple[Channel, list[Message]]]:
        """Channels that have said something for the first time, with what they said; they no longer wait.

        Args:
            ready: Sockets that can be read.
        """
        self._sweep(ready)
        if self._listener in ready:
            self._take_in()
        for entry in list(self._waiting):
            channel, until = entry
            try:
                said = channel.read() if channel.socket in ready else []
            except ConnectionEndedError:
                self._waiting.remove(entry)
                channel.hang_up()
                continue
            except MessageError as error:
                self._waiting.remove(entry)
                self.refuse(channel, str(error))
                self.dismiss(channel)
                continue
            if said:
                self._waiting.remove(entry)
                yield channel, said
            elif self._now() > until:
                self._waiting.remove(entry)
                self.refuse(channel, f"the first message is missing; must come within {PATIENCE:g} s")
                self.dismiss(channel)

    def _take_in(self) -> None:
        try:
            channel = Channel(self._listener.accept()[0])
        except OSError:  # whoever knocked is gone
            return
        self._waiting.append((channel, self._now() + PATIENCE))
        if len(self._waiting) > MOST_WAITING:
            self.dismiss(self._waiting.pop(0)[0])

    def refuse(self, channel: Channel, why: str) -> None:
        """Say why."""
        with contextlib.suppress(ConnectionEndedError):
            channel.send(Kind.REFUSAL, pack_refusal(why), timeout=0.0)

    def dismiss(self, channel: Channel) -> None:
        """Hang up, but not before the client has: else the system throws away what it has not read yet, such as why."""
        with contextlib.suppress(OSError):
            channel.socket.shutdown(socket.SHUT_WR)
        self._leaving.append((channel, self._now() + PATIENCE))
        if len(self._leaving) > MOST_WAITING:
            self._leaving.pop(0)[0].hang_up()

    def _sweep(self, ready: list[socket.socket]) -> None:
        """Let those go that have hung up, or do not."""
        for entry in list(self._leaving):
            channel, until = entry
            gone = self._now() > until
            try:
                gone = gone or (channel.socket in ready and not channel.socket.recv(PIECE))
            except OSError:
                gone = True
            if gone:
                self._leaving.remove(entry)
                channel.hang_up()

    def close(self) -> None:
        """Hang up on all, and take nobody in any more."""
        self._listener.close()
        for channel, _ in (*self._waiting, *self._leaving):
            channel.hang_up()


def peer_of(channel: Channel) -> str:
    """Who is at the other end: an address of TCP, or the process at a Unix domain socket where the system tells."""
    try:
        if channel.socket.family == socket.AF_INET:
            host, port = channel.socket.getpeername()
            return f"{host}:{port}"
        credentials = channel.socket.getsockopt(socket.SOL_SOCKET, socket.SO_PEERCRED, struct.calcsize("3i"))
        return f"process {struct.unpack('3i', credentials)[0]}"
    except (OSError, AttributeError):  # it is gone, or another system
        return "somebody"

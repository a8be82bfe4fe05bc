"""A robot of two joints that needs no simulator, for tests of its server: double integrators that count."""

import contextlib
import select
import socket
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np

from clamber.execution.hardware import Reading
from clamber.execution.link.channel import Channel, ConnectionEndedError
from clamber.execution.link.envelope import Envelope, JointLimits
from clamber.execution.link.messages import About, Kind, Message, Sample, pack_numbers, unpack_about, unpack_sample
from clamber.execution.link.server import PlantServer
from clamber.execution.posture_guard import PostureGuard
from clamber.execution.wiring import Wiring
from clamber.types import Floats

PERIOD = 0.005
WIRING = Wiring(np.array((1e4, 1e4, 1e3)), np.ones(2), np.full(2, 10.0))
INERTIA = np.array((0.4, 0.8))
LIMITS = JointLimits(
    names=("first joint", "second joint"), lower=np.full(2, -2.0), upper=np.full(2, 2.0), speeds=np.full(2, 4.0),
    continuous=np.array((4.0, 8.0)), thermal_time=2.0,
)  # fmt: skip


def envelope() -> Envelope:
    return Envelope(WIRING, LIMITS, PERIOD)


class ToyRobot:
    """Two joints with inertia and a steady load on each, and a body angle that never turns; knows the truth of both angles."""

    period = PERIOD

    def __init__(self, load: float = 0.0, lose_time: Callable[[], None] = lambda: None) -> None:
        self.load, self.commands, self.lose_time = load, list[Floats](), lose_time
        self.q, self.qd, self._volts, self._tick = np.zeros(2), np.zeros(2), np.zeros(2), 0

    def reset(self, start: Floats) -> None:
        self.q, self.qd, self._tick = start.copy(), np.zeros(2), 0

    def sense(self) -> Reading:
        return Reading(WIRING.counts(np.append(self.q, 0.0)), self._tick)

    def actuate(self, volts: Floats) -> None:
        self._volts = volts.copy()
        self.commands.append(self._volts)

    def pause(self) -> None:
        pass

    def step(self) -> None:
        self.lose_time()
        for _ in range(5):
            self.qd += (WIRING.torques(self._volts) - self.load) / INERTIA * PERIOD / 5
            self.q = self.q + self.qd * PERIOD / 5
        self._tick += 1

    def truth(self) -> Floats:
        return self.q.copy()


def about(*, real_time: bool, pace: float = 1.0) -> About:
    return About("toy", "table", 2, 3, 2, 2, real_time, PERIOD, pace)


class OverError(Exception):
    """The script of a test has come to its end."""


class ScriptedClock:
    """Time that passes only where a test's script says so, once the server has nothing left to read.

    Args:
        script: Does what it likes to its end of the link, then yields how long nothing happens [s].
    """

    def __init__(self, script: Iterator[float]) -> None:
        self._script, self._time = script, 100.0
        self._quiet_until = self._time

    def now(self) -> float:
        return self._time

    def lose(self, seconds: float) -> None:
        """Time passes while the server is at something else."""
        self._time += seconds

    def select(self, sockets: list[socket.socket], timeout: float | None) -> list[socket.socket]:
        ready = select.select(sockets, [], [], 0.0)[0]
        if ready:
            return ready
        if self._quiet_until <= self._time:
            try:
                self._quiet_until = self._time + next(self._script)
            except StopIteration:
                raise OverError from None
            return select.select(sockets, [], [], 0.0)[0]
        wished = self._quiet_until if timeout is None else min(self._time + timeout, self._quiet_until)
        self._time = max(wished, self._time)
        return []


class Driver:
    """A client that a script drives by hand."""

    def __init__(self, address: tuple[str, int]) -> None:
        self.channel = Channel(socket.create_connection(address))
        self.samples: list[Sample] = []
        self.others: list[Message] = []
        self.gone = False

    def say(self, kind: Kind, numbers: Any = ()) -> None:
        self.channel.send(kind, pack_numbers(np.asarray(numbers, np.float64)))

    def look(self) -> None:
        """Take in what has come."""
        try:
            for message in self.channel.read():
                if message.kind is Kind.SAMPLE:
                    self.samples.append(unpack_sample(message.payload, about(real_time=False)))
                else:
                    self.others.append(message)
        except ConnectionEndedError:
            self.gone = True

    def welcomed(self) -> About:
        return unpack_about(self.others[0].payload)


def play(
    script: Callable[[tuple[str, int]], Iterator[float]], *, real_time: bool, load: float = 0.0, once: bool = False,
    lost: float = 0.0, say: Callable[[str], None] | None = None,
) -> tuple[PlantServer, ToyRobot, list[str]]:  # fmt: skip
    """Serve a toy robot while a script runs, in one thread and in no time; each of its steps loses so much of the clock's [s]."""
    listener = socket.create_server(("127.0.0.1", 0), backlog=200)
    clock, told = ScriptedClock(script(listener.getsockname())), list[str]()
    robot = ToyRobot(load, lambda: clock.lose(lost))
    server = PlantServer(
        robot, about(real_time=real_time), PostureGuard(WIRING, INERTIA, PERIOD), envelope(), listener, say=say or told.append,
        once=once, clock=clock,
    )  # fmt: skip
    with contextlib.suppress(OverError):
        server.serve()
    return server, robot, told

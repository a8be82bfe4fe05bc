"""`clamber plant`: a robot lent to another process."""

import signal
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass
from types import FrameType
from typing import TYPE_CHECKING, Annotated, Any, Self

import typer

from ....terminal.name_completion import names_of
from ....terminal.options import AsJson, NoiseTexts, Overrides, Quiet, takes_options
from ....terminal.output import print_json, stderr

if TYPE_CHECKING:
    import socket

    from ....execution.link.channel import Address
    from ....execution.link.server import PlantServer
    from ..planning.task import LimbedTask

plant = typer.Typer(no_args_is_help=True, help="A robot in its own process, driven over a local socket.")


@dataclass(frozen=True, slots=True)
class ServeOptions:
    """Options of `clamber plant serve`, as they came."""

    port: Annotated[int, typer.Option(min=0, max=65535, help="On 127.0.0.1; 0: any that is free.")] = 0
    socket: Annotated[
        str | None, typer.Option(metavar="PATH", help="A Unix domain socket in place of a port; only you may connect.")
    ] = None
    real_time: Annotated[
        bool,
        typer.Option("--real-time", help="Keep time by the clock, and stop safely after two ticks without command."),
    ] = False
    pace: Annotated[
        float, typer.Option(min=0.001, max=100.0, help="Of real time: seconds of the plant for each of the clock.")
    ] = 1.0
    once: Annotated[bool, typer.Option("--once", help="End when the first client has gone; 1 after a safe stop.")] = (
        False
    )
    overrides: Overrides = None
    noise: NoiseTexts = None
    seed: Annotated[int, typer.Option(min=0, help="Of the noise.")] = 0
    dac_bits: Annotated[
        int, typer.Option(min=0, max=24, help="Of the converters before the amplifiers; 0: as fine as a float.")
    ] = 0
    as_json: AsJson = False
    quiet: Quiet = False

    def check(self) -> None:
        """Make sure that they go together."""
        if self.pace != 1.0 and not self.real_time:
            raise typer.BadParameter("is for --real-time", param_hint="--pace")
        if self.socket is not None and self.port:
            raise typer.BadParameter("goes without --port", param_hint="--socket")

    def wished(self) -> "Address":
        """Where it is to listen."""
        from ....execution.link.channel import Address, read_address

        return Address("tcp", "127.0.0.1", self.port) if self.socket is None else read_address(f"unix:{self.socket}")

    def say(self, told: str) -> None:
        """Tell how it goes, unless nothing is to be told."""
        if not self.quiet:
            with suppress(
                OSError, SystemExit
            ):  # who reads it is gone, on which rich would leave; a robot is held all the same
                stderr().print(told, soft_wrap=True)


@dataclass(frozen=True, slots=True)
class ServedPlant:
    """Printed once the server listens."""

    address: str
    """For `clamber run --plant`."""
    robot: str
    board: str
    real_time: bool


@dataclass(frozen=True, slots=True)
class PlantAnswer:
    """Printed by who has stopped a served robot, or given it back."""

    address: str
    """Of its server."""
    said: str
    """What the server has done."""


@plant.command()
@takes_options
def serve(
    task: Annotated[
        str,
        typer.Argument(metavar="TASK", help="Whose robot is served, on whose board.", autocompletion=names_of("tasks")),
    ],
    *,
    words: ServeOptions,
) -> None:
    """Serve a task's simulated robot to one client at a time: volts in, counts out, 200 times a second (docs/hardware.md).

    `clamber run TASK --plant ADDRESS` climbs through it, `clamber plant stop ADDRESS` stops it. The address is the one line on stdout, with
    --json one value. Ctrl-C, SIGTERM and SIGHUP stop the robot safely and hold it for 2 s first (exit codes 130, 143, 129).
    """
    from ....execution.link.channel import listen, unlink
    from ....tasks import load_task
    from ....trials.work import split_settings
    from ..trials.run_plan import climbing_task

    words.check()
    for_task, for_plant = split_settings(words.overrides or ())
    chosen = climbing_task(load_task(task, for_task))
    make = _server_of(chosen, for_plant, words)
    listener, address = listen(words.wished())
    with EndBySignal() as end:
        try:
            server = make(listener)
            end.ask = server.ask_to_end
            _announce(chosen, address, words)
            server.serve()
        except KeyboardInterrupt:
            pass
        finally:
            listener.close()
            unlink(address)
        if end.number is not None:
            words.say(f"the server ends ({signal.Signals(end.number).name}): nothing holds the robot any more")
            raise typer.Exit(128 + end.number)
    raise typer.Exit(1 if server.stops else 0)


def _server_of(
    chosen: "LimbedTask", for_plant: list[str], words: ServeOptions
) -> "Callable[[socket.socket], PlantServer]":
    """What serves the task's robot at a listener, drawn before anyone can connect."""
    from ..trials.noise import Noise, check_noise, draw_for
    from ..trials.plants import climb_server, drawn_plant
    from ..trials.run_plan import climbing_flaws

    flaws = climbing_flaws(chosen, for_plant)
    deviations = Noise.of("none", words.noise or ())
    check_noise(deviations, chosen.robot, flaws)
    moved = drawn_plant(chosen, flaws, draw_for(chosen, deviations, words.seed))

    def serve_at(listener: "socket.socket") -> "PlantServer":
        return climb_server(
            chosen,
            moved,
            listener,
            say=words.say,
            real_time=words.real_time,
            pace=words.pace,
            once=words.once,
            dac_bits=words.dac_bits,
        )

    return serve_at


def _announce(chosen: "LimbedTask", address: "Address", words: ServeOptions) -> None:
    robot, board = chosen.robot.name, chosen.world.name
    if words.as_json:
        print_json(ServedPlant(str(address), robot, board, words.real_time))
    else:
        print(address, flush=True)
    words.say(f"'{robot}' on '{board}', {'in real time' if words.real_time else 'in lock-step'}; Ctrl-C ends")


class EndBySignal:
    """Has signals end a server: the first asks it to, and the next does not wait for it."""

    def __init__(self) -> None:
        self.ask: Callable[[str], None] | None = None
        """Tells the server why it is to end; None: there is none yet."""
        self.number: int | None = None
        """The first signal."""
        self._before: dict[int, Any] = {}

    def __enter__(self) -> Self:
        for name in ("SIGINT", "SIGTERM", "SIGHUP"):
            if hasattr(signal, name):
                number = int(getattr(signal, name))
                self._before[number] = signal.signal(number, self._caught)
        return self

    def __exit__(self, *_: object) -> None:
        for number, before in self._before.items():
            signal.signal(number, before)

    def _caught(self, number: int, _: FrameType | None) -> None:
        first, self.number = self.number is None, self.number or number
        if not first or self.ask is None:
            raise KeyboardInterrupt
        self.ask(signal.Signals(number).name)


Served = Annotated[str, typer.Argument(metavar="ADDRESS", help="Of its server, such as tcp://127.0.0.1:40917.")]


@plant.command()
def stop(address: Served, as_json: AsJson = False) -> None:
    """Stop a served robot safely, whoever drives it: its posture is held, and nobody may start before `clamber plant release`.

    Only the user that serves it may.
    """
    _ask_server(address, release=False, as_json=as_json)


@plant.command()
def release(address: Served, as_json: AsJson = False) -> None:
    """Give a robot back that `clamber plant stop` has stopped: a client may start again."""
    _ask_server(address, release=True, as_json=as_json)


def _ask_server(address: str, *, release: bool, as_json: bool) -> None:
    from ....execution.link.channel import read_address
    from ....execution.link.client import stop_plant

    said = stop_plant(read_address(address), release=release)
    if as_json:
        print_json(PlantAnswer(address, said))
    else:
        print(said)

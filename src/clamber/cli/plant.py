"""`clamber plant`: a robot lent to another process."""

import signal
from collections.abc import Callable
from dataclasses import dataclass
from types import FrameType
from typing import TYPE_CHECKING, Annotated, NoReturn

import typer

from .name_completion import names_of
from .option_holder import takes_words
from .options import AsJson, NoiseTexts, Overrides, Quiet
from .output import print_json, stderr

if TYPE_CHECKING:
    import socket

    from ..execution.link.channel import Address
    from ..execution.link.server import PlantServer
    from ..tasks.limbed import LimbedTask

plant = typer.Typer(no_args_is_help=True, help="A robot in its own process, driven over a local socket.")


@dataclass(frozen=True, slots=True)
class ServeWords:
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
        from ..execution.link.channel import Address, read_address

        return Address("tcp", "127.0.0.1", self.port) if self.socket is None else read_address(f"unix:{self.socket}")

    def say(self, told: str) -> None:
        """Tell how it goes, unless nothing is to be told."""
        if not self.quiet:
            stderr().print(told, soft_wrap=True)


@plant.command()
@takes_words
def serve(
    task: Annotated[
        str,
        typer.Argument(metavar="TASK", help="Whose robot is served, on whose board.", autocompletion=names_of("tasks")),
    ],
    *,
    words: ServeWords,
) -> None:
    """Serve a task's simulated robot to one client at a time: volts in, counts out, 200 times a second (docs/hardware.md).

    `clamber run TASK --plant ADDRESS` climbs through it. The address is the one line on stdout, with --json one value.
    """
    from ..execution.link.channel import listen, unlink
    from ..experiments.climb.run_plan import climbing_task
    from ..experiments.plant_settings import split_settings
    from ..tasks import load_task

    words.check()
    for_task, for_plant = split_settings(words.overrides or ())
    chosen = climbing_task(load_task(task, for_task))
    make = _server_of(chosen, for_plant, words)
    before = signal.signal(signal.SIGTERM, _interrupt)
    listener, address = listen(words.wished())
    try:
        server = make(listener)
        _announce(chosen, address, words)
        server.serve()
    except KeyboardInterrupt:
        words.say("the server ends: nothing holds the robot any more")
        raise typer.Exit(130) from None
    finally:
        listener.close()
        unlink(address)
        signal.signal(signal.SIGTERM, before)
    raise typer.Exit(1 if server.stops else 0)


def _server_of(
    chosen: "LimbedTask", for_plant: list[str], words: ServeWords
) -> "Callable[[socket.socket], PlantServer]":
    """What serves the task's robot at a listener, drawn before anyone can connect."""
    from ..experiments.climb.noise import NO_NOISE, check_noise, draw_for, read_noise
    from ..experiments.climb.plants import climb_server, drawn_plant
    from ..experiments.climb.run_plan import climbing_flaws

    flaws = climbing_flaws(chosen, for_plant)
    deviations = read_noise(NO_NOISE, words.noise or ())
    check_noise(deviations, chosen.robot, flaws)
    moved = drawn_plant(chosen, flaws, draw_for(chosen, deviations, words.seed))

    def serve_at(listener: "socket.socket") -> "PlantServer":
        return climb_server(
            chosen, moved, listener, say=words.say, real_time=words.real_time, pace=words.pace, once=words.once,
            dac_bits=words.dac_bits,
        )  # fmt: skip

    return serve_at


def _announce(chosen: "LimbedTask", address: "Address", words: ServeWords) -> None:
    robot, board = chosen.robot.name, chosen.world.name
    if words.as_json:
        print_json({"address": str(address), "robot": robot, "board": board, "real_time": words.real_time})
    else:
        print(address, flush=True)
    words.say(f"'{robot}' on '{board}', {'in real time' if words.real_time else 'in lock-step'}; Ctrl-C ends")


def _interrupt(number: int, where: FrameType | None) -> NoReturn:
    raise KeyboardInterrupt

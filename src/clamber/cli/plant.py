"""`clamber plant`: a robot lent to another process."""

import signal
from types import FrameType
from typing import Annotated, NoReturn

import typer

from .name_completion import names_of
from .options import AsJson, NoiseTexts, Overrides, Quiet
from .output import print_json, stderr

plant = typer.Typer(no_args_is_help=True, help="A robot in its own process, driven over a local socket.")


@plant.command()
def serve(
    task: Annotated[
        str,
        typer.Argument(metavar="TASK", help="Whose robot is served, on whose board.", autocompletion=names_of("tasks")),
    ],
    port: Annotated[int, typer.Option(min=0, max=65535, help="On 127.0.0.1; 0: any that is free.")] = 0,
    socket: Annotated[
        str | None, typer.Option(metavar="PATH", help="A Unix domain socket in place of a port; only you may connect.")
    ] = None,
    real_time: Annotated[
        bool,
        typer.Option("--real-time", help="Keep time by the clock, and stop safely after two ticks without command."),
    ] = False,
    pace: Annotated[
        float, typer.Option(min=0.001, max=100.0, help="Of real time: seconds of the plant for each of the clock.")
    ] = 1.0,
    once: Annotated[
        bool, typer.Option("--once", help="End when the first client has gone; 1 after a safe stop.")
    ] = False,
    overrides: Overrides = None,
    noise: NoiseTexts = None,
    seed: Annotated[int, typer.Option(min=0, help="Of the noise.")] = 0,
    dac_bits: Annotated[
        int, typer.Option(min=0, max=24, help="Of the converters before the amplifiers; 0: as fine as a float.")
    ] = 0,
    as_json: AsJson = False,
    quiet: Quiet = False,
) -> None:
    """Serve a task's simulated robot to one client at a time: volts in, counts out, 200 times a second (docs/hardware.md).

    `clamber run TASK --plant ADDRESS` climbs through it. The address is the one line on stdout, with --json one value.
    """
    from ..execution.link.channel import Address, listen, read_address, unlink
    from ..experiments.climb.noise import NO_NOISE, check_noise, draw_for, read_noise
    from ..experiments.climb.plants import climb_server, drawn_plant
    from ..experiments.climb.run_plan import climbing_flaws, climbing_task
    from ..experiments.plant_settings import split_settings
    from ..tasks import load_task

    if pace != 1.0 and not real_time:
        raise typer.BadParameter("is for --real-time", param_hint="--pace")
    if socket is not None and port:
        raise typer.BadParameter("goes without --port", param_hint="--socket")
    for_task, for_plant = split_settings(overrides or ())
    chosen = climbing_task(load_task(task, for_task))
    flaws = climbing_flaws(chosen, for_plant)
    deviations = read_noise(NO_NOISE, noise or ())
    check_noise(deviations, chosen.robot, flaws)
    drawn = draw_for(chosen, deviations, seed)
    wished = Address("tcp", "127.0.0.1", port) if socket is None else read_address(f"unix:{socket}")

    def say(words: str) -> None:
        if not quiet:
            stderr().print(words, soft_wrap=True)

    before = signal.signal(signal.SIGTERM, _interrupt)
    listener, address = listen(wished)
    try:
        server = climb_server(
            chosen,
            drawn_plant(chosen, flaws, drawn),
            listener,
            say=say,
            real_time=real_time,
            pace=pace,
            once=once,
            dac_bits=dac_bits,
        )
        if as_json:
            print_json(
                {
                    "address": str(address), "robot": chosen.robot.name, "board": chosen.world.name,
                    "real_time": real_time,
                }
            )  # fmt: skip
        else:
            print(address, flush=True)
        say(
            f"'{chosen.robot.name}' on '{chosen.world.name}', {'in real time' if real_time else 'in lock-step'}; Ctrl-C ends"
        )
        server.serve()
    except KeyboardInterrupt:
        say("the server ends: nothing holds the robot any more")
        raise typer.Exit(130) from None
    finally:
        listener.close()
        unlink(address)
        signal.signal(signal.SIGTERM, before)
    raise typer.Exit(1 if server.stops else 0)


def _interrupt(number: int, where: FrameType | None) -> NoReturn:
    raise KeyboardInterrupt

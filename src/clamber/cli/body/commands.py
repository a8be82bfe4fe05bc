"""`clamber body`: controls compared on the body of a climber that two limbs hold."""

from typing import Annotated

import typer

from ...terminal.crew import EndsLine
from ...terminal.option_holder import takes_options
from ...terminal.output import announce_compilation, print_json, stderr, stdout
from .options import BodyOptions, run_bench

body = typer.Typer(help="Compare controls of a climber's body that two limbs hold.", no_args_is_help=True)


@body.command("circle")
@takes_options
def circle(
    radius: Annotated[str, typer.Option(help="Such as 5cm.")] = "5cm",
    lap: Annotated[float, typer.Option(help="Time of one lap, in seconds.")] = 6.0,
    laps: Annotated[int, typer.Option(min=1, help="The last one is measured.")] = 2,
    *,
    words: BodyOptions,
) -> None:
    """Let the body's aim run round a circle, the tips fixed to their pegs unless --hooked (thesis, Fig. 4.17)."""
    words.check()
    from ...families.climber.trials.body_scenario import circle as round_circle
    from ...units import read_number

    flaws = words.build_plant()
    size = read_number("radius", radius, "length")
    stand = words.build_stand(fixed=True, below=f"{size} m")
    run_bench(words, stand, round_circle(stand.pose, flaws.period, radius=size, lap=lap, laps=laps), flaws)


@body.command("push-up")
@takes_options
def push_up(
    height: Annotated[str, typer.Option(help="Such as 7.5cm.")] = "7.5cm",
    seconds: Annotated[float, typer.Option(help="In so many seconds.")] = 0.5,
    *,
    words: BodyOptions,
) -> None:
    """Push the body up on its hooks (thesis, Fig. 4.18)."""
    words.check()
    from ...families.climber.trials.body_scenario import push_up as up
    from ...units import read_number

    flaws = words.build_plant()
    stand = words.build_stand()
    way = read_number("height", height, "length")
    run_bench(words, stand, up(stand.pose, flaws.period, height=way, seconds=seconds), flaws)


@body.command("push")
@takes_options
def push(
    force: Annotated[str, typer.Option(metavar="FX,FY", help="At the body's centre.")] = "60N,0N",
    seconds: Annotated[float, typer.Option(help="How long it acts, as half a sine, in seconds.")] = 0.5,
    hanging: Annotated[bool, typer.Option("--hanging", help="One limb holds alone.")] = False,
    trials: Annotated[
        int, typer.Option(min=1, help="More than one: from either side, friction, weight, height and force drawn.")
    ] = 1,
    seed: Annotated[int, typer.Option(min=0, help="Of the first trial.")] = 0,
    *,
    words: BodyOptions,
) -> None:
    """Push the body and let it go: how far it yields, and whether the hooks stay on (thesis, Fig. 4.19)."""
    words.check()
    from ...families.climber.trials.body_scenario import push as pushed
    from ...families.climber.trials.body_trials import push_trials
    from ...units import read_point
    from .text import print_trials

    flaws = words.build_plant()
    stand = words.build_stand(hanging=hanging)
    size = read_point("force", force, "force")
    if trials == 1:
        run_bench(words, stand, pushed(stand.pose, flaws.period, force=size, seconds=seconds), flaws)
    announce_compilation(quiet=words.quiet)
    told = {}
    for entry in words.build_entries(stand):
        line = EndsLine(stderr(), f"pushes, {entry.label}", quiet=words.quiet)
        told[entry.label] = push_trials(
            stand, entry, flaws, force=size, seconds=seconds, trials=trials, seed=seed, progress=line.update
        )
    if words.as_json:
        print_json(told)
    else:
        for label, trial in told.items():
            print_trials(stdout(), label, trial)
    stayed = all(one.measures.unhooked_at is None for trial in told.values() for one in trial)
    raise typer.Exit(0 if stayed else 1)

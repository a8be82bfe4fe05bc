"""`clamber limb sweep`: laws over one or two properties of the plant or of the gains."""

from enum import StrEnum
from typing import Annotated

import typer

from ..crew import CrewWords
from ..option_holder import takes_words
from ..options import ROBOT
from ..output import announce_compilation, print_json, stdout
from . import options as opt


class GainsChoice(StrEnum):
    """Where the gains come from of laws that state none."""

    matched = "matched"
    recommended = "recommended"


class ScenarioChoice(StrEnum):
    """What is asked of the limb."""

    step = "step"
    circle = "circle"
    push = "push"


@takes_words
def sweep(
    vary: Annotated[
        list[str],
        typer.Option(
            metavar="KEY=LOW..HIGH:N",
            help="A property of the plant, or kp, kd (of the reference), gain (a factor on all), such as backlash=0deg..4deg:9.",
        ),
    ],
    scenario: Annotated[ScenarioChoice, typer.Option(help="The command.")] = ScenarioChoice.circle,
    measure: Annotated[
        str | None, typer.Option(help="What is compared, such as radial_rms or encoder.across_max.")
    ] = None,
    by: Annotated[str, typer.Option(metavar="DX,DY", help="The step.")] = "0,-2cm",
    radius: Annotated[str, typer.Option(help="Of the circle, about (22cm, 0).")] = "5cm",
    lap: Annotated[float, typer.Option(help="Time of one lap of the circle [s].")] = 3.0,
    force: Annotated[str, typer.Option(metavar="FX,FY", help="The push.")] = "10N,0",
    controllers: opt.Controllers = None,
    gains: Annotated[
        GainsChoice,
        typer.Option(help="Of laws without gains of their own: --match to the reference, or as `limb tune` found."),
    ] = GainsChoice.matched,
    kp: opt.Kp = None,
    kd: opt.Kd = None,
    match: opt.Matched = opt.MatchChoice.yy,
    reference: opt.Reference = "scct",
    robot: opt.Robot = ROBOT,
    limb: opt.LimbName = None,
    start: opt.Start = None,
    elbow: opt.Elbow = None,
    flaws: opt.Flaws = opt.FlawsChoice.nominal,
    settings: opt.Settings = None,
    *,
    words: CrewWords,
) -> None:
    """Run laws at every point of a range: which is best where, and from where on each is unstable."""
    words.check()
    if words.output is not None:
        from ...viewing.output import CANVASES, check_suffix

        check_suffix(words.output, (".csv", *CANVASES))
    from ...limb_bench.limb_sweep import make_bench, run_limb_sweep
    from ...planning.axes import range_axis
    from .sweep_text import print_limb_sweep, write_limb_sweep

    axes = [range_axis(text) for text in vary]
    bench = make_bench(
        kind=scenario.value, measure=measure, by=by, radius=radius, lap=lap, force=force, laws=controllers or (),
        kp=kp, kd=kd, match=match.value, reference=reference, robot=robot, limb=limb, start=start, elbow=elbow,
        flaws=flaws.value, settings=settings or (), recommended=gains is GainsChoice.recommended,
    )  # fmt: skip
    announce_compilation(quiet=words.quiet)
    result = run_limb_sweep(
        bench, axes, executor=words.executor, store=words.store, resume=words.resume,
        progress=words.line("points").update,
    )  # fmt: skip
    if words.output is not None:
        write_limb_sweep(result, words.output)
    if words.as_json:
        print_json(result.to_json())
    else:
        print_limb_sweep(stdout(), result, words.output)
    raise typer.Exit(0 if any(result.wins().values()) else 1)

"""`clamber limb tune`: the largest stable gains of laws on a limb, and recommended ones a margin below."""

from pathlib import Path
from typing import Annotated

import typer

from ..crew import CrewWords
from ..name_completion import names_of
from ..option_holder import takes_words
from ..options import ROBOT
from ..output import announce_compilation, check_writable, print_json, stdout
from . import options as opt


@takes_words
def tune(
    controllers: Annotated[
        list[str] | None,
        typer.Argument(
            metavar="[NAME[:KEY=VALUE,...]]...",
            help="Laws without their gains; all of them unless given.",
            autocompletion=names_of("controllers"),
        ),
    ] = None,
    margin: Annotated[float, typer.Option(help="Largest stable gains over the recommended ones; 2 is 6 dB.")] = 2.0,
    robot: opt.Robot = ROBOT,
    limb: opt.LimbName = None,
    start: opt.Start = None,
    elbow: opt.Elbow = None,
    flaws: opt.Flaws = opt.FlawsChoice.nominal,
    settings: opt.Settings = None,
    save: Annotated[
        Path | None,
        typer.Option(metavar="FILE", help="Put the recommended gains into this TOML file; others in it stay."),
    ] = None,
    *,
    words: CrewWords,
) -> None:
    """Find the largest gains at which the limb comes to rest after steps, circles and pushes, and recommend some below."""
    words.check()
    check_writable(save)
    if words.output is not None:
        from ...viewing.output import CANVASES, check_suffix

        check_suffix(words.output, CANVASES)
    from ...control.recommended import read_recommended, save_recommended
    from ...limb_bench.bench_limb import bench_limb, limbed_robot
    from ...limb_bench.points import read_elbow, read_point
    from ...limb_bench.tune import tune as find
    from ...regular_files import is_there
    from ...sim.flaw_texts import named_flaws, read_flaws

    if save is not None and is_there(save):
        read_recommended(save)
    plant = read_flaws(named_flaws(flaws.value, limbed_robot(robot)), settings or ())
    at = (0.22, 0.0) if start is None else read_point("start", start)
    chosen = bench_limb(robot, limb, at, elbow=read_elbow(elbow), upright=plant.upright)
    laws = [] if controllers in (None, ["all"]) else list(controllers or ())
    announce_compilation(quiet=words.quiet)
    result = find(
        chosen, laws, plant, robot=robot, margin=margin, executor=words.executor, store=words.store, resume=words.resume,
        progress=words.line("searches").update,
    )  # fmt: skip
    if save is not None:
        save_recommended(result.recommended(), save)
    if words.output is not None:
        from ...limb_bench.pictures.limb_tune_plot import draw_tuning

        draw_tuning(result, words.output)
    if words.as_json:
        print_json(result.to_json())
    else:
        from .tune_text import print_tuning

        print_tuning(stdout(), result, save, words.output)
    raise typer.Exit(0 if result.steady else 1)

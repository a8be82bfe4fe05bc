"""`clamber limb tune`: the largest stable gains of laws on a limb, and recommended ones a margin below."""

import math
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer
from rich.console import Console

from ...terminal.crew import CrewWords
from ...terminal.name_completion import names_of
from ...terminal.option_holder import takes_options
from ...terminal.output import announce_compilation, check_writable
from . import options as opt

if TYPE_CHECKING:
    from ...limb_bench.tune import Tuning

HEADS = {
    "kp": "kp", "kd": "kd", "limit": "limit\nkp", "linear": "of\nlinear", "kxx": "Kxx\nN/mm", "kyy": "Kyy\nN/mm",
    "cycle": "p-p\nmm", "over": "over\n%", "iae": "IAE\nmm s",
}  # fmt: skip


@takes_options
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
    save: Annotated[
        Path | None,
        typer.Option(metavar="FILE", help="Put the recommended gains into this TOML file; others in it stay."),
    ] = None,
    *,
    limb: opt.NominalLimbWords,
    words: CrewWords,
) -> None:
    """Find the largest gains at which the limb comes to rest after steps, circles and pushes, and recommend some below."""
    words.check()
    check_writable(save)
    opt.check_output(words.output)
    from ...control.recommended import read_recommended, save_recommended
    from ...limb_bench.tune import tune as find
    from ...regular_files import is_there

    if save is not None and is_there(save):
        read_recommended(save)
    plant = limb.build_plant()
    chosen = limb.build_limb(plant)
    laws = [] if controllers in (None, ["all"]) else list(controllers or ())
    announce_compilation(quiet=words.quiet)
    result = find(chosen, laws, plant, robot=limb.robot, margin=margin, crew=opt.crew_of(words, "searches"))
    if save is not None:
        save_recommended(result.recommended(), save)
    opt.tell_batch(result, words, lambda console: print_tuning(console, result), save)
    raise typer.Exit(0 if result.steady else 1)


def print_tuning(console: Console, result: "Tuning") -> None:
    """Print what was found."""
    from ...families.climber.sim.flaw_texts import plant_words
    from ...limb_bench.steadiness import QUIET_FROM, STEADY

    limb = result.limb
    console.print(f"recommended gains, {limb.robot.name}'s {limb.name} limb", style="bold")
    console.print(f"plant: {plant_words(result.flaws)}")
    console.print(
        f"margin: the limb comes to rest, within {1e3 * STEADY:g} mm after {QUIET_FROM:g} s, up to {result.margin:g} times the gains"
    )
    console.print()
    rows = [
        (
            law.law,
            f"{law.kp:.4g}",
            f"{law.kd:.3g}",
            f"{law.limit_kp:.4g}",
            f"{law.limit_kp / law.linear_kp:.2f}",
            *(f"{value / 1e3:.1f}" for value in law.stiffness),
            f"{1e3 * law.peak_to_peak:.2f}" if math.isfinite(law.peak_to_peak) else "lost",
            f"{100 * law.overshoot:.0f}",
            f"{1e3 * law.iae:.2f}",
        )
        for law in result.laws
    ]
    opt.show_table(console, ("law", *HEADS.values()), rows)
    console.print()
    console.print(
        "kp, kd: N m/rad, N m s/rad; of jacobian-transpose N/m, N s/m;\n        of operational-space 1/s^2, 1/s"
    )
    console.print("of linear: limit kp over that of the linear loop; K: of the tip at the start")
    console.print(
        "p-p: true tip at rest, worst run; over: worst step of 2 cm, by encoders;\nIAE: of a step of 2 cm in -y"
    )
    for law in result.laws:
        if not law.steady:
            console.print(f"{law.law}: does not come to rest at these gains: {law.situation}", soft_wrap=True)

"""`clamber limb step`: the aim jumps; every law follows."""

from typing import Annotated

import typer

from ..option_holder import takes_words
from .options import BenchWords, run_bench


@takes_words
def step(
    by: Annotated[str, typer.Option(metavar="DX,DY", help="The step, such as 0,-2cm.")] = "0,-2cm",
    seconds: Annotated[float, typer.Option(help="Length of the run [s].")] = 6.0,
    *,
    words: BenchWords,
) -> None:
    """Let the aim jump, and compare how each law gets there: along the step, across it, at rest."""
    words.check()
    from ...limb_bench.points import read_point
    from ...limb_bench.scenario import step_scenario

    properties = words.build_plant()
    chosen = words.build_limb(properties)
    dx, dy = read_point("by", by)
    scenario = step_scenario(chosen, properties.control_rate, dx=dx, dy=dy, seconds=seconds)
    run_bench(words, chosen, scenario, properties)

"""`clamber limb push`: a force on the tip; every law holds against it."""

from typing import Annotated

import typer

from ..option_holder import takes_words
from .options import BenchWords, run_bench


@takes_words
def push(
    force: Annotated[str, typer.Option(metavar="FX,FY", help="On the tip, such as 10N,0.")] = "10N,0",
    begin: Annotated[float, typer.Option("--from", help="When the push begins [s].")] = 0.5,
    end: Annotated[float, typer.Option("--to", help="When it ends [s].")] = 2.0,
    seconds: Annotated[float, typer.Option(help="Length of the run [s].")] = 6.0,
    *,
    words: BenchWords,
) -> None:
    """Push the tip and let it go, and compare how far each law yields, where to, and how it comes back."""
    words.check()
    from ...limb_bench.points import read_point
    from ...limb_bench.scenario import push_scenario

    properties = words.build_plant()
    chosen = words.build_limb(properties)
    pushed = read_point("force", force, "force")
    scenario = push_scenario(chosen, properties.control_rate, force=pushed, start=begin, end=end, seconds=seconds)
    run_bench(words, chosen, scenario, properties)

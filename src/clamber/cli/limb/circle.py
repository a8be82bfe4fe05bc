"""`clamber limb circle`: the aim runs round a circle; every law follows."""

from typing import Annotated

import typer

from ..option_holder import takes_words
from .options import BenchWords, run_bench


@takes_words
def circle(
    centre: Annotated[str, typer.Option(metavar="X,Y", help="Of the circle, port frame.")] = "22cm,0",
    radius: Annotated[str, typer.Option(help="Such as 5cm.")] = "5cm",
    lap: Annotated[float, typer.Option(help="Time of one lap [s].")] = 6.0,
    laps: Annotated[int, typer.Option(min=1, help="Laps; the last one is measured.")] = 2,
    *,
    words: BenchWords,
) -> None:
    """Let the aim run round a circle, and compare how far each law leaves it in the last lap."""
    words.check()
    from ...limb_bench.points import read_number, read_point
    from ...limb_bench.scenario import circle_scenario

    properties = words.build_plant()
    middle, size = read_point("centre", centre), read_number("radius", radius, "length")
    chosen = words.build_limb(properties, (middle[0] + size, middle[1]))
    scenario = circle_scenario(chosen, properties.control_rate, centre=middle, radius=size, lap=lap, laps=laps)
    run_bench(words, chosen, scenario, properties)

"""`clamber body circle`: the body runs round a circle on two limbs."""

from typing import Annotated

import typer

from ..option_holder import takes_words
from .options import BodyWords, run_bench


@takes_words
def circle(
    radius: Annotated[str, typer.Option(help="Such as 5cm.")] = "5cm",
    lap: Annotated[float, typer.Option(help="Time of one lap, in seconds.")] = 6.0,
    laps: Annotated[int, typer.Option(min=1, help="The last one is measured.")] = 2,
    *,
    words: BodyWords,
) -> None:
    """Let the body's aim run round a circle, the tips fixed to their pegs unless --hooked (thesis, Fig. 4.17)."""
    words.check()
    from ...experiments.climb.body_scenario import circle as round_circle
    from ...units import read_number

    flaws = words.build_plant()
    size = read_number("radius", radius, "length")
    stand = words.build_stand(fixed=True, below=f"{size} m")
    run_bench(words, stand, round_circle(stand.pose, flaws.period, radius=size, lap=lap, laps=laps), flaws)

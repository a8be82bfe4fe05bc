"""`clamber body push-up`: the body rises on two limbs."""

from typing import Annotated

import typer

from ..option_holder import takes_words
from .options import BodyWords, run_bench


@takes_words
def push_up(
    height: Annotated[str, typer.Option(help="Such as 7.5cm.")] = "7.5cm",
    seconds: Annotated[float, typer.Option(help="In so many seconds.")] = 0.5,
    *,
    words: BodyWords,
) -> None:
    """Push the body up on its hooks (thesis, Fig. 4.18)."""
    words.check()
    from ...experiments.climb.body_scenario import push_up as up
    from ...units import read_number

    flaws = words.build_plant()
    stand = words.build_stand()
    way = read_number("height", height, "length")
    run_bench(words, stand, up(stand.pose, flaws.period, height=way, seconds=seconds), flaws)

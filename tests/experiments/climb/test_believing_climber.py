"""What a controller is told of the plant that was drawn for it: how far off its map may be, and nothing besides."""

import numpy as np
import pytest

from clamber.benchmarks.climb_speed import two_rungs
from clamber.families.climber.trials.noise import Noise, draw_for
from clamber.families.climber.trials.plants import drawn_plant
from clamber.families.climber.trials.run_plan import believing_climber, climbing_flaws


@pytest.mark.parametrize("text", ["0mm", "3mm", "6.35mm"])
def test_the_map_may_be_off_by_the_width_of_the_noise_and_no_more(text: str) -> None:
    task, _ = two_rungs()
    noise = Noise.of("none", [f"peg_error={text}"])
    drawn = draw_for(task, noise, 5)
    climber = believing_climber(task, drawn_plant(task, climbing_flaws(task, ()), drawn), noise, drawn)
    width = 1e-3 * float(text.removesuffix("mm"))
    assert climber.map.error(7) == pytest.approx(width, abs=2e-6)
    assert np.abs(drawn.pegs).max() <= width
    np.testing.assert_array_equal([*climber.holds.values()], task.world.positions())

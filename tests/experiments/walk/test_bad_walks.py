"""Walks that cannot be: each ends with the limit that it meets and by how much, or is refused before it begins."""

import re

import numpy as np
import pytest

from clamber.errors import SpecError
from clamber.families.walker.execution.true_walk import hull_margins
from clamber.families.walker.planning import load_walk
from clamber.families.walker.planning.walk import start_margin
from clamber.families.walker.sim.walker_plant import WalkerSim
from clamber.families.walker.trials.run_walk import WalkRun, run_walk, walk_flaws


def walked(*changes: str) -> WalkRun:
    walk = load_walk("level-walk", ("way.0.distance=10cm", *changes))
    return run_walk(walk, walk_flaws(walk, ()))


@pytest.mark.slow
def test_a_payload_that_would_tip_it_on_three_feet_is_told_with_the_margin_that_is_left() -> None:
    run = walked("payload=20kg")
    assert not run.done
    assert not run.report.steps  # nothing is lifted
    margins = re.findall(r"centre of mass is (-?\d+) mm inside the feet that stand, and 20 mm are kept", run.reason)
    assert len(margins) == 2, run.reason  # whichever frame is lifted
    assert max(map(int, margins)) < 20
    assert run.true.margins[-1] > 0.0  # it stands on six feet, and goes on standing


def test_a_payload_that_tips_it_on_six_feet_is_told_with_what_could_be_carried() -> None:
    run = walked("payload=60kg")
    assert not run.done
    said = re.search(
        r"fell: .*60 kg put the centre of mass (\d+) mm outside the six feet.* rigid feet would bear up to ([\d.]+) kg",
        run.reason,
    )
    assert said is not None, run.reason
    heavy, most = load_walk("level-walk", ("payload=60kg",)), float(said.group(2))
    assert int(said.group(1)) == round(-1e3 * start_margin(heavy, 60.0))
    assert 0.0 < start_margin(heavy, most) < 1e-3
    # near the edge, where feet that give way tip it though rigid ones would not, the margin is told, too
    near = walked("payload=38kg")
    assert not near.done
    left = 1e3 * start_margin(heavy, 38.0)
    assert left > 0.0
    assert f"38 kg put the centre of mass {left:.0f} mm inside the six feet" in near.reason
    # the plant's own parts say the same of a load that it stands with: the bodies' centre of mass in the hull of the feet
    walk = load_walk("level-walk", ("payload=10kg",))
    sim = WalkerSim(walk.robot, walk.ground, walk_flaws(walk, ()))
    sim.reset(walk.start_pose(), walk.start_place(), walk.start_legs(), np.array(walk.arm))
    true = sim.truth()
    margin = hull_margins(true.feet.reshape(1, 6, 3), np.ones((1, 6), np.int32), true.centre[None])[0]
    assert margin == pytest.approx(start_margin(walk, walk.payload), abs=2e-3)


def test_a_singular_start_is_refused_before_anything_moves() -> None:
    with pytest.raises(SpecError, match=r"start.*actuators of 0 to 0 mm; they can be 50 to 300 mm"):
        load_walk("level-walk", ("start.twist=60deg",))


def test_a_foothold_beyond_the_legs_stroke_names_the_lengths() -> None:
    with pytest.raises(SpecError, match=r"asks for legs of \d+ to \d+ mm; they can be 250 to 450 mm"):
        load_walk("slope-walk", ("ground.slope=30deg",))

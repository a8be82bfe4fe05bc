"""A ditch in contact dynamics: the slides keep off its edges, and no foot ever goes down into it."""

import math

import numpy as np
import pytest

from clamber.errors import SpecError
from clamber.families.walker.control.gait import room_at
from clamber.families.walker.execution.settings import WalkSettings
from clamber.families.walker.planning import Walk, load_walk
from clamber.families.walker.robot.plane_poses import seen_from
from clamber.families.walker.trials.planned import BALANCE, CLEARANCE
from clamber.families.walker.trials.run_walk import crossing_steps, plan_crossing, run_walk, walk_flaws


def ditch(width: str, *settings: str) -> Walk:
    far = f"ground.blocks.0.x_max={0.6 + float(width.split()[0]) * 1e-3!r} m"
    return load_walk("ditch-walk", (f"way.0.ditch={width}", far, *settings))


@pytest.mark.parametrize(("width", "along"), [("80 mm", 0.0), ("120 mm", 0.0), ("120 mm", 25.0), ("150 mm", -40.0)])
def test_steps_keep_off_the_edges_and_within_what_a_walk_may(width: str, along: float) -> None:
    walk = ditch(width, f"way.0.along={along!r} deg")
    found = plan_crossing(walk)
    assert found.status == "found", found.reason
    robot, poses = walk.robot, found.start.copy()
    wide = float(width.split()[0]) * 1e-3
    for step in crossing_steps(found):
        np.testing.assert_allclose(step.stands, poses[1 - step.swing], atol=1e-12)
        poses[step.swing] = step.corners[-1]
        c, s = math.cos(poses[step.swing, 2]), math.sin(poses[step.swing, 2])
        across = (poses[step.swing, :2] + robot.feet()[step.swing] @ np.array(((c, s), (-s, c))))[:, 0]
        # the plan's ditch begins before the true one, by what is kept
        off = np.maximum(-across, across - (wide + 2.0 * CLEARANCE)) + CLEARANCE
        assert off.min() >= CLEARANCE - 1e-9
        assert room_at(robot, seen_from(poses[0], poses[1])[None], WalkSettings().limits)[0] > 0.0
    assert min(margins.balance for margins in found.replay()) >= -1e-9  # more than what is kept
    assert found.footing.margin == BALANCE
    behind = found.footing.feet_at(found.end())[:, :, 0].min()
    assert behind >= wide + 2.0 * CLEARANCE - 1e-9


def test_a_wider_one_is_refused_with_the_widest() -> None:
    walk = ditch("240 mm")
    run = run_walk(walk, walk_flaws(walk, []))
    assert not run.done and not run.report.steps
    assert run.reason.startswith("refused: the ditch cannot be crossed") and "widest" in run.reason


@pytest.mark.slow
@pytest.mark.parametrize("width", ["120 mm", "150 mm"])
def test_no_foot_goes_down_into_it(width: str) -> None:
    walk = ditch(width)
    run = run_walk(walk, walk_flaws(walk, []))
    assert run.done, run.reason
    true = run.true
    touching = true.touching.reshape(len(true.time), 6).astype(bool)
    feet = true.feet.reshape(len(true.time), 6, 3)
    edges = np.array((0.6, 0.6 + float(width.split()[0]) * 1e-3))
    x = feet[..., 0][touching]
    assert np.minimum(np.abs(x - edges[0]), np.abs(x - edges[1])).min() > 0.5 * CLEARANCE
    assert not np.any((x > edges[0]) & (x < edges[1]))
    assert feet[-1, :, 0].min() > edges[1]
    assert run.margin > BALANCE - 0.005


@pytest.mark.parametrize(
    ("setting", "said"),
    [
        ("way=[{ ditch='10 cm' }]", "ditch and ahead"),
        ("way=[{ ditch='10 cm', ahead='1 m', turn='5 deg' }]", "one of"),
        ("way=[{ turn='5 deg' }, { ditch='10 cm', ahead='1 m' }]", "only piece"),
        ("way=[{ turn='5 deg', along='1 deg' }]", "'ditch'"),
        ("start.offset=['1 cm', '0 m']", "offset"),
        ("hold={ x='0 m', y='0.3 m', z='0.6 m' }", "without a ditch"),
    ],
)
def test_a_ditch_is_a_way_of_its_own(setting: str, said: str) -> None:
    with pytest.raises(SpecError, match=said):
        load_walk("ditch-walk", (setting,))

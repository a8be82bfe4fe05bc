"""The tool held at a point of the world while the robot walks past it on a slope, in contact dynamics."""

import math

import numpy as np
import pytest

from clamber.families.walker.planning import load_walk
from clamber.families.walker.trials.run_walk import run_walk, walk_flaws

HOLD = "hold={ x = '15 cm', y = '0.3 m', z = '0.6 m', within = '%s' }"


@pytest.mark.slow
@pytest.mark.parametrize("uphill", [0.0, 90.0, 180.0])
def test_the_tool_stays_within_millimetres_while_the_robot_walks_past(uphill: float) -> None:
    walk = load_walk("slope-walk", (HOLD % "10 cm", "way.0.distance=30cm", f"ground.uphill={uphill}deg"))
    run = run_walk(walk, walk_flaws(walk, ()))
    assert run.done, run.reason
    held = run.held
    assert held is not None
    np.testing.assert_allclose(held.part.reach, [(0.05, 0.25)], atol=2e-3)
    assert (held.part.first, held.part.last) == held.part.reach[0]  # all of it is well within reach
    # what is measured is the plant's own tool point, against the point as it truly lies beside the start
    rows = np.isin(run.true.time, held.time)
    gone = run.true.pose[rows, 0]
    assert gone.max() - gone.min() > 0.19
    assert np.ptp(run.true.tool[rows], axis=0).max() < 4e-3
    assert held.errors.max() < 2.5e-3
    np.testing.assert_allclose(held.point[:2], (0.15, 0.3), atol=1e-3)
    assert run.tilt < math.radians(0.1)
    assert run.margin > 0.05
    told = run.to_json()["hold"]
    assert told["largest_error"] == held.errors.max()
    assert told["held_seconds"] > 60.0


@pytest.mark.long
def test_a_plate_that_is_lent_keeps_the_arm_from_being_stretched_and_stays_level() -> None:
    """Down the slope, past a point over the arm's shoulder: held on as the walk goes, with the height in slides and without it."""
    runs = {}
    for served in ("arm", "height"):
        point = f"hold={{ x = '35 cm', y = '0.3 m', z = '1 m', within = '35 cm', served = '{served}' }}"
        walk = load_walk("slope-walk", (point, "way.0.distance=75cm", "ground.uphill=180deg"))
        run = run_walk(walk, walk_flaws(walk, ()))
        assert run.done, run.reason
        assert run.held is not None
        assert run.held.errors.max() < 2.5e-3
        assert run.tilt < math.radians(0.1)
        assert run.margin > 0.05
        runs[served] = run.held.part
    arm, height = runs["arm"], runs["height"]
    assert height.way == arm.way == pytest.approx(0.7)  # the arm alone reaches all of it
    assert height.measures[0] > 1.5 * arm.measures[0]
    assert height.measures[1] > 1.03 * arm.measures[1]
    assert arm.raised == (0.0, 0.0)
    assert 0.02 < height.raised[1] < 0.08


@pytest.mark.slow
def test_the_tool_follows_a_line_while_the_robot_walks_up() -> None:
    """0.2 m of line, ahead and upwards, on 0.2 m of way; seen from the plant's own tool point."""
    line = "hold={ x = '10 cm', y = '0.3 m', z = '0.6 m', within = '10 cm', through = [{ x = '26 cm', y = '0.3 m', z = '72 cm' }] }"
    walk = load_walk("slope-walk", (line, "way.0.distance=36cm"))
    run = run_walk(walk, walk_flaws(walk, ()))
    assert run.done, run.reason
    held = run.held
    assert held is not None
    np.testing.assert_allclose(
        held.part.reach, [(0.08, 0.28)], atol=2e-3
    )  # about 0.18 m, where the line has its middle
    rows = np.isin(run.true.time, held.time)
    tool, gone = run.true.tool[rows], run.true.pose[rows, 0]
    share = np.clip((gone - gone[0]) / (gone[-1] - gone[0]), 0.0, 1.0)
    place = tool[0] + share[:, None] * (0.16, 0.0, 0.12)
    assert np.linalg.norm(tool - place, axis=1).max() < 5e-3
    assert held.errors.max() < 2.5e-3
    assert run.tilt < math.radians(0.1)


@pytest.mark.slow
def test_balance_is_reckoned_with_the_arm_as_it_will_be() -> None:
    # 6 kg go out by the arm while the robot walks, then stay beside it, then come back
    walk = load_walk(
        "slope-walk", ("hold={ x = '0.5 m', y = '0.35 m', z = '0.6 m', within = '15 cm' }", "payload=6kg", "way.0.distance=0.75m")
    )  # fmt: skip
    run = run_walk(walk, walk_flaws(walk, ()))
    assert run.done, run.reason
    true, margins = run.true, run.true.margins
    for step in run.report.steps:
        over = step.start + step.times.lift + step.times.slide + step.times.lower
        rows = (true.time >= step.start) & (true.time <= over)
        assert margins[rows].min() > step.balance - 1e-3
    assert run.margin > 0.019


@pytest.mark.slow
def test_a_point_that_the_arm_cannot_reach_is_refused_before_a_step() -> None:
    walk = load_walk("slope-walk", ("hold={ x = '10 cm', y = '1.5 m', z = '0.6 m' }", "way.0.distance=20cm"))
    run = run_walk(walk, walk_flaws(walk, ()))
    assert not run.done
    assert "nowhere" in run.reason
    assert run.report.steps == []
    assert "hold" not in run.to_json()


@pytest.mark.slow
def test_a_robot_knows_where_it_walks_up_though_its_feet_sink_in() -> None:
    """Feet sink in along the slope's normal: reckoned as rigid, each step of a frame adds 0.3 mm of way and 0.6 mm of height."""
    walk = load_walk("slope-walk", ("way.0.distance=30cm",))
    run = run_walk(walk, walk_flaws(walk, ()))
    trace = run.trace
    assert trace.true_pose is not None
    off = (trace.believed - trace.true_pose)[trace.time > run.report.prepared, :3]
    assert len(run.report.steps) > 5
    assert np.abs(off[-1] - off[0]).max() < 0.8e-3

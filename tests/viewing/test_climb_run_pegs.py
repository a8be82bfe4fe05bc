"""Pictures of a climb under noise show the pegs as they truly are."""

from pathlib import Path

import numpy as np

from clamber.actions.limbed_plans import thesis_code
from clamber.actions.plan import Plan
from clamber.execution.climb.course import climbable
from clamber.experiments.climb.noise import NO_NOISE, Noise, read_noise
from clamber.experiments.climb.run_plan import ClimbRun, climbing_flaws, run_plan
from clamber.tasks import load_task
from clamber.tasks.limbed import LimbedTask
from clamber.viewing import style
from clamber.viewing.climb_run_view import ClimbRunView, write_run


def climbed(noise: Noise) -> ClimbRun:
    task = load_task("ladder")
    assert isinstance(task, LimbedTask)
    strict = climbable(task)
    plan = Plan.of_codes(strict, [thesis_code(strict, 300)])
    return run_plan(strict, plan, climbing_flaws(strict, ()), noise=noise, seed=2)


def test_true_pegs_are_crosses_where_they_are(tmp_path: Path) -> None:
    run = climbed(read_noise(NO_NOISE, ["peg_error=5mm"]))
    places = run.task.world.positions()
    pegs = places + run.drawn.pegs
    view = ClimbRunView(run.task, run.trace, run.report.actions, pegs)
    crosses = [line for line in view.wall.get_lines() if line.get_marker() == "x" and line.get_color() == style.ALERT]
    assert len(crosses) == 1
    np.testing.assert_array_equal(crosses[0].get_xydata(), pegs)
    moved = {hold.number for hold, off in zip(run.task.world.holds, run.drawn.pegs, strict=True) if off.any()}
    assert moved == {hold.number for hold in run.task.world.holds}  # those that the robot starts on, too
    write_run(run, tmp_path / "climb.png")
    plain = climbed(NO_NOISE)
    write_run(plain, tmp_path / "plain.png")
    assert (tmp_path / "climb.png").read_bytes() != (tmp_path / "plain.png").read_bytes()

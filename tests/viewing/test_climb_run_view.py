"""Pictures of a climb show the pegs as they truly are, and tell what became of every action, not margins that nothing judged."""

from dataclasses import replace
from pathlib import Path

import numpy as np

from clamber.families.climber.execution.course import climbable
from clamber.families.climber.pictures.climb_run_view import OUTCOMES, ClimbRunView, write_run
from clamber.families.climber.planning.plans import thesis_code
from clamber.families.climber.planning.task import LimbedTask
from clamber.families.climber.trials.noise import NO_NOISE, Noise, read_noise
from clamber.families.climber.trials.run_plan import ClimbRun, climbing_flaws, run_plan
from clamber.planning.problem.plan import Plan
from clamber.tasks import load_task
from clamber.viewing import style
from clamber.viewing.frames import make_frames
from clamber.viewing.player import player_data


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


def test_what_went_wrong_is_told_and_red_in_picture_and_player() -> None:
    run = climbed(NO_NOISE)
    first = run.report.actions[0]
    missed = replace(first, first=2, last=4, kind="grab", outcome="missed", reason="the hook met nothing")
    view = ClimbRunView(run.task, run.trace, [first, missed])
    view.show(2, view.settled(2))
    assert view.title_text.get_text().startswith("Action 2 of 2") and view.title_text.get_color() == style.ALERT
    assert view.texts[-1].get_text() == "missed: the hook met nothing (plan: step 2 to 4)"
    data = player_data(view, make_frames(view, 100))
    assert (data["noun"], data["strip"]) == ("Action", "What became of every action")
    assert data["palette"]["words"] == OUTCOMES and data["rows"][-1] == "Outcome"
    assert [step["grade"] for step in data["steps"]] == [3, 3, 0]
    assert data["steps"][2]["facts"][-1].startswith("missed")
    view.show(1, view.settled(1))
    assert view.title_text.get_color() == style.INK

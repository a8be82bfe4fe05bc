"""Pictures of a climb show the pegs as they truly are, and tell what became of every action, not margins that nothing judged."""

from dataclasses import replace
from pathlib import Path

import numpy as np

from clamber.families.climber.execution.executable_plan import climbable
from clamber.families.climber.pictures.climb_run import OUTCOMES, ClimbFilm, ClimbPicture
from clamber.families.climber.planning.plans import thesis_code
from clamber.families.climber.planning.task import LimbedTask
from clamber.families.climber.trials.noise import NO_NOISE, Noise
from clamber.families.climber.trials.run_plan import ClimbRun, climbing_flaws, run_plan
from clamber.planning.problem.plan import Plan
from clamber.tasks import load_task
from clamber.viewing import style
from clamber.viewing.browser.page import panel_data
from clamber.viewing.pictures import draw_run


def climbed(noise: Noise) -> ClimbRun:
    task = load_task("ladder")
    assert isinstance(task, LimbedTask)
    strict = climbable(task)
    plan = Plan.of_codes(strict, [thesis_code(strict, 300)])
    return run_plan(strict, plan, climbing_flaws(strict, ()), noise=noise, seed=2)


def test_true_pegs_are_crosses_where_they_are(tmp_path: Path) -> None:
    run = climbed(Noise.of("none", ["peg_error=5mm"]))
    places = run.task.world.positions()
    pegs = places + run.drawn.pegs
    picture = ClimbPicture(ClimbFilm(run.task, run.trace, run.report.actions, pegs))
    crosses = [
        line for line in picture.wall.get_lines() if line.get_marker() == "x" and line.get_color() == style.ALERT
    ]
    assert len(crosses) == 1
    np.testing.assert_array_equal(crosses[0].get_xydata(), pegs)
    moved = {hold.number for hold, off in zip(run.task.world.holds, run.drawn.pegs, strict=True) if off.any()}
    assert moved == {hold.number for hold in run.task.world.holds}  # those that the robot starts on, too
    draw_run(run, tmp_path / "climb.png")
    plain = climbed(NO_NOISE)
    draw_run(plain, tmp_path / "plain.png")
    assert (tmp_path / "climb.png").read_bytes() != (tmp_path / "plain.png").read_bytes()


def test_what_went_wrong_is_told_and_red_in_picture_and_page() -> None:
    run = climbed(NO_NOISE)
    first = run.report.actions[0]
    missed = replace(first, first=2, last=4, kind="grab", outcome="missed", reason="the hook met nothing")
    film = ClimbFilm(run.task, run.trace, [first, missed])
    picture = ClimbPicture(film)
    picture.show(2, film.settled(2))
    assert picture.title_text.get_text().startswith("Action 2 of 2") and picture.title_text.get_color() == style.ALERT
    assert picture.texts[-1].get_text() == "missed: the hook met nothing (plan: step 2 to 4)"
    data = panel_data(film, np.zeros(1), "run", None)
    assert data["strip"]["title"] == "What became of every action" and data["strip"]["words"] == OUTCOMES
    assert [step["grade"] for step in data["steps"]] == [3, 3, 0]
    head = data["steps"][2]["head"]
    assert "Action 2 of 2" in head and "missed" in head and "the hook met nothing" in head and style.ALERT in head
    picture.show(1, film.settled(1))
    assert picture.title_text.get_color() == style.INK

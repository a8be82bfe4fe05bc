"""Pictures say what they show: dotted limits, red crosses, a walker's parts, trials that all succeeded, robots on large walls."""

import importlib.util
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from matplotlib.figure import Figure

import clamber
from clamber.families.climber.execution.climb_trace import ClimbTrace, climb_titles
from clamber.families.climber.pictures.charts import trials_figure
from clamber.families.climber.pictures.climb_run import ClimbFilm, ClimbPicture
from clamber.families.climber.trials.trial_summary import sum_up
from clamber.family import family_of
from clamber.trials.trial_runs import Trials
from clamber.viewing.pictures import carried_out
from clamber.viewing.view import Picture


def words_of(figure: Figure) -> str:
    texts = [text.get_text() for axes in figure.axes for text in (*axes.texts, axes.title, axes.xaxis.label)]
    return " | ".join((*texts, *(text.get_text() for legend in figure.legends for text in legend.get_texts())))


def picture_of(name: str, changes: tuple[str, ...] = ()) -> Picture[Any]:
    task = clamber.load_task(name, changes)
    family, replay = family_of(task).pictures, carried_out(task, None)
    picture = Picture(family.view(task, replay))
    picture.show(0, picture.view.settled(0))
    if family.near is not None:
        picture.draw_near(family.near(task, replay.stances[0]))
    return picture


def test_dotted_lines_and_a_walkers_parts_are_told() -> None:
    assert "where bars turn red" in words_of(picture_of("ladder").figure)
    told = words_of(picture_of("patch-walk").figure)
    for part in ("standing foot", "lifted foot", "actuator", "frames", "centre of mass", "no foot may stand here"):
        assert part in told


def test_red_crosses_are_told() -> None:
    task = clamber.load_task("ladder")
    titles = climb_titles(task.robot.limb_names, true=False)
    row = np.zeros(sum(map(len, titles.values())))
    row[2:5] = row[5:8] = task.start.x, task.start.y, 0.0
    trace = ClimbTrace.from_table(task.robot.limb_names, np.array([row, row]), None)
    trace = replace(trace, time=np.array((0.0, 1.0)))
    pegs = task.world.positions() + 0.003
    assert "peg as it truly is" in words_of(ClimbPicture(ClimbFilm(task, trace, [], pegs)).figure)
    assert "peg as it truly is" not in words_of(ClimbPicture(ClimbFilm(task, trace, [])).figure)


def trials_of(n: int, failed: int) -> Trials[Any, Any]:
    path = Path(__file__).parents[1] / "experiments" / "climb" / "climbs_by_hand.py"
    spec = importlib.util.spec_from_file_location("climbs_by_hand", path)
    assert spec is not None and spec.loader is not None
    made: Any = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(made)
    ended = [made.climb(k, done=k >= failed, kind="grab", limb="left") for k in range(n)]
    return Trials(made.setup_of(300), n, ended)


@pytest.mark.slow
def test_trials_that_all_succeeded_show_what_was_measured_and_no_empty_panels() -> None:
    all_done = trials_figure(sum_up(trials_of(24, 0)))
    assert len(all_done.axes) <= 4 and "time of a climb [s]: median" in words_of(all_done)
    assert len(trials_figure(sum_up(trials_of(24, 3))).axes) > 9


@pytest.mark.parametrize("width", ["100ft", "30m"])
def test_a_robot_on_a_large_wall_is_shown_from_near_in_one_unit(width: str) -> None:
    small = picture_of("ladder")
    assert not any("times as large" in axes.get_title() for axes in small.figure.axes)
    far = f"{{ number = 999, x = '{width}', y = '{width}' }}"
    large = picture_of("ladder", (f"board.added=[{far}]",))
    (inset,) = [axes for axes in large.figure.axes if "times as large" in axes.get_title()]
    (x0, x1), (y0, y1) = inset.get_xlim(), inset.get_ylim()
    posture = large.view.settled(0).posture
    for x, y in (*posture.outline, *posture.chains.reshape(-1, 2)):
        assert x0 <= x <= x1 and y0 <= y <= y1
    assert large.wall.get_xlabel() == "x [in]"  # as the pose beside it

"""An edited ground makes the task or the walk that its file would, or says what is wrong with it, and about what."""

import math

import numpy as np
import pytest

from clamber.errors import ClamberError, SpecError
from clamber.families.walker.pictures.ground_editor import DITCH, PATCH, STEP, GroundDraft
from clamber.families.walker.pictures.walk_film import standing, way_poses
from clamber.families.walker.planning import Walk, load_walk, walk_names
from clamber.families.walker.planning.task import WalkerTask
from clamber.tasks import Task, load_task
from clamber.tasks.task_format import task_files
from clamber.viewing.browser.inputs import about
from clamber.viewing.browser.viewer_content import exhibit_of


def terrace() -> GroundDraft:
    task: Task = load_task("terrace-walk")
    assert isinstance(task, WalkerTask)
    return GroundDraft(task)


def steps() -> GroundDraft:
    return GroundDraft(load_walk("step-walk"))


def ground_of(made: WalkerTask | Walk):  # type: ignore[no-untyped-def]
    return made.ground if isinstance(made, Walk) else made.world


@pytest.mark.parametrize("draft", [terrace(), steps()], ids=["task", "walk"])
def test_ground_that_is_not_edited_makes_the_same(draft: GroundDraft) -> None:
    made = draft.build()
    assert not draft.changed
    assert ground_of(made) == ground_of(draft.task) and made.start == draft.task.start
    assert (made.way if isinstance(made, Walk) else made.goals) == (
        draft.task.way if isinstance(draft.task, Walk) else draft.task.goals
    )


@pytest.mark.parametrize("draft", [terrace(), steps()], ids=["task", "walk"])
def test_pieces_come_go_and_move(draft: GroundDraft) -> None:
    n = len(draft.pieces)
    ditch, patch, step = (draft.add(kind) for kind in (DITCH, PATCH, STEP))
    assert [name.split()[0] for name in draft.names()[n:]] == ["ditch", "patch", "step"]
    draft.reshape(ditch, (1.0, 1.1, -0.5, 0.5), -0.2)
    draft.move(step, 0.4, 1.3)  # beside the ditch: a later piece covers an earlier one
    draft.reshape(patch, (0.7, 0.8, -0.1, 0.1), 7.0)  # it has no height
    ground = ground_of(draft.build())
    assert draft.changed
    assert ground.heights((1.05, 0.0)) == pytest.approx(-0.2)
    assert ground.blocks[-1].x_min == pytest.approx(0.5 + 0.4) and ground.blocks[-1].height == pytest.approx(0.03)
    assert ground.forbidden()[-1][0] == pytest.approx((0.7, -0.1))
    for k in sorted((ditch, patch, step), reverse=True):
        draft.remove(k)
    assert ground_of(draft.build()) == ground_of(draft.task)


def test_polygons_are_moved_as_a_whole() -> None:
    task: Task = load_task("patch-walk")
    assert isinstance(task, WalkerTask)
    draft = GroundDraft(task)
    k = len(draft.pieces) - 1
    before = np.array(draft.pieces[k])
    x0, x1, y0, y1 = draft.box(k)
    draft.reshape(k, (x0 + 0.1, x1 + 0.1, y0 - 0.2, y1 - 0.2), 0.0)
    np.testing.assert_allclose(np.array(draft.pieces[k]), before + np.array((0.1, -0.2)))
    made = ground_of(draft.build()).forbidden()[-1]
    np.testing.assert_allclose(np.array(made), before + np.array((0.1, -0.2)))


@pytest.mark.parametrize("slope", ["0 deg", "10 deg"])
def test_start_and_goal_of_a_walk_are_where_they_were_put(slope: str) -> None:
    draft = GroundDraft(load_walk("level-walk", [f"ground.slope={slope}"]))
    draft.set_start(0.4, -0.2, 0.5)
    draft.set_goal(1.0, 0.6, 0.9)
    walk = draft.build()
    assert isinstance(walk, Walk)
    poses = way_poses(walk)
    assert poses[0] == pytest.approx((0.4, -0.2, 0.5))
    assert poses[-1][:2] == pytest.approx((1.0, 0.6)) and math.remainder(poses[-1][2] - 0.9, math.tau) == pytest.approx(
        0.0
    )
    assert draft.goal_pose() == (1.0, 0.6, 0.9)
    draft.undo()
    assert not draft.changed


def test_goal_of_a_task_is_a_step_about_its_place() -> None:
    draft = terrace()
    draft.set_goal(0.9, 0.1, 0.2)
    made = draft.build()
    assert isinstance(made, WalkerTask)
    goal, step = made.goals[-1], made.step
    assert goal.box == pytest.approx((0.9 - step.length, 0.9 + step.length, 0.1 - step.length, 0.1 + step.length))
    assert (goal.theta_min, goal.theta_max) == pytest.approx((0.2 - step.angle, 0.2 + step.angle))
    assert goal.name == draft.task.goals[-1].name  # type: ignore[union-attr]


def inside_out(draft: GroundDraft) -> None:
    draft.reshape(0, (0.5, 0.4, -1.0, 1.0), 0.03)


def deeper_than_the_ground(draft: GroundDraft) -> None:
    draft.reshape(0, (0.5, 0.6, -1.0, 1.0), -30.0)


def feet_in_a_ditch(draft: GroundDraft) -> None:
    k = draft.add(DITCH)
    x, y = np.concatenate(draft.task.robot.feet())[0]
    draft.reshape(k, (x - 0.04, x + 0.04, y - 0.04, y + 0.04), -0.3)


def start_off_the_ground(draft: GroundDraft) -> None:
    draft.set_start(30.0, 0.0, 0.0)


def goal_off_the_ground(draft: GroundDraft) -> None:
    draft.set_goal(0.0, -30.0, 0.0)


@pytest.mark.parametrize("make", [terrace, steps])
@pytest.mark.parametrize(
    ("spoil", "what", "words"),
    [
        (inside_out, "world", "must be less than x_max"),
        (deeper_than_the_ground, "world", "must be above the ground's bottom"),
        (feet_in_a_ditch, "start", "legs"),
        (start_off_the_ground, "start", "no ground"),
        (goal_off_the_ground, "goal", "no ground"),
    ],
)
def test_what_cannot_be_is_refused_where_it_is(make, spoil, what: str, words: str) -> None:  # type: ignore[no-untyped-def]
    draft = make()
    spoil(draft)
    with pytest.raises(ClamberError, match=words) as caught:
        made = draft.build()
        exhibit_of(made)
    assert about(caught.value) == what
    assert "\n" not in str(caught.value) and isinstance(str(caught.value), str)


def test_a_start_in_a_ditch_names_the_leg() -> None:
    draft = steps()
    feet_in_a_ditch(draft)
    with pytest.raises(SpecError, match="the ground under delta leg 1 is 300 mm lower than under"):
        draft.build()


@pytest.mark.parametrize("name", walk_names())
def test_walks_stand_with_every_foot_on_their_ground(name: str) -> None:
    walk = load_walk(name)
    at = standing(walk)
    soles = at.feet[0].reshape(6, 3)
    np.testing.assert_allclose(soles[:, 2], walk.ground.heights(soles[:, :2]), atol=2e-3 + 0.02 * walk.ground.slope)
    exhibit = exhibit_of(walk)
    assert exhibit.main.seconds == 0.0 and exhibit.plan is None
    x0, x1, y0, y1 = exhibit.scenery.bounds  # type: ignore[attr-defined]
    way = way_poses(walk)
    assert x0 < way[:, 0].min() and way[:, 0].max() < x1 and y0 < way[:, 1].min() and way[:, 1].max() < y1


def test_an_edited_walk_is_saved_as_files_that_load(tmp_path) -> None:  # type: ignore[no-untyped-def]
    draft = steps()
    draft.move(0, 0.1, 0.0)
    draft.set_start(0.02, 0.0, 0.0)
    draft.set_goal(1.5, 0.1, 0.0)
    for file, text in task_files(draft.build().document, "mine").items():
        (tmp_path / file).write_text(text)
    saved, made = load_walk(str(tmp_path / "mine.toml")), draft.build()
    assert isinstance(made, Walk)
    assert saved.ground.blocks == made.ground.blocks and (saved.start, saved.way) == (made.start, made.way)

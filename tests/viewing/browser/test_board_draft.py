"""An edited board makes the task that its file would, or says what is wrong with it."""

import pytest

from clamber.errors import ClamberError, SpecError
from clamber.families.climber.pictures.board_editor import BoardDraft
from clamber.families.climber.planning.task import LimbedTask
from clamber.tasks import load_task
from clamber.viewing.browser.inputs import about


@pytest.fixture
def draft() -> BoardDraft:
    task = load_task("ladder")
    assert isinstance(task, LimbedTask)
    return BoardDraft(task)


def test_board_that_is_not_edited_makes_the_same_pegs_and_goals(draft: BoardDraft) -> None:
    made = draft.build()
    assert not draft.changed
    assert made.world.holds == draft.task.world.holds
    assert (made.goals, made.start) == (draft.task.goals, draft.task.start)


def test_pegs_come_go_and_move(draft: BoardDraft) -> None:
    number = draft.add(0.1, 1.8)
    draft.move(22, 0.5, 1.55)
    draft.remove(21)
    world = draft.build().world
    assert number == 23 and draft.changed
    assert (world.by_number(23).x, world.by_number(23).y) == (0.1, 1.8)
    assert (world.by_number(22).x, world.by_number(22).y) == (0.5, 1.55)
    assert 21 not in world.numbers()
    draft.undo()
    assert draft.build().world.holds == draft.task.world.holds


def test_added_peg_finds_room(draft: BoardDraft) -> None:
    for _ in range(6):
        draft.add(*draft.room_beside(5))
    assert len(draft.build().world.holds) == 28  # none overlaps another


def test_goal_is_a_box_of_a_step_each_way(draft: BoardDraft) -> None:
    draft.set_goal(0.25, 1.0)
    step = draft.task.step.length
    assert draft.build().goals[-1].box == pytest.approx((0.25 - step, 0.25 + step, 1.0 - step, 1.0 + step))


def test_board_without_pegs_is_refused(draft: BoardDraft) -> None:
    for number in tuple(draft.pegs):
        draft.remove(number)
    with pytest.raises(SpecError, match="the board has no holds; it needs at least one") as caught:
        draft.build()
    assert about(caught.value) == "world"
    assert draft.add(*draft.room_beside(None)) == 1


def test_pegs_that_overlap_are_refused(draft: BoardDraft) -> None:
    peg = draft.pegs[5]
    draft.move(6, peg.x + 0.5 * peg.radius, peg.y)
    with pytest.raises(SpecError, match="holds 5 and 6 overlap"):
        draft.build()


def test_goal_out_of_the_world_is_refused_as_a_goal(draft: BoardDraft) -> None:
    draft.set_goal(30.0, 1.0)
    with pytest.raises(SpecError, match="from the nearest hold, but robot 'libra' reaches") as caught:
        draft.build()
    assert about(caught.value) == "goal"


def test_start_on_a_peg_that_is_gone_is_refused(draft: BoardDraft) -> None:
    held = next(number for number in draft.task.start.holds.values() if number)
    draft.remove(held)
    with pytest.raises(ClamberError, match=r"no (such )?hold") as caught:
        draft.build()
    assert about(caught.value) == "start"


def test_start_is_set_and_comes_back(draft: BoardDraft) -> None:
    before = draft.task.start
    draft.set_start(before.x + 0.01, before.y - 0.02, 0.1)
    limb = next(limb for limb, number in before.holds.items() if number)
    free = next(number for number in draft.task.world.numbers() if number not in before.holds.values())
    draft.hold(limb, free)
    made = draft.build()
    assert draft.changed
    assert (made.start.x, made.start.y, made.start.theta) == (before.x + 0.01, before.y - 0.02, 0.1)
    assert made.start.holds == {**before.holds, limb: free}
    assert (made.world.holds, made.goals) == (draft.task.world.holds, draft.task.goals)
    draft.undo()
    assert not draft.changed and draft.build().start == before


def test_start_that_was_between_holds_is_where_it_was_put() -> None:
    task = load_task("ladder", ["start={ between=[1, 2, 3, 4], holds={ left=1, right=2 } }"])
    assert isinstance(task, LimbedTask)
    draft = BoardDraft(task)
    draft.set_start(0.2, 0.3, 0.0)
    assert (draft.build().start.x, draft.build().start.y) == (0.2, 0.3)


@pytest.mark.parametrize("holds", [{}, {"left": 0, "right": 0}])
def test_start_that_cannot_be_is_refused_as_a_start(draft: BoardDraft, holds: dict[str, int]) -> None:
    for limb, number in (holds or {limb: 5 for limb in draft.task.robot.limb_names[:2]}).items():
        draft.hold(limb, number)
    for limb in draft.task.robot.limb_names:
        if holds:
            draft.hold(limb, 0)
    with pytest.raises(SpecError, match="all limbs are free" if holds else "two limbs are on hold 5") as caught:
        draft.build()
    assert about(caught.value) == "start"

"""An edited board makes the task that its file would, or says what is wrong with it."""

import pytest

from clamber.errors import ClamberError, SpecError
from clamber.tasks import load_task
from clamber.tasks.limbed import LimbedTask
from clamber.viewing.browser.board_draft import BoardDraft, is_about_goal


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
    assert not is_about_goal(caught.value)
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
    assert is_about_goal(caught.value)


def test_start_on_a_peg_that_is_gone_is_refused(draft: BoardDraft) -> None:
    held = next(number for number in draft.task.start.holds.values() if number)
    draft.remove(held)
    with pytest.raises(ClamberError, match=r"no (such )?hold"):
        draft.build()

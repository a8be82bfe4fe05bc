"""Edited holds in space make the task that their file would, and a click finds the hold or the surface that is meant."""

from pathlib import Path

import numpy as np
import pytest

from clamber.errors import ClamberError
from clamber.families.spatial.pictures.hold_draft import HoldDraft
from clamber.families.spatial.planning.task import SpatialTask
from clamber.families.spatial.robot.bodies import rotation
from clamber.tasks import load_task
from clamber.tasks.task_format import task_files
from clamber.viewing.browser.inputs import readable

X, Y, Z = np.eye(3)


def task(name: str = "wall-gripper", *overrides: str) -> SpatialTask:
    made = load_task(name, overrides)
    assert isinstance(made, SpatialTask)
    return made


@pytest.fixture
def draft() -> HoldDraft:
    return HoldDraft(task())


def test_a_world_that_is_not_edited_stays_as_it_is(draft: HoldDraft) -> None:
    assert not draft.changed and draft.build().hashes == draft.task.hashes


def test_holds_come_go_move_and_turn(draft: HoldDraft) -> None:
    n = len(draft.holds)
    number = draft.add(np.array((0.0, 0.1, 0.5)), np.array((-2.0, 0.0, 0.0)), like=3)
    draft.move(4, np.array((0.01, 0.2, 0.3)))
    draft.turn(4, np.array((-1.0, 0.0, 1.0)))
    draft.remove(2)
    world = draft.build().world
    assert number == n + 1 and len(world.holds) == n
    assert world.holds[-1].at == (0.0, 0.1, 0.5) and world.holds[-1].normal == (-1.0, 0.0, 0.0)
    assert world.holds[-1].radius == draft.task.world.holds[2].radius
    assert world.holds[2].at == pytest.approx((0.01, 0.2, 0.3)) and world.normals[2] == pytest.approx(
        (-(0.5**0.5), 0, 0.5**0.5), abs=1e-6
    )
    assert [hold.number for hold in world.holds] == list(range(1, n + 1))
    draft.undo()
    assert draft.build().world.holds == draft.task.world.holds


def test_starts_on_holds_follow_their_new_numbers() -> None:
    holds = {"LF": 105, "LH": 80, "RH": 79, "RF": 104}
    said = [f"start.holds.{limb}={number}" for limb, number in holds.items()]
    draft = HoldDraft(task("wall-gripper", *said))
    draft.remove(90)
    assert dict(draft.build().start.holds or {}) == {"LF": 104, "LH": 80, "RH": 79, "RF": 103}
    draft.remove(80)
    with pytest.raises(ClamberError, match="every limb begins on a hold"):
        draft.build()


def test_a_saved_world_is_read_back_with_its_units(draft: HoldDraft, tmp_path: Path) -> None:
    draft.add(np.array((0.0123456, 0.1, 0.5)), np.array((-1.0, 0.2, 0.0)))
    made = draft.build()
    for name, text in task_files(readable(made.document), "edited").items():
        (tmp_path / name).write_text(text)
    text = (tmp_path / "edited-world.toml").read_text()
    assert '["0.0123 m", "0.1 m", "0.5 m"]' in text and "[[patterns]]" not in text
    again = task(str(tmp_path / "edited.toml"))
    assert again.world.places == pytest.approx(made.world.places, abs=2e-9)
    assert again.world.gravity == made.world.gravity


def test_a_line_of_sight_picks_the_hold_that_it_points_at(draft: HoldDraft) -> None:
    for number in (1, 100, 250):
        hold = draft.holds[number - 1]
        eye = np.array(hold.at) + 1.5 * np.array(hold.normal) + 0.2 * Y
        assert draft.picked(eye, np.array(hold.at) - eye) == number
    assert draft.picked(np.array((-2.0, 0.0, 1.0)), -X) is None


def test_a_line_of_sight_meets_a_solid_or_else_the_plane_of_the_nearest_hold(draft: HoldDraft) -> None:
    met = draft.met(np.array((-1.0, 0.05, 0.8)), X)
    assert met is not None and met[0][1:] == pytest.approx((0.05, 0.8)) and abs(met[0][0]) < 0.1
    assert met[1] @ -X > 0.8
    corner = HoldDraft(task("corners-magnet"))
    floor = corner.met(np.array((0.3, 0.1, 0.4)), np.array((0.1, 0.0, -1.0)))
    assert floor is not None
    solids = corner.task.world.solid_records
    assert len(solids) and floor[1] == pytest.approx(Z, abs=1e-3)
    assert draft.met(np.array((-2.0, 0.0, 1.0)), -X) is None


def test_the_normal_of_a_turned_handle_is_its_z() -> None:
    assert rotation(np.array((1.0, 0.0, 0.0, 0.0)))[:, 2] == pytest.approx(Z)
    half = 0.5**0.5
    assert rotation(np.array((half, 0.0, half, 0.0)))[:, 2] == pytest.approx(X)
    assert rotation(np.array((half, -half, 0.0, 0.0)))[:, 2] == pytest.approx(Y)

"""A standing walker follows tool paths: what it reaches with more and fewer freedoms, and what it says where it cannot."""

import numpy as np
import pytest

from clamber.execution.log_files import csv_text, parse_csv
from clamber.families.walker.control.cooperative.planted_feet import LimitError
from clamber.families.walker.control.cooperative.settings import CooperationError
from clamber.families.walker.robot import WalkerRobot
from clamber.families.walker.trials.cooperative.follow import FollowOptions, FollowRun, follow_path
from clamber.families.walker.trials.cooperative.tool_path import load_tool_path, path_of
from clamber.tasks.robots import load_robot

DOFS = (4, 5, 7, 10)


def hoshino() -> WalkerRobot:
    robot = load_robot("hoshino")
    assert isinstance(robot, WalkerRobot)
    return robot


@pytest.fixture(scope="module")
def runs() -> dict[tuple[str, int], FollowRun]:
    return {
        (name, dof): follow_path(hoshino(), load_tool_path(name), FollowOptions(dof=dof))
        for name in ("circle", "wide")
        for dof in DOFS
    }


@pytest.mark.slow
@pytest.mark.parametrize("dof", DOFS)
def test_the_circle_is_followed_with_every_set(runs: dict[tuple[str, int], FollowRun], dof: int) -> None:
    run = runs["circle", dof]
    assert run.reason == "followed to its end"
    assert run.errors.max() < 2e-4
    assert run.unsolved == 0
    low, high = run.limits
    assert (run.values >= low).all()
    assert (run.values <= high).all()


def test_the_wide_path_needs_the_body(runs: dict[tuple[str, int], FollowRun]) -> None:
    for dof in (4, 5):
        run = runs["wide", dof]
        assert run.unreachable
        assert run.reason.startswith("its end is out of reach: the closest reachable point is")
        assert run.end.distance < run.off_end
        told = run.to_json()
        assert not told["reached"]
    for dof in (7, 10):
        run = runs["wide", dof]
        assert not run.unreachable
        assert run.reason == "followed to its end"
    assert runs["wide", 4].end.distance > runs["wide", 5].end.distance > 0.05


def test_points_that_cannot_be_reached_are_the_ones_past_the_arms_reach(runs: dict[tuple[str, int], FollowRun]) -> None:
    """The plate does not move with four freedoms: the arm stretched is a ball about its shoulder's circle."""
    run = runs["wide", 4]
    arm = run.robot.arm
    assert arm is not None
    shoulder = np.array([arm.out, 0.35 + arm.up])
    flat = np.column_stack([np.hypot(run.path.points[:, 0], run.path.points[:, 1]), run.path.points[:, 2]])
    beyond = np.linalg.norm(flat - shoulder, axis=1) - sum(arm.links)
    for k, reach in run.unreachable:
        assert reach.distance == pytest.approx(beyond[k], abs=1e-4)
    first = min(k for k, _ in run.unreachable)
    assert (beyond[: first - 1] < 0.0).all()


def test_only_the_freedoms_of_the_set_move(runs: dict[tuple[str, int], FollowRun]) -> None:
    moved = {dof: np.ptp(runs["circle", dof].q[:, :6], axis=0) > 1e-9 for dof in DOFS}
    np.testing.assert_array_equal(moved[4], [False] * 6)
    np.testing.assert_array_equal(moved[5], [False, False, True, False, False, False])
    assert moved[7][[2, 4, 5]].all()  # the plate's x, y and alpha follow from its feet
    assert moved[10].all()


def test_a_log_holds_every_row(runs: dict[tuple[str, int], FollowRun]) -> None:
    run = runs["circle", 10]
    back = parse_csv(csv_text(run.log()), "log.csv")
    assert back.rows == len(run.time)
    np.testing.assert_array_equal(back.column("beta"), run.q[:, 4])
    np.testing.assert_array_equal(back.column("manipulability"), run.measure)
    assert back.notes["end"] == "followed to its end"
    assert back.units["length of actuator 0"] == "m"


def test_a_timed_path_is_not_waited_for() -> None:
    path = path_of(parse_csv("x [m],y [m],z [m],t [s]\n0.5,-0.3,0.6,0\n0.5,0.3,0.6,2\n", "fast.csv"))
    run = follow_path(hoshino(), path, FollowOptions(dof=4))
    assert run.time[run.on_path > 0][-1] - run.time[run.on_path > 0][0] == pytest.approx(3.0, abs=0.05)
    assert run.errors.max() > 0.01  # 0.3 m/s is more than the tool may


def test_options_that_cannot_be_are_named() -> None:
    path = load_tool_path("circle")
    with pytest.raises(CooperationError, match=r"gain = -1\.0"):
        follow_path(hoshino(), path, FollowOptions(dof=4, gain=-1.0))
    with pytest.raises(LimitError, match="balance over edge"):
        follow_path(hoshino(), path, FollowOptions(dof=4, payload=40.0))
    with pytest.raises(LimitError, match="length of leg"):
        follow_path(hoshino(), path, FollowOptions(dof=4, height=0.6))


@pytest.mark.slow
@pytest.mark.parametrize("dof", [7, 10])
def test_in_contact_dynamics_the_tool_stays_within_millimetres(dof: int) -> None:
    """A tilt of 12 deg carries the plate 76 mm across its feet; where it stands is known by the planted feet alone."""
    felt = follow_path(hoshino(), load_tool_path("wide"), FollowOptions(dof=dof, dynamics=True))
    assert felt.reason == "followed to its end"
    assert felt.errors.max() < 5e-3
    assert np.ptp(felt.q[:, 0]) > 0.05
    bare = follow_path(hoshino(), load_tool_path("wide"), FollowOptions(dof=dof, dynamics=True, felt=False))
    # where no limit holds it back: the first half of the path, which both follow
    rms = []
    for run in (felt, bare):
        early = (run.on_path > 0.0) & (run.wanted[:, 1] < 0.0)
        rms.append(np.sqrt(np.mean(np.sum((run.places - run.wanted)[early] ** 2, axis=1))))
    assert rms[0] < 0.6 * rms[1]
    assert bare.off_end > 0.02  # it sags so far that the path waits for it in vain


def test_the_circle_is_followed_in_contact_dynamics() -> None:
    run = follow_path(hoshino(), load_tool_path("circle"), FollowOptions(dof=10, dynamics=True, speed=0.15))
    assert run.reason == "followed to its end"
    assert run.errors.max() < 3e-3
    assert run.errors.max() > 1e-4  # feet and legs give

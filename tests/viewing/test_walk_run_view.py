"""Pictures of walks: parts where the simulation has them, footprints where feet came down, files that can be opened."""

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from clamber.families.walker.execution.true_walk import TracedPlant, TrueWalk
from clamber.families.walker.execution.walk_scene import plate_axes
from clamber.families.walker.pictures.walk_run_view import WalkRunView, footprints
from clamber.families.walker.pictures.walker_motion import shapes_at
from clamber.families.walker.robot import WalkerRobot
from clamber.families.walker.sim.walker_flaws import WalkerFlaws
from clamber.families.walker.sim.walker_plant import WalkerSim
from clamber.families.walker.world.ground import Ground, load_ground
from clamber.tasks.robots import load_robot
from clamber.viewing.output import SuffixError
from clamber.viewing.pictures import write_run_picture


@pytest.fixture(scope="module")
def robot() -> WalkerRobot:
    found = load_robot("hoshino")
    assert isinstance(found, WalkerRobot)
    return found


@pytest.fixture(scope="module")
def walk(robot: WalkerRobot) -> TrueWalk:
    """The Y-frame lifts a little, turns a little, and comes down."""
    plant = TracedPlant(WalkerSim(robot, Ground(name="level"), WalkerFlaws()))
    assert robot.arm is not None
    legs, arm = np.full((2, 3), 0.35), np.array(robot.arm.rest)
    plant.reset(np.array((0.1, 0.2, 0.35, 0.4, 0.0, 0.0)), np.zeros(3), legs, arm)
    for to, aims in ((0.34, 0.0), (0.34, 0.004), (0.35, 0.004)):
        legs[1] = to
        for _ in range(120):
            plant.actuate(plant.sense().actuators * 0 + 0.2384 + aims, legs, arm)
            plant.step()
    return plant.trace()


def test_parts_are_drawn_where_the_simulation_has_them(robot: WalkerRobot, walk: TrueWalk) -> None:
    for k in (0, 150, len(walk.time) - 1):
        at = shapes_at(robot, walk, k)
        lengths = np.linalg.norm(at.legs[:, :, 0] - at.legs[:, :, 1], axis=-1)
        assert np.all((lengths > 0.335) & (lengths < 0.352))
        upright = at.legs[:, :, 0, :2] - at.legs[:, :, 1, :2]
        np.testing.assert_allclose(upright, 0.0, atol=2e-3)  # what feet give way and the plate tilts
        ends = np.linalg.norm(at.actuators[:, 0] - at.actuators[:, 1], axis=-1)
        assert np.all((ends > 0.238) & (ends < 0.2426))
    assert shapes_at(robot, walk, 150).touching.tolist() == [[1, 1, 1], [0, 0, 0]]


def test_footprints_are_where_feet_came_down(walk: TrueWalk) -> None:
    assert [len(spots) for spots in footprints(walk, 0)] == [1, 1, 1]
    assert [len(spots) for spots in footprints(walk, 1)] == [2, 2, 2]
    for i, spots in enumerate(footprints(walk, 1)):
        np.testing.assert_allclose(spots[-1], walk.feet[-1, 1, i, :2], atol=1e-4)


def test_the_plate_s_axes_are_a_turn() -> None:
    axes = plate_axes(0.3, -0.2, 0.5)
    np.testing.assert_allclose(axes @ axes.T, np.eye(3), atol=1e-15)
    assert axes[2, 0] == pytest.approx(math.sin(0.2))


@pytest.mark.parametrize("ground", ["level", "slope", "ditch"])
def test_walks_are_drawn_as_the_suffix_says(robot: WalkerRobot, walk: TrueWalk, ground: str, tmp_path: Path) -> None:
    view = WalkRunView(robot, load_ground(ground), walk, "a walk")
    for suffix in (".gif", ".png") if ground == "level" else (".png",):
        write_run_picture(view, tmp_path / f"walk{suffix}")
        with Image.open(tmp_path / f"walk{suffix}") as picture:
            assert min(picture.size) > 300
    if ground == "level":
        with Image.open(tmp_path / "walk.gif") as moving:
            assert getattr(moving, "n_frames", 1) == 7  # a second of the walk each
    with pytest.raises(SuffixError):
        write_run_picture(view, tmp_path / "walk.html")


FAR = ((1.0, 0.0), (2.0, 0.0), (0.0, 2.0))


@pytest.mark.parametrize(
    "end", [(0.1, 0.0), *(pytest.param(end, marks=pytest.mark.slow) for end in ((1.2, 1.2), *FAR))]
)
def test_views_fill_the_picture_whatever_the_way(
    robot: WalkerRobot, walk: TrueWalk, end: tuple[float, float], tmp_path: Path
) -> None:
    """Both views keep their scales equal; four fifths and more of the place that they are given is theirs."""
    gone = np.linspace(0.0, 1.0, len(walk.time))[:, None] * (*end, 0.0)
    moved = replace(
        walk,
        pose=walk.pose + np.hstack([gone, np.zeros_like(gone)]),
        feet=walk.feet + gone[:, None, None],
        centre=walk.centre + gone,
        tool=walk.tool + gone,
    )
    view = WalkRunView(robot, load_ground("level"), moved, "a walk")
    view.figure.savefig(tmp_path / "walk.png", dpi=50)
    for axes in (view.side, view.top):
        given, taken = axes.get_position(original=True), axes.get_position()
        assert taken.width > 0.8 * given.width
        assert taken.height > 0.8 * given.height
    assert view.figure.get_size_inches()[1] < 11.0

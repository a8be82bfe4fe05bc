"""A robot in space knows where it is, by its encoders, its IMU and the contacts that stay where they are, and learns where holds are."""

import math

import numpy as np
import pytest
from standing import Standing

from clamber.control.whole_body.tree import State
from clamber.families.spatial.control.base_filter import BaseFilter, FilterSettings
from clamber.families.spatial.control.believed_tree import believed_tree
from clamber.families.spatial.execution.estimated_base import EstimatedBase
from clamber.families.spatial.execution.plant import Pose
from clamber.families.spatial.sim.spatial_flaws import SpatialFlaws
from clamber.types import Floats

NOISE = SpatialFlaws(
    backlash=math.radians(0.5),
    delay=0.005,
    encoder_step=math.tau / 2**14,
    gyro_noise=0.005,
    gyro_bias=0.005,
    accelerometer_noise=0.05,
    accelerometer_bias=0.05,
    seed=3,
)


class Swaying(Standing):
    """A robot that sways on its holds while it works out where it is."""

    def __init__(self, name: str, flaws: SpatialFlaws) -> None:
        super().__init__(name, flaws)
        tree = believed_tree(self.robot, self.task.world.gravity)
        late, coarse = flaws.late * self.plant.period, flaws.encoder_step > 0.0
        self.belief = EstimatedBase(self.robot, self.task.world, tree, self.plant.period, late=late, coarse=coarse)
        self.state = State.of(tree)
        self.belief.begin(self.pose, self.plant.sense())

    def sway(self, seconds: float) -> Floats:
        """Errors of position [m], attitude [rad] and velocity [m/s] tick by tick, shape (ticks, 3)."""
        found, held = [], self.held.astype(np.int32)
        at_rest = self.joints.copy()
        for tick in range(round(seconds / self.plant.period)):
            true = self.plant.truth()
            sensed = self.plant.sense()
            self.belief.update(sensed, held, self.state)
            turned = self.state.rotation @ true.pose.rotation.T
            angle = math.acos(min(1.0, (float(np.trace(turned)) - 1.0) / 2.0))
            moved = np.linalg.norm(self.state.speed[:3] - true.velocity[:3])
            found.append((np.linalg.norm(self.state.position - true.pose.position), angle, moved))
            self.joints = at_rest + 0.05 * math.sin(4.0 * tick * self.plant.period)
            angles, speeds = sensed.joints
            wanted = 3.0 * (self.joints - angles) - 0.05 * speeds
            self.plant.actuate(self.limits * np.clip(wanted, -1.0, 1.0))
            self.plant.step()
        return np.array(found)


def test_with_sensors_without_noise_the_estimate_is_right() -> None:
    robot = Swaying("corners-magnet", SpatialFlaws())
    errors = robot.sway(2.0)
    assert np.abs(errors[-400:, 0]).max() < 1e-3
    assert np.abs(errors[-400:, 1]).max() < 1e-3
    assert np.abs(errors[-400:, 2]).max() < 5e-3


@pytest.mark.slow
def test_with_play_noise_and_delay_it_stays_near() -> None:
    """Play of 0.5 deg at the joints of limbs of half a metre moves the body by millimetres that no encoder tells."""
    robot = Swaying("corners-magnet", NOISE)
    errors = robot.sway(6.0)
    assert np.sqrt(np.mean(errors[:, 0] ** 2)) < 6e-3
    assert np.sqrt(np.mean(errors[:, 1] ** 2)) < math.radians(1.0)


def test_a_touch_corrects_the_map_of_holds() -> None:
    """A hold that the map has 5 mm off is found where it is, but for what is not known of the body."""
    robot = Swaying("corners-magnet", SpatialFlaws())
    hold = int(robot.held[0])
    true = robot.belief.places[hold].copy()
    robot.belief.places[hold] += (0.005, 0.0, 0.0)
    robot.sway(1.0)
    robot.held[0] = -1  # believed to have let go
    robot.sway(0.05)
    assert np.linalg.norm(robot.belief.places[hold] - true) < 2.5e-3


@pytest.mark.parametrize(("name", "least", "most"), [("wall-gripper", 0.0, 2.5e-3), ("corners-magnet", 5e-3, 9e-3)])
def test_touches_of_what_centres_itself_tell_the_place_along_the_surface(name: str, least: float, most: float) -> None:
    """Jaws draw themselves to their holds, whose places the map has; magnets stay where they land, so 8 mm stay 8 mm."""
    robot = Swaying(name, SpatialFlaws())
    normal = robot.task.world.normals[int(robot.held[0])]
    aside = np.cross(normal, (1.0, 0.2, 0.1))
    off = 8e-3 * aside / np.linalg.norm(aside)
    robot.belief.begin(Pose(robot.pose.rotation, robot.pose.position + off), robot.plant.sense())
    taken = robot.held.copy()
    for limb in (0, 1, 2, 3) * 3:
        robot.held[limb] = -1  # believed to have let go, and to have closed again
        robot.sway(0.02)
        robot.held[limb] = taken[limb]
        robot.sway(0.05)
    assert least <= np.linalg.norm(robot.state.position - robot.plant.truth().pose.position) <= most


@pytest.mark.parametrize(("directed", "drifts"), [(0, False), (1, True)])
def test_a_step_turns_the_robot_unnoticed_only_by_holds_that_keep_their_direction(directed: int, drifts: bool) -> None:
    """What feet added to what is not known of the heading let touches move the robot by centimetres that it had not gone."""
    filter = BaseFilter(
        4, (-1.0, 0.0025), np.full(4, directed, np.int32), np.array((0.0, 0.0, -9.81)), FilterSettings()
    )
    filter.begin(np.eye(3), np.zeros(3))
    before = filter.believed.covariance[:9, :9].copy()
    for limb in range(4):
        filter.hold_on(limb, np.array((0.2, 0.1, -0.3)), np.eye(3), 1e-6)
    assert (filter.believed.covariance[:9, :9] != before).any() == drifts

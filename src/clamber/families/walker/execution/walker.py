"""A walker on a plant: what it believes of itself, and one tick of sensing, reckoning, levelling and commanding."""

import math
from typing import Final, Protocol

import numpy as np

from ....control.load_shares import over_share
from ....control.loads import plane_slope, sink_together, sink_unevenly
from ....control.support import support_margin
from ....execution.run_report import FallenError as FallenError
from ....execution.run_report import RefusedError as RefusedError
from ....types import Floats, Ints
from ....units import GRAVITY
from ..control.dead_reckoning import leg_places, reckon, soles_in_world
from ..control.inclination import Inclination, InclinometerTrust
from ..control.posture import (
    leg_lengths,
    level_heights,
    move_each,
    move_together,
    rise,
    tilt_of_inclines,
    trim_lag,
    whole_steps,
)
from ..control.walker_balance import mass_centre
from ..robot import FRAME_TITLES, WalkerRobot
from ..robot.two_frames import FOUND, follow_branch
from ..robot.weight import weight_of
from .falls import FallWatch
from .free_base_freedoms import FreeBaseFreedoms
from .own_sensors import OwnSensors
from .plant import WalkerPlant
from .settings import WalkSettings
from .touched_ground import TouchedGround

LEGS: Final = 6
STILL: Final = 0.2
"""A leg whose aim moves by less than this share of its speed is at rest: its error of length is no lag [-]."""
GENTLY: Final = 0.4
"""Share of its legs' speed at which the plate rises and sinks: feet that are lifted would else not come off the ground [-]."""
SLACK: Final = 0.6
"""Errors of a leg's length below this part of its motor's step stay [-]."""
SMOOTHED: Final = 0.3
"""Time constant of the loads that tell how deep feet sink in [s]."""
LEAST_GIVE: Final = 2e-6
"""A foot and its leg sink in by so much at least, where loads are shared [m/N]."""
KICKED: Final = math.radians(0.5)
"""Inclinometers that differ so far from the legs tell of a foot that has slipped off something [rad] ..."""
KICK: Final = 0.3
"""... if they do for so long [s]."""


class ArmTask(Protocol):
    """What the arm does while the robot walks."""

    def aims(self, walker: "Walker") -> Floats:
        """Where its joints go by the end of the coming period, by what the walker believes at this tick, shape (joints,) [rad]."""
        ...

    def ahead(self, walker: "Walker") -> list[Floats]:
        """Postures besides the present one that it may come through before the next step is over [rad]."""
        ...

    def raise_wished(self, walker: "Walker") -> float:
        """By how much higher than walking has it the plate is to be in the coming step [m]."""
        ...


def leg_name(i: int) -> str:
    """What reports call a leg, by its index in arrays of shape (6,)."""
    return f"leg {i % 3 + 1} of the {FRAME_TITLES[i // 3]}"


class Walker:
    """A two-frame walker that keeps its plate's posture, knows where its feet stand, and dead-reckons from them.

    Arrays over legs have shape (6,): the three of the Delta-frame, then those of the Y-frame.

    Args:
        robot: The walker.
        plant: What moves.
        settings: How it walks.
        trust: What is believed of its inclinometers.
        payload: Mass at the tool point that it knows of [kg].
    """

    def __init__(
        self,
        robot: WalkerRobot,
        plant: WalkerPlant,
        *,
        settings: WalkSettings = WalkSettings(),  # noqa: B008  # frozen
        trust: InclinometerTrust = InclinometerTrust(),  # noqa: B008  # frozen
        payload: float = 0.0,
    ) -> None:
        self.robot, self.plant, self.settings, self.payload = robot, plant, settings, payload
        self.period = plant.period
        self.inclination = Inclination(trust, plant.period)
        self.falls = FallWatch(GRAVITY * weight_of(robot, payload=payload).total, plant.period)
        self.sensors = OwnSensors(robot, plant.period)
        self._delta, self._y = robot.attachments()
        self._rest = robot.feet()
        self._room = np.empty((9, 3))
        self.pose, self.place = np.zeros(6), np.zeros(3)
        """Believed: of the plate in the world; of the Y-frame in the Delta-frame."""
        self.stands: Ints = np.zeros(LEGS, np.int32)
        """1 for feet that stand."""
        self.anchors, self.heights = np.zeros((LEGS, 2)), np.zeros(LEGS)
        """Believed: where in the world the feet stand or stood last [m]."""
        self.ground = TouchedGround()
        self.strain = np.zeros(LEGS)
        """By how much more than its even share each leg is to carry while more than three stand [N]; see `over_share`."""
        self.places, self.soles, self.matrix = np.zeros((LEGS, 2)), np.zeros((LEGS, 3)), np.eye(3)
        self.sensed, self.forces, self.readings = np.zeros(LEGS), np.zeros(LEGS), np.zeros(2)
        """Lengths of the legs [m], forces along them [N], inclines [rad], as last sensed."""
        self.lengths, self.commanded = np.zeros(LEGS), np.zeros(LEGS)
        """Of the legs, as wanted now [m]; as commanded: trimmed, in whole steps."""
        self._trims, self._targets = np.zeros(LEGS), np.zeros(LEGS)
        self.free_aims, self.free_speeds = np.zeros(LEGS), np.full(LEGS, robot.legs.speed)
        """Where the legs that do not stand go, and how fast [m], [m/s]."""
        self.height = 0.0
        """Where the plate's height goes [m], slower than the legs can, so that levelling keeps up."""
        self.room = FreeBaseFreedoms()
        """What the present phase leaves of the plate's freedoms."""
        self.wanted = np.zeros(3)
        """Height, beta and gamma of the plate that are kept [m], [rad]."""
        self.actuators = np.zeros(3)
        """Aims of the actuators [m]."""
        self.arm = np.zeros(0 if robot.arm is None else robot.arm.n_joints)
        """Joints of the arm as commanded [rad]."""
        self.arm_aims = self.arm.copy()
        """Where they go, each at its own fastest [rad]."""
        self.arm_task: ArmTask | None = None
        """What gives them at every tick; None: they stay."""
        self.touched: Ints = np.zeros(LEGS, np.int32)
        """For how many samples on end each foot has felt the ground."""
        self.ticks = self.kicks = 0
        self._kicked = 0.0
        self._slope, self._loads = np.zeros(2), np.zeros(LEGS)
        self._most_arm = plant.period * np.array(robot.arm.fastest if robot.arm is not None else ())
        self.left = 0.0
        """The longest way that a standing leg has still to go [m]."""

    @property
    def time(self) -> float:
        """Since the start [s]."""
        return self.ticks * self.period

    def start(
        self, pose: Floats, place: Floats, legs: Floats, arm: Floats | None = None, *, looks: float = 2.0
    ) -> None:
        """Put the robot on the ground and look at the inclinometers for a while.

        Args:
            pose: Of the plate, shape (6,) [m], [rad]; of it the robot believes x, y and the heading.
            place: Of the Y-frame in the Delta-frame, shape (3,) [m], [rad].
            legs: Lengths, shape (6,) or (2, 3) [m].
            arm: Joint angles [rad]; None: those for walking in the robot's file.
            looks: For how long readings are taken before anything moves [s].

        Raises:
            FallenError: If fewer than three feet carry the robot.
        """
        if arm is not None:
            self.arm = np.array(arm, float)
        elif self.robot.arm is not None:
            self.arm = np.array(self.robot.arm.rest)
        self.arm_aims = self.arm.copy()
        self.plant.reset(pose, place, np.asarray(legs, float).reshape(2, 3), self.arm)
        self.sensors.reset()
        self.ticks = self.kicks = 0
        self.lengths[:] = self.commanded[:] = self.free_aims[:] = np.asarray(legs, float).ravel()
        self._trims[:] = 0.0
        self.ground = TouchedGround()
        self.place[:] = place
        self.pose[:2], self.pose[3] = pose[:2], pose[3]
        self.stands[:] = 0
        readings = []
        for _ in range(max(1, round(looks / self.period))):
            sensed = self.sensors.read(self.plant.sense())
            readings.append(np.array(sensed.inclines))
            self.actuators[:] = sensed.actuators
            self.plant.step()
            self.ticks += 1
        self._take_in()
        self.sensors.monitor.after_pause()  # the first tick reads the same once more
        self.stands[:] = self.forces > self.settings.touch
        if self.stands.sum() < 3:
            raise FallenError(f"at the start only {self.stands.sum()} feet carry the robot")
        self.pose[4:] = tilt_of_inclines(*(np.mean(readings, axis=0) - self.inclination.offsets))
        leg_places(self._rest, self.place, self.places)
        for i in range(LEGS):
            self.heights[i] = rise(self.pose[4], self.pose[5], self.places[i, 0], self.places[i, 1], self.sensed[i])
        self.pose[2] = -self.heights[self.stands > 0].mean()
        self.heights += self.pose[2]
        soles_in_world(self.pose, self.places, self.sensed, self.soles, self.matrix)
        self.anchors[:] = self.soles[:, :2]
        for k in np.flatnonzero(self.stands):
            self.ground.add(self.anchors[k], float(self.heights[k]))
        self._slope, self._loads = self._load_slope(), self.forces.copy()
        self.wanted[:] = self.pose[2], self.pose[4], self.pose[5]
        self.height = self.wanted[0]
        self._trims[:] = np.where(self.stands, self.commanded - self.sensed, 0.0)
        self.lengths[:] = np.where(self.stands, self.sensed, self.commanded)

    def tick(self) -> None:
        """Sense, reckon, command, step.

        Raises:
            FallenError: If the robot falls.
            FaultError: If a sensor, a motor or the link to the plant has failed.
        """
        self._take_in()
        self._sink(min(1.0, self.period / SMOOTHED))
        if not self._reckon():
            raise FallenError(f"only {self.stands.sum()} feet stand")
        self._see_inclines()
        self._share_load()
        self._hold_posture()
        move_each(self.lengths, self.free_aims, self.free_speeds * self.period, self.stands)
        self._move_arm()
        legs = self.robot.legs
        most = legs.speed * self.period
        whole_steps(self.lengths + self._trims, legs.resolution, legs.shortest, legs.longest, most, self.commanded)
        self.plant.actuate(self.actuators, self.commanded.reshape(2, 3), self.arm)
        self.plant.step()
        self.ticks += 1

    def wait(self, seconds: float) -> None:
        """Let time pass [s]."""
        for _ in range(round(seconds / self.period)):
            self.tick()

    def land(self, i: int) -> None:
        """A foot is on the ground and stays where it is."""
        self._stand_on(i, 1)
        self._loads[i] = self.forces[i]
        self.anchors[i], self.heights[i] = self.soles[i, :2], self.soles[i, 2]
        self.ground.add(self.anchors[i], float(self.heights[i]))
        self._trims[i], self.lengths[i] = self.commanded[i] - self.sensed[i], self.sensed[i]

    def leave(self, i: int) -> None:
        """A foot no longer counts as standing; its leg stays as long as it is until `free_aims` says otherwise."""
        self._stand_on(i, 0)
        self.lengths[i] = self.free_aims[i] = self.commanded[i]
        self._trims[i] = 0.0

    def frames(self) -> Floats:
        """Both frames seen from above, as believed: x, y [m] and heading [rad], shape (2, 3)."""
        y = self.pose[:2] + self.matrix[:2, :2] @ self.place[:2]
        return np.array([[self.pose[0], self.pose[1], self.pose[3]], [y[0], y[1], self.pose[3] + self.place[2]]])

    def centre(self) -> Floats:
        """Believed centre of mass, world frame, shape (3,) [m]."""
        return mass_centre(self.robot, self.pose, self.place, self.arm, self.payload)

    def margin(self, stands: Ints | None = None) -> float:
        """How far the centre of mass lies inside the standing feet, or inside others [m]."""
        return float(support_margin(self.soles, self.stands if stands is None else stands, self.centre()))

    def postures(self) -> list[Floats]:
        """Of the arm, in which the next step has to be in balance: as it is now, and as its task may have it on the way [rad]."""
        return [self.arm.copy(), *([] if self.arm_task is None else self.arm_task.ahead(self))]

    def tilt(self) -> float:
        """Angle of the plate from the horizontal, as believed [rad]."""
        return math.acos(min(1.0, float(self.matrix[2, 2])))

    def of_frame(self, frame: int) -> range:
        """Indices of a frame's legs."""
        return range(3 * frame, 3 * frame + 3)

    def on_ground(self, frame: int) -> list[int]:
        """Legs of a frame that stand or feel the ground."""
        return [i for i in self.of_frame(frame) if self.stands[i] or self.forces[i] > self.settings.touch]

    def ground_slope(self) -> Floats:
        """How the ground rises along the world's x and y, by the plane through the feet that stand, shape (2,) [-]; flat with too few."""
        return np.array(plane_slope(self.anchors, self.heights, self.stands))

    def targets(self, posture: Floats, heights: Floats) -> Floats:
        """Lengths of all legs with the plate at z [m], beta, gamma [rad] over these heights, shape (6,) [m]."""
        z, beta, gamma = posture
        lengths = np.empty(LEGS)
        leg_lengths(z, beta, gamma, self.places, heights, lengths)
        return lengths

    def _take_in(self) -> None:
        sensed = self.sensors.read(self.plant.sense())
        self.sensed[:], self.forces[:] = sensed.legs.ravel(), sensed.forces.ravel()
        self.readings[:] = sensed.inclines
        self.touched[:] = np.where(self.forces > self.settings.touch, self.touched + 1, 0)
        self.sensors.follow(self.actuators, self.commanded, self.arm)
        if follow_branch(self._delta, self._y, sensed.actuators, self.place, self._room) != FOUND:
            raise FallenError("the actuators' lengths belong to no posture of the mechanism near the last one")
        leg_places(self._rest, self.place, self.places)

    def _sink(self, share: float) -> None:
        """Standing feet sink in as they take load; a share of what they have not yet is made up for.

        Only the plane through the loads counts. The weight alone decides that; the rest is how six legs strain against each other, and
        legs that answered to it would strain the more. It is smoothed, or it would answer to the robot's rocking on its feet.
        """
        x, y = sink_unevenly(
            share, self.inclination.give, self.pose[3], self.places, self.forces, self.stands, self._slope, self.heights
        )
        self.inclination.sink(np.array((-x, -y)))
        self._settle_in(share)

    def _settle_in(self, share: float) -> None:
        """Feet that take load sink in along the ground's normal, each to the side for itself, and all together downwards.

        How deep single feet go makes the legs share the load or tilts the plate, and is known from that. What all go together, the plate
        goes, and so does the height at which it is wanted: no leg moves for it.
        """
        down = sink_together(
            share, self.inclination.give, self.forces, self.stands, self._loads, self.anchors, self.heights
        )
        self.height -= down
        self.wanted[0] -= down

    def _load_slope(self) -> Floats:
        """Of the plane through the loads, along the world's axes, for the plate's turn, shape (2,) [N/m]."""
        x, y = plane_slope(self.places, self.forces, self.stands)
        c, s = math.cos(self.pose[3]), math.sin(self.pose[3])
        return np.array((c * x - s * y, s * x + c * y))

    def _stand_on(self, i: int, stands: int) -> None:
        """A foot stands from now on, or does no longer."""
        self._sink(1.0)
        self._reckon()
        self.stands[i] = stands
        self._slope = self._load_slope()
        self.inclination.doubt(self.settings.landing_doubt)

    def _reckon(self) -> bool:
        return bool(
            reckon(
                self.places, self.sensed, self.anchors, self.heights, self.stands, self.pose, self.soles, self.matrix
            )
        )

    def _see_inclines(self) -> None:
        beta, gamma = self.pose[4], self.pose[5]
        tilted = self.inclination.off(self.readings)
        turn = self.inclination.see(self.readings, beta, gamma)
        if turn != (0.0, 0.0):
            level_heights(beta, gamma, self.places, self.sensed, self.stands, *turn, self.heights)
            self.pose[4] += turn[0]
            self.pose[5] += turn[1]
        why = self.falls.see(self.forces, tilted, self.margin)
        if why:
            raise FallenError(why)
        self._kicked = self._kicked + self.period if tilted > KICKED else 0.0
        if self._kicked > KICK:  # believe the inclinometers at once, even in a slide
            self.kicks += 1
            self._kicked = 0.0
            self.inclination.frozen = False

    def _share_load(self) -> None:
        """Legs that carry too much while all stand are drawn in, others pushed out; the plane through the feet stays.

        While a foot is still on its way down, those that have landed before it are not to take more: four or five feet share a load
        most evenly in a way that may ask one of them to pull.
        """
        if not self.stands.all():
            return
        over = over_share(self.places, self.forces - self.strain, self.stands, self.settings.touch)
        give = max(self.inclination.give, LEAST_GIVE)
        self.heights += self.settings.share * self.period * give * over

    def _hold_posture(self) -> None:
        z, beta, gamma = self.wanted
        leg_lengths(z, beta, gamma, self.places, self.heights, self._targets)
        most = self.robot.legs.speed * self.period
        rise = self.height - self.wanted[0]
        self.wanted[0] += min(GENTLY * most, max(-GENTLY * most, rise))
        before = self.lengths.copy()
        self.left = abs(rise) + move_together(self.lengths, self._targets, self.stands, most)
        trim_lag(
            self.lengths, self.sensed, (before, self.wanted[0] - z), self.stands, STILL * most,
            SLACK * self.robot.legs.resolution, self.settings.trim * self.period, self._trims,
        )  # fmt: skip

    def _move_arm(self) -> None:
        if self.robot.arm is not None:
            if self.arm_task is not None:
                self.arm_aims[:] = self.arm_task.aims(self)
            self.arm += np.minimum(np.maximum(self.arm_aims - self.arm, -self._most_arm), self._most_arm)

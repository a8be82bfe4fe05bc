"""A walker without dynamics: stiff legs push on the ground, and the plate lies where their forces carry the weight.

Quasi-static: at each tick the height and tilt of the plate are those at which the springs of the legs that press on the ground balance the
weight at the centre of mass; feet that press stay where they touched the ground, and the plate is where they let it be on the whole. It
tips when the centre of mass leaves the standing feet. It shares no code with what the controller believes.
"""

import math
from collections.abc import Callable

import numpy as np

from clamber.families.walker.execution.plant import WalkerSensed, WalkerTruth
from clamber.families.walker.robot import WalkerRobot
from clamber.types import Floats

STIFFNESS = 5e5
"""Of a leg [N/m]."""
LATE = 0.2
"""Time constant of the inclinometers [s]."""
SOFT = np.diag((1e-3, 5e-5, 5e-5))
"""Of all legs' stiffness, so that a plate that no leg bears goes down in steps [-]."""
PERIOD = 0.02
Ground = Callable[[float, float], float]
"""Height of the ground at x, y [m]."""


def flat(x: float, y: float) -> float:
    return 0.0


def slope(angle: float, direction: float = 0.0) -> Ground:
    """Ground that rises by an angle in a direction of the world [rad]."""
    return lambda x, y: math.tan(angle) * (math.cos(direction) * x + math.sin(direction) * y)


def tiles(size: float, height: float, seed: int) -> Ground:
    """Square tiles whose heights are even chances between -height and height [m]."""

    def ground(x: float, y: float) -> float:
        key = (math.floor(x / size) + 10_000, math.floor(y / size) + 10_000, seed)
        return float(np.random.default_rng(key).uniform(-height, height))

    return ground


def rotation(axis: int, angle: float) -> Floats:
    c, s = math.cos(angle), math.sin(angle)
    if axis == 0:
        return np.array(((1.0, 0.0, 0.0), (0.0, c, -s), (0.0, s, c)))
    if axis == 1:
        return np.array(((c, 0.0, s), (0.0, 1.0, 0.0), (-s, 0.0, c)))
    return np.array(((c, -s, 0.0), (s, c, 0.0), (0.0, 0.0, 1.0)))


class SpringsWalker:
    """The plant.

    Args:
        robot: The walker.
        ground: What it stands on.
        noise: Standard deviation of an inclinometer's reading [rad].
        offsets: What they read too much [rad].
        payload: At the tool point [kg].
        give: By how much the ground gives way to a foot [m/N]; legs give way, too, but that is sensed.
        seed: Of the noise.
    """

    period = PERIOD

    def __init__(
        self, robot: WalkerRobot, ground: Ground = flat, *, noise: float = 0.0, offsets: tuple[float, float] = (0.0, 0.0),
        payload: float = 0.0, give: float = 7e-6, seed: int = 0,
    ) -> None:  # fmt: skip
        self.robot, self.ground, self.payload = robot, ground, payload
        self.stiffness = 1.0 / (1.0 / STIFFNESS + give)
        self.places = robot.attachments()
        self.rest = robot.feet()
        self.noise, self.offsets = noise, np.array(offsets)
        self.random = np.random.default_rng(seed)
        self.actuators, self.legs, self.arm = np.zeros(3), np.zeros(6), np.zeros(0)
        self.fallen = False
        self.dragged = 0.0
        """The farthest that a standing foot was dragged by the others in a tick [m]."""
        self.fastest = np.zeros(2)
        """Of actuators and legs, as commanded [m/s]."""
        self.pauses = 0

    def reset(self, pose: Floats, place: Floats, legs: Floats, arm: Floats) -> None:
        self.time, self.fallen = 0.0, False
        self.place, self.arm = np.array(place, float), np.array(arm, float)
        self.legs = np.array(legs, float).ravel()
        self.actuators = self._lengths(self.place)
        self.turn = rotation(2, pose[3]) @ rotation(1, pose[4]) @ rotation(0, pose[5])
        self.at = np.array(pose[:3], float)
        self.anchors: dict[int, Floats] = {}
        feet = self._feet()
        self.at[2] += max(self.ground(x, y) - z for x, y, z in feet)
        self.forces = np.zeros(6)
        for _ in range(400):  # come to rest
            self._rest()
        self.wander, self.late = self.noise * self.random.standard_normal(2), self._inclines()

    def sense(self) -> WalkerSensed:
        return WalkerSensed(
            time=self.time, actuators=self.actuators.copy(), legs=(self.legs - self.forces / STIFFNESS).reshape(2, 3),
            forces=self.forces.reshape(2, 3).copy(), inclines=self.late + self.offsets + self.wander, arm=self.arm.copy(),
        )  # fmt: skip

    def actuate(self, actuators: Floats, legs: Floats, arm: Floats) -> None:
        self.fastest[0] = max(self.fastest[0], np.abs(actuators - self.actuators).max() / PERIOD)
        self.fastest[1] = max(self.fastest[1], np.abs(legs.ravel() - self.legs).max() / PERIOD)
        spec, mechanism = self.robot.legs, self.robot.mechanism
        assert np.all(legs >= spec.shortest - 1e-9) and np.all(legs <= spec.longest + 1e-9)
        assert np.all(actuators >= mechanism.shortest - 1e-9) and np.all(actuators <= mechanism.longest + 1e-9)
        self.actuators, self.legs, self.arm = np.array(actuators), np.array(legs).ravel(), np.array(arm)

    def step(self) -> None:
        self.time += PERIOD
        if not self.fallen:
            self._slide()
            self._rest()
        share = PERIOD / LATE
        self.late = self.late + share * (self._inclines() - self.late)
        kick = self.random.standard_normal(2)
        self.wander = (1.0 - share) * self.wander + self.noise * math.sqrt(2.0 * share - share * share) * kick

    def pause(self) -> None:
        self.pauses += 1

    def truth(self) -> WalkerTruth:
        t = self.turn
        angles = math.atan2(t[1, 0], t[0, 0]), -math.asin(t[2, 0]), math.atan2(t[2, 1], t[2, 2])
        upward = np.zeros((6, 3))
        upward[:, 2] = self.forces
        return WalkerTruth(
            pose=np.array((*self.at, *angles)), place=self.place.copy(), feet=self._feet().reshape(2, 3, 3),
            touching=(self.forces > 0.0).astype(np.int32).reshape(2, 3), forces=upward.reshape(2, 3, 3),
            centre=self.centre(), tool=np.full(3, np.nan), thrusts=np.zeros(3),
        )  # fmt: skip

    def centre(self) -> Floats:
        """Centre of mass in the world."""
        return np.asarray(self.at + self.turn @ self._centre())

    def _centre(self) -> Floats:
        """Of mass, from the plate's own frame, added up part by part."""
        robot = self.robot
        share, height = robot.mass.share_delta, robot.mass.height
        parts = [
            (robot.mass.frames * share, np.array((0.0, 0.0, height))),
            (robot.mass.frames * (1.0 - share), np.array((self.place[0], self.place[1], height))),
        ]
        if robot.arm is not None:
            aside = np.array((math.cos(self.arm[0]), math.sin(self.arm[0]), 0.0))
            point = robot.arm.out * aside + np.array((0.0, 0.0, robot.arm.up))
            pitch = 0.0
            for length, mass, angle in zip(robot.arm.links, robot.arm.masses, self.arm[1:], strict=True):
                pitch += angle
                link = length * (math.cos(pitch) * aside + np.array((0.0, 0.0, math.sin(pitch))))
                parts.append((mass, point + 0.5 * link))
                point = point + link
            parts.append((self.payload, point))
        self.weight = 9.80665 * sum(mass for mass, _ in parts)
        return np.asarray(sum(mass * point for mass, point in parts) / (self.weight / 9.80665))

    def tilt(self) -> float:
        return math.acos(min(1.0, self.turn[2, 2]))

    def _lengths(self, place: Floats) -> Floats:
        (ax, ay), (bx, by) = self.places[0].T, self.places[1].T
        x, y, c, s = place[0], place[1], math.cos(place[2]), math.sin(place[2])
        return np.asarray(np.hypot(x + (c * bx - s * by) - ax, y + (s * bx + c * by) - ay))

    def _slide(self) -> None:
        """The place that fits the actuators, by Gauss-Newton with differences."""
        for _ in range(10):
            error = self.actuators - self._lengths(self.place)
            if np.abs(error).max() < 1e-12:
                break
            columns = [(self._lengths(self.place + d) - self._lengths(self.place - d)) / 2e-6 for d in 1e-6 * np.eye(3)]
            self.place = self.place + np.linalg.solve(np.array(columns).T, error)

    def _feet(self) -> Floats:
        """Soles of the legs as long as they would be without load, world."""
        return np.asarray(self.at + self._soles() @ self.turn.T)

    def _soles(self) -> Floats:
        """The same from the plate's own frame."""
        soles, c, s = np.empty((6, 3)), math.cos(self.place[2]), math.sin(self.place[2])
        x, y = self.rest[1].T
        soles[:3, :2] = self.rest[0]
        soles[3:, 0] = self.place[0] + (c * x - s * y)
        soles[3:, 1] = self.place[1] + (s * x + c * y)
        soles[:, 2] = -self.legs
        return soles

    def _inclines(self) -> Floats:
        return np.array((math.asin(self.turn[2, 0]), math.asin(self.turn[2, 1])))

    def _rest(self) -> None:
        self._over_anchors()
        soles, middle = self._soles(), self._centre()  # neither changes while the plate moves over its feet
        anchored = {i: self.ground(*place) for i, place in self.anchors.items()}
        rows = np.ones((3, 6))
        for _ in range(30):
            arms, centre = soles @ self.turn.T, self.turn @ middle
            places, heights = (self.at + arms).tolist(), arms[:, 2] + self.at[2]
            under = [anchored[i] if i in anchored else self.ground(x, y) for i, (x, y, _) in enumerate(places)]
            press = np.maximum(0.0, under - heights)  # by leg and ground together
            rows[1], rows[2] = arms[:, 1], -arms[:, 0]
            wrench = self.stiffness * rows @ press - self.weight * np.array((1.0, centre[1], -centre[0]))
            active = rows[:, press > 0.0]
            move = np.linalg.solve(self.stiffness * (active @ active.T + SOFT), wrench)
            size = max(abs(move[0]) / 0.003, abs(move[1]) / 0.01, abs(move[2]) / 0.01, 1.0)
            self.at[2] += move[0] / size
            self.turn = rotation(0, move[1] / size) @ rotation(1, move[2] / size) @ self.turn
            if self.tilt() > 0.6:
                self.fallen = True
                return
            if np.abs(move).max() < 1e-9:
                break
        self.forces = self.stiffness * press
        feet = self._feet()
        self.anchors = {i: self.anchors.get(i, feet[i, :2].copy()) for i in range(6) if self.forces[i] > 0.0}

    def _over_anchors(self) -> None:
        held = [i for i in self.anchors if self.forces[i] > 5.0]
        if len(held) < 2:
            return
        feet, wanted = self._feet()[held, :2], np.array([self.anchors[i] for i in held])
        a, b = feet - feet.mean(axis=0), wanted - wanted.mean(axis=0)
        angle = math.atan2(float(np.sum(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0])), float(np.sum(a * b)))
        turn = rotation(2, angle)
        middle = np.array((*feet.mean(axis=0), 0.0))
        self.turn = turn @ self.turn
        self.at = turn @ (self.at - middle) + middle
        self.at[:2] += wanted.mean(axis=0) - feet.mean(axis=0)
        off = self._feet()[held, :2] - wanted
        self.dragged = max(self.dragged, float(np.abs(off).max()))

"""The body's test stand: a climber that two limbs hold, its hooks on pegs or fixed to them, and what is asked of it there."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Final, Literal, TypeAlias

import numpy as np

from ....sim.flaw_texts import named_flaws, read_flaws
from ....sim.limb_flaws import LimbFlaws
from ....sim.plant_rules import PlantError
from ....tasks.robots import load_robot
from ....types import Floats
from ....units import INCH
from ..execution.body_gains import BodyGains
from ..execution.climber import Climber
from ..execution.postures import postures
from ..robot.robot import LimbedRobot
from ..sim.climber_model import HookShape
from ..sim.climber_plant import ClimberPlant
from ..world.board import Board
from ..world.library import load_board
from .run_plan import PHYSICS_RATE


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class BodyStand:
    """Which limbs hold what, and where the body starts."""

    robot: LimbedRobot
    board: Board
    pose: Floats
    """Of the body at the start, shape (3,) [m], [rad]."""
    holds: Mapping[str, int]
    """Limb -> number of the hold that it carries the body by."""
    elbows: Mapping[str, int] = field(default_factory=dict)
    """Limb -> side of its elbow."""
    rest: Mapping[str, tuple[float, float]] = field(default_factory=dict)
    """Limb that holds nothing -> its joint angles [rad]."""
    fixed: bool = False
    """Whether the tips are fixed to their holds, so that they can push as well as pull (Bevly 1997, Fig. 4.17)."""
    shape: HookShape = HookShape()  # noqa: RUF009  # frozen
    weight: float = 1.0
    """Of the robot, over what its control believes [-]."""

    def put(self, flaws: LimbFlaws, gains: BodyGains, *, pegs: Floats | None = None) -> tuple[Climber, ClimberPlant]:
        """The climber on its holds, at rest, and the plant that moves it.

        Args:
            flaws: Of the plant.
            gains: Of body and limbs.
            pegs: Where the holds truly are, shape (n_holds, 2) [m]; None: as the board says.
        """
        pinned = self.holds if self.fixed else {}
        robot = replace(self.robot, weight=self.weight * self.robot.weight)
        plant = ClimberPlant(robot, self.board, flaws, pegs=pegs, pinned=pinned, shape=self.shape)
        climber = Climber(self.robot, self.board, plant, gains=gains, backlash=flaws.backlash)
        climber.start(self.pose, self.holds, elbows=self.elbows)
        q = np.array([task.angles for task in climber.body.tasks])
        for i, limb in enumerate(self.robot.limbs):
            if limb.name in self.rest:
                q[i] = self.rest[limb.name]
                climber.body.tasks[i].angles = q[i].copy()
        plant.reset(self.pose, q)
        return climber, plant

    def angles(self, pose: Floats) -> Floats:
        """Joint angles with the body at a pose and all holds held, shape (limbs, 2) [rad].

        Raises:
            PlantError: If a hold is out of reach there.
        """
        q = np.zeros((len(self.robot.limbs), 2))
        places = self.board.places()
        for i, limb in enumerate(self.robot.limbs):
            q[i] = self.rest.get(limb.name, (0.0, 0.0))
            if limb.name in self.holds:
                number = self.holds[limb.name]
                found = postures(limb, pose, places[number])
                if not found:
                    raise PlantError("pose", tuple(map(float, pose)), f"limb {limb.name} must reach hold {number}")
                side = self.elbows.get(limb.name, 0)
                found.sort(key=lambda posture: (posture.angles[1] * side < 0.0, -posture.on_top))
                q[i] = found[0].angles
        return q


def ladder_stand(*, fixed: bool = False, below: float = 0.6 * INCH, hanging: bool = False) -> BodyStand:
    """LIBRA between pegs 3 and 4 of the ladder, its third limb folded beneath it.

    Args:
        fixed: Whether the tips are fixed to their pegs.
        below: How far the body's origin is below the two pegs [m].
        hanging: Whether the left limb alone holds, stretched upwards.
    """
    robot, board = load_robot("libra"), load_board("ladder")
    assert isinstance(robot, LimbedRobot)
    pegs = {hold.number: (hold.x, hold.y) for hold in board.holds}
    folded = {"bottom": (0.6, -1.2)}
    if hanging:
        # nearly beneath the peg: straight beneath it the limb is beyond its joints' limits
        pose = np.array((pegs[3][0] + 0.04, pegs[3][1] - 0.25, 0.0))
        rest = folded | {"right": (0.6, -1.2)}
        return BodyStand(robot=robot, board=board, pose=pose, holds={"left": 3}, elbows={"left": 1}, rest=rest)
    pose = np.array(((pegs[3][0] + pegs[4][0]) / 2, pegs[3][1] - below, 0.0))
    return BodyStand(
        robot=robot,
        board=board,
        pose=pose,
        holds={"right": 4, "left": 3},
        elbows={"right": -1, "left": 1},
        rest=folded,
        fixed=fixed,
    )


def bench_flaws(name: str, settings: Sequence[str] = ()) -> LimbFlaws:
    """The plant of the body's bench: "ideal" or "nominal", with settings such as "backlash=1deg".

    Raises:
        PlantError: If one of them cannot be.
    """
    return read_flaws(named_flaws(name, ladder_stand().robot).with_changes(physics_rate=PHYSICS_RATE), settings)


Kind: TypeAlias = Literal["circle", "push-up", "push"]
SETTLE: Final = 1.0
"""Time in which the body comes to rest at its start before anything is asked of it [s]."""


@dataclass(frozen=True, slots=True, eq=False)
class BodyScenario:
    """The aim of every tick, and the force on the body."""

    kind: Kind
    period: float
    """[s]."""
    aims: Floats
    """Body x, y [m], theta [rad], shape (ticks, 3)."""
    speeds: Floats
    """Of the aims, shape (ticks, 3)."""
    pushes: Floats
    """At the body's centre, world frame, shape (ticks, 2) [N]."""
    begin: int
    """First tick that is measured."""
    centre: tuple[float, float] | None = None
    """Of a circle [m]."""
    radius: float = 0.0

    @property
    def time(self) -> Floats:
        """Of each tick; 0 where the measured part begins [s]."""
        return np.asarray(self.period * np.arange(-self.begin, len(self.aims) - self.begin, dtype=np.float64))


def circle(pose: Floats, period: float, *, radius: float, lap: float, laps: int = 2) -> BodyScenario:
    """Laps of a circle whose lowest point is the pose, the angle held; the last lap is measured.

    Args:
        pose: Of the body at the start, shape (3,).
        period: Of the control [s].
        radius: Of the circle [m].
        lap: Time of one lap [s].
        laps: How many.

    Raises:
        PlantError: If radius or lap is not more than nothing.
    """
    for key, value in (("radius", radius), ("lap", lap)):
        if not 0.0 < value < math.inf:
            raise PlantError(key, value, "must be more than 0")
    count, wait = round(laps * lap / period), round(SETTLE / period)
    phase = 2 * np.pi / lap * period * np.arange(1, count + 1)
    aims = np.tile(pose, (wait + count, 1))
    speeds = np.zeros_like(aims)
    aims[wait:, 0] += radius * np.sin(phase)
    aims[wait:, 1] += radius * (1.0 - np.cos(phase))
    rate = 2 * np.pi / lap * radius
    speeds[wait:, 0], speeds[wait:, 1] = rate * np.cos(phase), rate * np.sin(phase)
    begin = wait + round((laps - 1) * lap / period)
    middle = (float(pose[0]), float(pose[1]) + radius)
    return BodyScenario("circle", period, aims, speeds, np.zeros((len(aims), 2)), begin, middle, radius)


def push_up(pose: Floats, period: float, *, height: float, seconds: float, after: float = 1.5) -> BodyScenario:
    """Straight up, from rest to rest.

    Args:
        pose: Of the body at the start.
        period: Of the control [s].
        height: How far up [m].
        seconds: In that time.
        after: Time that is kept after it [s].

    Raises:
        PlantError: If it takes no time.
    """
    if not 0.0 < seconds < math.inf:
        raise PlantError("seconds", seconds, "must be more than 0 s")
    wait, count, rest = round(SETTLE / period), round(seconds / period), round(after / period)
    u = np.concatenate((np.zeros(wait), np.arange(1, count + 1) / count, np.ones(rest)))
    aims = np.tile(pose, (len(u), 1))
    speeds = np.zeros_like(aims)
    aims[:, 1] += height * u * u * (3 - 2 * u)
    speeds[:, 1] = height * 6 * u * (1 - u) / seconds
    return BodyScenario("push-up", period, aims, speeds, np.zeros((len(aims), 2)), wait)


def push(
    pose: Floats,
    period: float,
    *,
    force: tuple[float, float],
    seconds: float,
    half_sine: bool = True,
    after: float = 2.5,
) -> BodyScenario:
    """Standing still, pushed at the body's centre.

    Args:
        pose: Of the body.
        period: Of the control [s].
        force: Largest, world frame [N].
        seconds: How long it acts.
        half_sine: Whether it grows and goes as half a sine; else it grows and goes over a fifth of the time and is full between.
        after: Time that is kept after it [s].

    Raises:
        PlantError: If it acts for no time.
    """
    if not 0.0 < seconds < math.inf:
        raise PlantError("seconds", seconds, "must be more than 0 s")
    wait, count, rest = round(SETTLE / period), round(seconds / period), round(after / period)
    u = (np.arange(count) + 0.5) / count
    shape = np.sin(np.pi * u) if half_sine else np.minimum(1.0, np.minimum(5 * u, 5 * (1 - u)))
    pushes = np.zeros((wait + count + rest, 2))
    pushes[wait : wait + count] = shape[:, None] * np.array(force)
    aims = np.tile(pose, (len(pushes), 1))
    return BodyScenario("push", period, aims, np.zeros_like(aims), pushes, wait)

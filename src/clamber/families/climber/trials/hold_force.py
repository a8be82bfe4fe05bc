"""A force that is held while the body moves (Bevly 1997, 5.2): two limbs carry, the third presses a wall, the body goes its way."""

from dataclasses import dataclass
from typing import Annotated, Final

import numpy as np

from ....json_form import HIDDEN, Jsonable, Key, in_json
from ....sim.limb_flaws import LimbFlaws, Wall
from ....types import Floats
from ..control.backlash import RESTS
from ..execution.climber import Climber, FallenError
from ..execution.postures import postures
from ..robot.robot import LimbedRobot
from ..sim.climber_plant import ClimberPlant
from ..world.board import Board

POSE: Final = np.array((0.2286, 0.4422, 0.0))
"""Of the body, 15 mm below the two pegs of the ladder that carry [m], [rad]."""
HOLDS: Final = {"right": 8, "left": 7}
ELBOWS: Final = {"right": -1, "left": 1}
PRESSER: Final = "bottom"
AT: Final = np.array((0.16, -0.20))
"""Where its tip presses, from the body at the start [m]: there both joints bear the force well."""
STIFFNESS: Final = 10_000.0
"""Of the wall [N/m]."""
FRICTION: Final = 0.8
"""Of the tip on the wall, as of rubber: it does not slide [-]."""
INTEGRAL: Final = 10.0
"""Of the force's error [1/s]."""
PROPORTIONAL: Final = 2.0
"""Of the force's error [-]."""
DEAD: Final = 0.02
"""An error below this part of the force is not integrated: friction would make it hunt [-]."""
DAMPING: Final = 500.0
"""Of the tip's motion in the world [N s/m]."""
ALONG_WALL: Final = 400.0
"""Stiffness with which the tip keeps its place along the wall [N/m]."""
TOUCH: Final = 5.0
"""Force with which the tip looks for the wall [N]."""
RISE: Final = 0.5
"""In which the force grows to its full size [s]."""
REST: Final = 1.5
"""Before and after the body's way, the force held [s]."""
MEAN: Final = 0.02
"""Over which single knocks are averaged out [s]."""
MOVING: Final = 0.02
"""Joint speed well above which friction is that of motion [rad/s]."""


@dataclass(frozen=True, slots=True, eq=False)
class Pressed(Jsonable):
    """A force held on a wall while the body moved, `rows` ticks long, from when it had risen and settled."""

    wanted: float
    """[N]."""
    time: Annotated[Floats, HIDDEN]
    """Shape (rows,) [s]."""
    force: Annotated[Floats, HIDDEN]
    """True force on the wall, shape (rows,) [N]."""
    body: Annotated[Floats, HIDDEN]
    """True body x, y [m], theta [rad], shape (rows, 3)."""
    aim: Annotated[Floats, HIDDEN]
    """Of the body, shape (rows, 3)."""
    moves: Annotated[tuple[float, float], Key(after="way")]
    """When the body's way began and ended [s]."""
    reason: Annotated[str, Key(after="moves")] = ""
    """Why it ended early: the robot fell; empty if it did not."""

    @property
    @in_json(after="wanted")
    def ripple(self) -> float:
        """Largest difference from the wanted force, over it [-]."""
        return float(np.abs(self.force - self.wanted).max() / self.wanted)

    @property
    @in_json(after="ripple")
    def steady_ripple(self) -> float:
        """The same of the mean over 20 ms, in which single knocks of a joint's play against its end do not show [-]."""
        count = max(1, round(MEAN / float(self.time[1] - self.time[0])))
        means = np.convolve(self.force, np.full(count, 1.0 / count), "valid")
        return float(np.abs(means - self.wanted).max() / self.wanted)

    @property
    @in_json(after="steady_ripple")
    def spread(self) -> float:
        """Root mean square of that difference, over the wanted force [-]."""
        return float(np.sqrt(np.mean((self.force - self.wanted) ** 2)) / self.wanted)

    @property
    @in_json(after="spread")
    def within(self) -> float:
        """Part of the time in which the force is within a tenth [-]."""
        return float(np.mean(np.abs(self.force - self.wanted) <= 0.1 * self.wanted))

    @property
    @in_json(after="within")
    def way(self) -> Annotated[Floats, Key(kind=tuple[float, float])]:
        """What the body truly went, x, y [m], shape (2,)."""
        return self.body[-1, :2] - self.body[0, :2]


def run_press(
    robot: LimbedRobot,
    board: Board,
    flaws: LimbFlaws,
    *,
    force: float = 20.0,
    way: tuple[float, float] = (0.0, 0.05),
    seconds: float = 2.0,
) -> Pressed:
    """Hold a force against a vertical wall while the body goes a straight smooth way.

    The limb brings J^T F with its weight and friction fed forward, friction by the way its joints turn; an integral over the force
    sensor's reading does the rest. The wall's reaction is fed to the limbs that carry.

    Args:
        robot: A LIBRA, with hooks or grippers.
        board: The ladder.
        flaws: Of the plant.
        force: On the wall [N].
        way: Of the body [m].
        seconds: That it takes.
    """
    place = POSE[:2] + AT
    wall = Wall(x=float(place[0]), y=float(place[1]), angle=0.0, stiffness=STIFFNESS, friction=FRICTION)
    plant = ClimberPlant(robot, board, flaws.with_changes(wall=wall), presser=PRESSER)
    climber = Climber(robot, board, plant)
    climber.start(POSE, HOLDS, elbows=ELBOWS)
    return _Press(climber, plant, robot.limb_index(PRESSER), place, force).run(np.array((*way, 0.0)), seconds)


class _Press:
    def __init__(self, climber: Climber, plant: ClimberPlant, limb: int, place: Floats, force: float) -> None:
        self._climber, self._plant, self._i, self._place, self._wanted = climber, plant, limb, place, force
        self._more = 0.0
        self._rows: list[tuple[float, float, Floats, Floats]] = []
        self._keeping = False

    def run(self, change: Floats, seconds: float) -> Pressed:
        climber, body, i = self._climber, self._climber.body, self._i
        moves, reason = (0.0, 0.0), ""
        try:
            self._come_to_the_wall()
            ticks = round(RISE / climber.plant.period)
            for k in range(ticks):
                self._tick(TOUCH + (self._wanted - TOUCH) * (k + 1) / ticks)
            self._hold(REST)
            self._keeping = True
            self._hold(REST)
            began = climber.time
            start, count = body.aim.copy(), round(seconds / climber.plant.period)
            for k in range(1, count + 1):
                u = k / count
                body.aim[:] = start + u * u * (3 - 2 * u) * change
                body.aim_speed[:] = 6 * u * (1 - u) / seconds * change
                self._tick(self._wanted)
            body.aim_speed[:] = 0.0
            moves = began, climber.time
            self._hold(REST)
        except FallenError as fall:
            reason = str(fall)
        assert body.tasks[i].mode == "contact_push"
        time, forces, poses, aims = zip(*self._rows, strict=True)
        return Pressed(self._wanted, np.array(time), np.array(forces), np.array(poses), np.array(aims), moves, reason)

    def _come_to_the_wall(self) -> None:
        """From beside it, gently, until the sensor feels it."""
        climber, task = self._climber, self._climber.body.tasks[self._i]
        limb = climber.robot.limbs[self._i]
        before = self._place - np.array((0.02, 0.0))
        task.angles = next(one.angles for one in postures(limb, climber.body.aim, before) if one.angles[1] < 0.0)
        climber.wait(2.0)
        task.mode, task.pressed = "contact_push", True
        for _ in range(round(3.0 / climber.plant.period)):
            if self._tick(TOUCH) > TOUCH / 2:
                return

    def _hold(self, seconds: float) -> None:
        for _ in range(round(seconds / self._climber.plant.period)):
            self._tick(self._wanted)

    def _tick(self, wanted: float) -> float:
        climber, body, i = self._climber, self._climber.body, self._i
        task, leg = body.tasks[i], body.legs[i]
        angle = body.pose[2] + float(leg["port_angle"]) + float(body.q[i].sum())
        along, across = self._plant.sense_press()
        felt = float(np.cos(angle) * along - np.sin(angle) * across)
        lack = wanted - felt if felt > TOUCH / 4 else 0.0
        if abs(lack) > DEAD * wanted:
            self._more += INTEGRAL * lack * climber.plant.period
        self._more = float(np.clip(self._more, -wanted, wanted))
        aside = ALONG_WALL * (self._place[1] - body.tip(i)[1])
        push = np.array((wanted + PROPORTIONAL * lack + self._more, aside))
        push /= climber.load
        task.force = push + _friction_by_motion(leg, body.q[i], body.qd[i], body.pose[2], push)
        task.tug, task.damping = np.array((wanted / climber.load, 0.0)), DAMPING
        climber.tick()
        if self._keeping:
            self._rows.append((climber.time, self._plant.true_press(), self._plant.truth().pose, body.aim.copy()))
        return felt


def _friction_by_motion(leg: np.void, q: Floats, qd: Floats, angle: float, push: Floats) -> Floats:
    """Force of the tip that feeds friction the way its joints turn, in place of the way that it pushes, world frame [N]."""
    first = angle + float(leg["port_angle"]) + q[0]
    second = first + q[1] + float(leg["beta"])
    x2, y2 = float(leg["l2"]) * np.cos(second), float(leg["l2"]) * np.sin(second)
    x1, y1 = float(leg["l1"]) * np.cos(first), float(leg["l1"]) * np.sin(first)
    jacobian = np.array(((-y1 - y2, -y2), (x1 + x2, x2)))
    wrong = np.tanh(jacobian.T @ push / RESTS)
    torques = np.array((leg["friction1"], leg["friction2"])) * (np.tanh(qd / MOVING) - wrong)
    return np.asarray(np.linalg.solve(jacobian.T, torques))

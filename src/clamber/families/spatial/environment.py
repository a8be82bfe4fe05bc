"""Gymnasium environments of robots in space: torques in, sensors and the planner's plan out, on the plant that `clamber run` uses.

`gymnasium.make("clamber.families.spatial.environment:clamber/Climb-v0")`, or `Walk-v0`, imports this module, which makes both known;
what they reward and when they end stands in docs/environments.md.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, Final

import gymnasium
import numpy as np
from gymnasium import spaces

from ...control.whole_body.tree import State
from ...errors import OptionError, SpecError, StatedError
from ...planning.problem.plan import Plan
from ...planning.problem.plan_source import open_plan
from ...tasks import Task, load_task
from ...trials.dynamics import Conditions, RunEvents
from ...types import Floats, Ints
from .control.believed_tree import believed_tree
from .execution.course import Course, Motion, Regrab
from .execution.estimated_base import EstimatedBase
from .planning.task import SpatialTask
from .sim.spatial_flaws import SpatialFlaws
from .sim.spatial_plant import SpatialSim
from .trials.noise import SpatialNoise
from .trials.planning import found_plan

if TYPE_CHECKING:
    from collections.abc import Sequence

NEAR: Final = 0.03
"""The body is at a stance within this part of the length of the robot's longest limb [-] ..."""
TURNED: Final = 0.15
"""... and this angle [rad]."""
LOST: Final = 0.3
"""A body that is farther from the straight way between two stances than this part of the length of its longest limb has fallen [-]."""
FULL: Final = 10.0
"""Reward of a whole plan."""
PULL: Final = 1.0
"""Reward for a body that has come the length of its longest limb nearer to its next stance."""
STRAIN: Final = 0.002
"""Cost of a second at all torques' limits."""
FALL: Final = -1.0
"""Reward of a fall."""


class SpatialEnv(gymnasium.Env[Any, Any]):
    """A robot in space that is to carry a plan out.

    An action is a number from -1 to 1 for each joint, the part of its torque, then one for each limb: attach above 0, let go below.
    An observation is of the robot's sensors, of where it works out to be, and of what the plan asks for next.

    Args:
        task: Name or file of a task.
        settings: Texts "key=value" that change the task.
        plan: Its plan or a plan's file; None: one is searched for.
        noise: A text or several as of `clamber trials --noise`, such as "usual"; none without.
        ticks: Control periods that an action lasts.
        seconds: An episode lasts so long at most [s]; None: twice what the plan's actions take at one a second.

    Raises:
        OptionError: If `ticks` or `seconds` leave no time.
        ClamberError: If task, settings, plan or noise cannot be used.
    """

    metadata: dict[str, Any] = {"render_modes": []}  # noqa: RUF012  # Gymnasium's own

    def __init__(
        self,
        task: str = "wall-gripper",
        settings: Sequence[str] = (),
        plan: Plan | str | None = None,
        noise: str | Sequence[str] = (),
        ticks: int = 2,
        seconds: float | None = None,
    ) -> None:
        if ticks < 1:
            raise OptionError("ticks", f"{ticks} control periods", "an action lasts 1 or more")
        if seconds is not None and not seconds > 0.0:
            raise OptionError("seconds", f"{seconds} s", "an episode lasts more than 0")
        self.task, self.plan = _planned(task, settings, plan)
        self._noise = SpatialNoise.of("none", (noise,) if isinstance(noise, str) else noise)
        self._ticks = ticks
        robot = self.task.robot
        world = self.task.world
        course = Course.of(self.task, self.plan)
        self.start = course.start
        self.goals: Final = course.motions
        """What the plan asks for, one after another."""
        self._tree = believed_tree(robot, world.gravity)
        self._state = State.of(self._tree)
        chains = robot.chains
        self._limbs, self._n = len(chains.limb_names), self._tree.joints
        self.size = chains.longest_limb
        """Length of the longest limb [m]."""
        self._pull = chains.total_mass * 9.80665
        self._ends = [strength.capture > 0.0 for strength in robot.strengths]
        self.plant = SpatialSim(robot, world)
        self.torques: Floats = self.plant.motors.torque.copy()
        """Largest torque of each joint [N m] or force [N], shape (n,)."""
        actions = max(len(self.plan.actions), 1)
        self._most = math.ceil((2.0 * actions if seconds is None else seconds) / self.period)
        self._at, self._steps, self._away = 0, 0, 0.0
        self._places: Floats = world.places
        """Where holds are, as believed [m], shape (holds, 3)."""
        self.action_space = spaces.Box(-1.0, 1.0, (self._n + self._limbs,), np.float32)
        shape = self._observed().shape
        self.observation_space = spaces.Box(-np.inf, np.inf, shape, np.float32)

    @property
    def period(self) -> float:
        """That an action lasts [s]."""
        return self._ticks * self.plant.period

    @property
    def progress(self) -> float:
        """Part of the plan that has been carried out [-]."""
        return self._at / max(len(self.goals), 1)

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[np.ndarray[Any, np.dtype[np.float32]], dict[str, Any]]:
        """Put the robot at the plan's start, with what a seed makes of the noise."""
        super().reset(seed=seed)
        robot = self.task.robot
        world = self.task.world
        if self._noise.any:
            drawn = int(self.np_random.integers(2**31))
            flaws = self._noise.flaws(SpatialFlaws(), drawn)
            self.plant = SpatialSim(robot, world, flaws, self._noise.deviations(robot, world, drawn))
        flaws = self.plant.flaws
        self._stays = np.full(len(robot.limb_names), -1, np.int32)
        """Index of the hold that each tip stays on, as sensors tell; -1: none, shape (limbs,)."""
        self._belief = EstimatedBase(
            robot,
            world,
            self._tree,
            self.plant.period,
            late=flaws.late * self.plant.period,
            coarse=flaws.encoder_step > 0.0,
            play=flaws.backlash,
        )
        self.plant.reset(self.start.pose, self.start.joints, self.start.holds)
        self._places = self._belief.places
        self._belief.begin(self.start.pose, self.plant.sense())
        self._believe()
        self._at, self._steps = 0, 0
        self._away = self._distance()
        return self._observed(), {"progress": 0.0}

    def step(
        self, action: np.ndarray[Any, np.dtype[np.float32]]
    ) -> tuple[np.ndarray[Any, np.dtype[np.float32]], float, bool, bool, dict[str, Any]]:
        """Let an action last for its ticks."""
        asked = np.clip(np.asarray(action, np.float64), -1.0, 1.0)
        for limb in range(self._limbs):
            if asked[self._n + limb] != 0.0:
                self.plant.grip(limb, bool(asked[self._n + limb] > 0.0))
        self.plant.actuate(asked[: self._n] * self.torques)
        for _ in range(self._ticks):
            self.plant.step()
            self.plant.sense()
            self._believe()
        self._steps += 1
        before = self._at
        while self._at < len(self.goals) and self._reached(self.goals[self._at]):
            self._at += 1
        reward = FULL * (self._at - before) / len(self.goals)
        away = self._distance()
        reward += PULL * (self._away - away) / self.size if self._at == before else 0.0
        self._away = away
        reward -= STRAIN * self.period * float(np.mean(asked[: self._n] ** 2))
        done = self._at == len(self.goals)
        astray = _astray(self._goal(), self._state.position)
        fell = not done and (astray > LOST * self.size or not (self._holding() >= 0).any())
        reward += FALL if fell else 0.0
        told = {"progress": self.progress, "done": done, "fell": fell}
        return self._observed(), float(reward), done or fell, self._steps >= self._most, told

    def _goal(self) -> Motion:
        return self.goals[min(self._at, len(self.goals) - 1)]

    def _holding(self) -> Ints:
        return self.plant.ends.attached

    def _believe(self) -> None:
        sensed = self.plant.sensed
        stands = np.linalg.norm(sensed.wrenches[:, :3], axis=1) > 0.02 * self._pull
        self._stays[:] = np.where(np.where(self._ends, sensed.closed == 1, stands), self._holding(), -1)
        self._belief.update(sensed, self._stays, self._state)

    def _distance(self) -> float:
        return float(np.linalg.norm(self._goal().end.pose.position - self._state.position))

    def _reached(self, goal: Motion) -> bool:
        if isinstance(goal, Regrab):
            return bool(self._holding()[goal.limb] == goal.hold)
        turned = self._state.rotation @ goal.end.pose.rotation.T
        angle = math.acos(min(1.0, max(-1.0, (float(np.trace(turned)) - 1.0) / 2.0)))
        away = float(np.linalg.norm(goal.end.pose.position - self._state.position))
        return away < NEAR * self.size and angle < TURNED

    def _observed(self) -> np.ndarray[Any, np.dtype[np.float32]]:
        """What the robot knows, in its own frame, lengths by its size and forces by its weight."""
        state, sensed, goal = self._state, self.plant.sensed, self._goal()
        turn, aim = state.rotation.T, goal.end
        wanted = turn @ aim.pose.rotation
        hold = np.zeros(3)
        limbs = np.zeros(self._limbs)
        if isinstance(goal, Regrab):
            limbs[goal.limb] = 1.0
            hold = turn @ (self._places[goal.hold] - state.position) / self.size
        down = np.array(self.task.world.gravity)
        towards = aim.pose.position - state.position
        turned = (
            wanted[2, 1] - wanted[1, 2],
            wanted[0, 2] - wanted[2, 0],
            wanted[1, 0] - wanted[0, 1],
        )
        parts = (
            state.joints,
            state.speed[6:],
            turn @ state.speed[:3] / self.size,
            state.speed[3:6],
            turn @ down / max(float(np.linalg.norm(down)), 1e-9),
            sensed.wrenches[:, :3].ravel() / self._pull,
            sensed.closed,
            aim.joints - state.joints,
            turn @ towards / self.size,
            0.5 * np.array(turned),
            limbs,
            hold,
            [self.progress],
        )
        told = [np.ravel(part) for part in parts]
        return np.concatenate(told, dtype=np.float32, casting="same_kind")


def _astray(motion: Motion, position: Floats) -> float:
    """How far a body is from the straight way of a motion [m]."""
    begin = motion.start.pose.position
    way = motion.end.pose.position - begin
    gone = position - begin
    square, part = float(way @ way), 0.0
    if square > 0.0:
        part = min(1.0, max(0.0, float(gone @ way) / square))
    return float(np.linalg.norm(gone - part * way))


def _planned(name: str, settings: Sequence[str], plan: Plan | str | None) -> tuple[SpatialTask, Plan]:
    """A task and its plan.

    Raises:
        NoPlanError: If none was found.
        ClamberError: If there is no such task or plan, or if it is no robot in space's.
    """
    if isinstance(plan, str):
        opened = open_plan(plan, name, list(settings))
        task = opened.task
        plan = opened.plan
    else:
        task = _loaded(name, settings)
    if not isinstance(task, SpatialTask):
        raise NotInSpaceError(name)
    return task, found_plan(task, Conditions(), RunEvents(), seed=0) if plan is None else plan


def _loaded(name: str, settings: Sequence[str]) -> Task:
    """A task; where settings do not fit it because it is of another family, that is said."""
    try:
        return load_task(name, list(settings))
    except SpecError:
        if isinstance(load_task(name), SpatialTask):
            raise
        raise NotInSpaceError(name) from None


class NotInSpaceError(StatedError):
    """The task is of another family."""

    says = "task '{task}': environments are of robots in space, such as 'wall-gripper' or 'stones-quadruped'"
    task: str


def _register() -> None:
    """Make the environments known to Gymnasium by their names."""
    entry = f"{__name__}:SpatialEnv"
    for name, task, goal in (("Climb", "wall-gripper", "0.3 m"), ("Walk", "stones-quadruped", "0.5 m")):
        near = (f"goal.along_min={goal}",)
        gymnasium.register(f"clamber/{name}-v0", entry, kwargs={"task": task, "settings": near})


_register()  # `gymnasium.make("module:name")` imports the module for this

"""Our own controller in an environment of `environment.py`, by the actions that a learner has: what learning is to be held against."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from ...execution.plant import PlantStoppedError
from ...execution.sequencer import Sequencer
from .control.laws import USUAL
from .execution.carrying import Carrying
from .execution.course import Course
from .trials.run_plan import body_of

if TYPE_CHECKING:
    from collections.abc import Sequence

    from ...types import Floats, Ints
    from .environment import SpatialEnv
    from .execution.plant import Pose, SpatialSensed, SpatialTruth


@dataclass(frozen=True, slots=True)
class Episode:
    """What became of an episode."""

    total: float
    """Of all rewards [-]."""
    seconds: float
    """Simulated."""
    progress: float
    """Part of the plan that was carried out [-]."""
    done: bool
    reason: str
    """Why it was not done; empty where it was."""


@dataclass(slots=True)
class EnvironmentPlant:
    """An environment whose episode has begun, as the plant of our controller, a `SpatialPlant`: each of its periods is one action."""

    env: SpatialEnv
    total: float = 0.0
    told: dict[str, Any] = field(default_factory=dict)
    """What the last action's environment told."""
    period: float = field(init=False)
    """That an action lasts [s]."""
    _action: np.ndarray[Any, np.dtype[np.float32]] = field(init=False)

    def __post_init__(self) -> None:
        env = self.env
        self.period, self._action = env.period, np.zeros(len(env.torques) + len(env.task.robot.limb_names), np.float32)

    def reset(self, pose: Pose, joints: Floats, held: Sequence[int] | Ints) -> None:
        """See `SpatialPlant`: the episode has begun at the plan's start."""

    def sense(self) -> SpatialSensed:
        """What was sensed last: the environment reads the sensors at every tick."""
        return self.env.plant.sensed

    def actuate(self, torques: Floats) -> None:
        """See `SpatialPlant`."""
        self._action[: len(torques)] = torques / self.env.torques

    def grip(self, limb: int, close: bool) -> None:
        """See `SpatialPlant`: with the next action."""
        self._action[len(self.env.torques) + limb] = 1.0 if close else -1.0

    def brake(self, joint: int) -> None:
        """See `SpatialPlant`: nothing to do, as nothing fails in an environment."""

    def pause(self) -> None:
        """See `SpatialPlant`: nothing to do, as time stands still meanwhile."""

    def step(self) -> None:
        """Act once.

        Raises:
            PlantStoppedError: If the episode has ended.
        """
        _, reward, ended, late, self.told = self.env.step(self._action)
        self._action[len(self.env.torques) :] = 0.0
        self.total += reward
        if ended or late:
            raise PlantStoppedError("the episode is over" if ended else "its time is over")

    def truth(self) -> SpatialTruth:
        """How things really are."""
        return self.env.plant.truth()


def carry_out(env: SpatialEnv, seed: int, law: str = USUAL) -> Episode:
    """An episode in which our controller carries the environment's plan out.

    Args:
        env: As `gymnasium.make(...).unwrapped`.
        seed: Of the episode.
        law: Of the whole body, by name.

    Raises:
        UnknownNameError: If there is no such law.
    """
    env.reset(seed=seed)
    plant = EnvironmentPlant(env)
    body = body_of(env.task, plant, env.plant.flaws, law)
    report = Sequencer(Carrying(body, env.task, Course.of(env.task, env.plan))).run()
    done = env.progress == 1.0
    return Episode(plant.total, env.plant.time, env.progress, done, "" if done else report.reason)

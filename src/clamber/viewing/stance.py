"""A still picture of one stance: robot, holds, forces and torques, and what limits it."""

from pathlib import Path

import numpy as np
from matplotlib.axes import Axes

from ..actions.problem import Replay
from ..errors import ClamberError
from ..tasks.limbed import LimbedTask
from .climber import ClimberArtists, Snapshot
from .geometry import stance_posture
from .output import CANVASES, check_suffix, save_figure
from .scene import draw_scene, find_bounds
from .style import styled
from .view import ClimbView


class StepError(ClamberError):
    """A step is asked for that the replay does not have."""

    def __init__(self, step: int, steps: int) -> None:
        super().__init__(step, steps)
        self.step, self.steps = step, steps

    def __str__(self) -> str:
        return f"step = {self.step}: the climb has no such step; allowed are 0 (the start) to {self.steps}"


def draw_limbed_stance(task: LimbedTask, replay: Replay, step: int, target: str | Path | Axes) -> None:
    """Draw the stance after a step, with its forces.

    Args:
        task: The task.
        replay: A plan carried out on it.
        step: Number of the action, from 1; 0 is the start.
        target: A file (.png, .svg, .pdf), which also gets torques, pose and nearest limit; or axes, for the wall alone.

    Raises:
        StepError: If there is no such step.
        SuffixError: If the file's suffix names no format for still pictures.
        FileError: If the file cannot be written.
    """
    if not 0 <= step < len(replay.stances):
        raise StepError(step, len(replay.stances) - 1)
    if isinstance(target, Axes):
        _draw_on(task, replay, step, target)
        return
    check_suffix(target, CANVASES)
    with styled():
        view = ClimbView(task, replay)
        view.show(step, view.snapshot(step))
        save_figure(view.figure, target)


def _draw_on(task: LimbedTask, replay: Replay, step: int, axes: Axes) -> None:
    stance, n = replay.stances[step], len(task.robot.limbs)
    posture = stance_posture(task.robot, task.world, stance)
    bounds = find_bounds(task, [posture])
    draw_scene(axes, task, bounds)
    climber = ClimberArtists(axes, task, bounds)
    climber.update(Snapshot(posture, np.array(stance["force"][:n]), np.array(stance["torques"][:n])))

"""What a climber's pictures say about loads: torques of joints against their limits, and the key of the force arrows."""

from typing import Final

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import FancyArrowPatch

from ....types import Floats
from ....units import OZ_IN
from ....viewing import style
from ....viewing.panel import Gauges, Place
from ....viewing.words import length_unit
from ..planning.task import LimbedTask
from .climber import force_scale

NEAR_LIMIT: Final = 0.9
"""Share of a joint's limit beyond which its bar turns red [-]."""


def torque_limits(task: LimbedTask) -> Floats:
    """Torque limits of shoulders and elbows [N m], shape (n_limbs, 2)."""
    return np.array([task.robot.torque_limit_of(joint) for joint in task.robot.joints]).reshape(-1, 2)


def show_torque(torque: float, *, ounces: bool) -> str:
    """A torque for people: ounce-inches beside a task in inches, else newton metres."""
    return f"{round(torque / OZ_IN)} oz-in" if ounces else f"{round(torque, 2) + 0.0:.2f} N m"  # never "-0"


def nice_force(weight: float) -> float:
    """A round force for the key, near half the weight [N]."""
    return next(f for f in (1000, 500, 200, 100, 50, 20, 10, 5, 2, 1, 0.5, 0.2, 0.1, 0.0) if f <= 0.6 * weight)


def torque_gauges(task: LimbedTask) -> Gauges:
    """One bar per shoulder and elbow: share of its torque limit, red beyond nine tenths."""
    limits = torque_limits(task).ravel()
    ounces = length_unit(task)[0] == "in"
    return Gauges(
        title="Joint torques",
        names=task.robot.joint_names,
        colours=tuple(style.PARTS[(k // 2) % len(style.PARTS)] for k in range(len(limits))),
        low=np.zeros(len(limits)),
        high=limits,
        limits=((1.0, "limit"),),
        calm=(0.0, NEAR_LIMIT),
        show=lambda torque: show_torque(torque, ounces=ounces),
        unit=("oz-in", OZ_IN, 0) if ounces else ("N m", 1.0, 2),
        group=2,
    )


def draw_force_key(axes: Axes, task: LimbedTask, place: Place, inches_per_metre: float) -> None:
    """An arrow of a round force, in the scale of the picture."""
    force = nice_force(task.robot.weight)
    length = force * force_scale(task) * inches_per_metre
    axes.add_patch(
        FancyArrowPatch(
            (place.left, place.top), (place.left + length, place.top), arrowstyle="-|>", mutation_scale=9, lw=1.6,
            color=style.FORCE, shrinkA=0, shrinkB=0,
        )
    )  # fmt: skip
    words = f"{force:g} N, force of a hold on its limb"
    axes.text(place.left + length + 0.1, place.top, words, fontsize=7, va="center", color=style.QUIET)

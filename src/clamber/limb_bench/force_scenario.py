"""A force on a wall: come near, touch, press, stand, slide along it, stand again. One command for every law."""

import math
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from ..control.controller import still_aim
from ..sim.limb_flaws import Wall
from ..types import Floats
from .bench_limb import BenchLimb
from .scenario import Scenario, ScenarioError

SETTLE = 0.5
"""Time that a law has after the force has risen, before it is judged [s]."""
TURN = 0.3
"""What lies this near to the start or end of the slide counts neither as standing nor as sliding [s]."""


@dataclass(frozen=True, slots=True, kw_only=True)
class ForceTask:
    """How hard, on which wall, and when. What the laws believe of the wall may differ from what it is."""

    force: float = 20.0
    """Into the wall [N]."""
    angle: float = math.pi / 2
    """Direction into the wall, from the x axis of the limb's port frame [rad]."""
    stiffness: float = 10_000.0
    """Of the wall [N/m]."""
    damping: float = 20.0
    """Of the wall [N s/m]."""
    friction: float = 0.0
    """Friction coefficient of the wall's surface [-]."""
    believed_angle: float | None = None
    """What the laws take for the angle [rad]; None: the truth."""
    believed_stiffness: float | None = None
    """What they take for the stiffness [N/m]; None: the truth."""
    slide: float = 0.03
    """Way along the wall at full force, positive to the left of the direction into it [m]."""
    gap: float = 0.002
    """From the start to the wall [m]."""
    touch: float = 0.4
    """Part of the force that the limb touches the wall with [-]."""
    tolerance: float = 1.0
    """Largest error of a force that counts as held [N]."""
    approach: float = 1.0
    """Time to come to the wall [s]."""
    rise: float = 1.0
    """Time in which the force rises to its full size [s]."""
    stand: float = 2.0
    """Time to stand before and after the slide [s]."""
    sliding: float = 2.0
    """Time of the slide [s]."""

    def __post_init__(self) -> None:
        for key in ("force", "stiffness", "tolerance", "approach", "rise", "sliding"):
            self._demand(key, 0.0 < getattr(self, key) < math.inf, "must be more than 0, and finite")
        for key in ("gap", "damping", "friction"):
            self._demand(key, 0.0 <= getattr(self, key) < math.inf, "must be 0 or more, and finite")
        for key in ("angle", "slide"):
            self._demand(key, math.isfinite(getattr(self, key)), "must be a finite number")
        self._demand("stand", SETTLE + TURN < self.stand < math.inf, f"must be more than {SETTLE + TURN:g} s")
        self._demand("touch", 0.0 < self.touch <= 1.0, "must be more than 0 and at most 1")
        believed = self.believed_angle
        self._demand("believed_angle", believed is None or math.isfinite(believed), "must be a finite number")
        stiff = self.believed_stiffness
        self._demand("believed_stiffness", stiff is None or 0.0 < stiff < math.inf, "must be more than 0 N/m")

    def _demand(self, key: str, fine: bool, allowed: str) -> None:
        if not fine:
            raise ScenarioError("force", key, getattr(self, key), allowed)

    @property
    def task_angle(self) -> float:
        """Angle of the wall as the laws believe it [rad]."""
        return self.angle if self.believed_angle is None else self.believed_angle

    @property
    def task_stiffness(self) -> float:
        """Stiffness of the wall as the laws believe it [N/m]."""
        return self.stiffness if self.believed_stiffness is None else self.believed_stiffness

    @property
    def slide_from(self) -> float:
        """When the slide begins [s]."""
        return self.approach + self.rise + self.stand

    @property
    def seconds(self) -> float:
        """Length of the run [s]."""
        return self.slide_from + self.sliding + self.stand

    def wall(self, limb: BenchLimb) -> Wall:
        """The wall, its untouched surface `gap` before the limb's tip."""
        x, y = np.array(limb.start) + self.gap * direction(self.angle)
        return Wall(
            x=float(x),
            y=float(y),
            angle=self.angle,
            stiffness=self.stiffness,
            damping=self.damping,
            friction=self.friction,
        )

    def judged(self, time: Floats) -> tuple[npt.NDArray[np.bool_], npt.NDArray[np.bool_]]:
        """Which ticks count as standing and which as sliding, shape (ticks,) each; together with the turns between all after `SETTLE`."""
        begin, end = self.slide_from, self.slide_from + self.sliding
        still = ((time >= self.approach + self.rise + SETTLE) & (time < begin)) | (time >= end + TURN)
        return still, (time >= begin + TURN) & (time < end - TURN) & (self.slide != 0.0)


def direction(angle: float) -> Floats:
    """Unit vector at an angle from the x axis, shape (2,)."""
    return np.array((math.cos(angle), math.sin(angle)))


def force_scenario(limb: BenchLimb, rate: float, task: ForceTask) -> Scenario:
    """The command of a force task, by what the laws believe of the wall; `rate` is the control's [Hz].

    The aim moves from the start to the wall's surface and, later, along it with a smooth start and end. Its wrench is the force; while that
    rises, its speed into the wall is that at which the wall gives way.

    Raises:
        ScenarioError: If the wall is out of the limb's reach.
    """
    if not task.seconds <= 600.0:
        raise ScenarioError("force", "seconds", task.seconds, "must be at most 600 s in all")
    time = np.arange(max(1, round(task.seconds * rate))) / rate
    into = direction(task.task_angle)
    along = np.array((-into[1], into[0]))
    near = np.clip(time / task.approach, 0.0, 1.0)
    risen = np.clip((time - task.approach) / task.rise, 0.0, 1.0)
    growth = (1.0 - task.touch) * task.force
    size = task.touch * task.force + growth * _smooth(risen)
    part = np.clip((time - task.slide_from) / task.sliding, 0.0, 1.0)
    aims = np.stack([still_aim(limb.start)] * len(time))
    places = np.outer(task.gap * near, into) + np.outer(task.slide * _smooth(part), along)
    speeds = np.outer(task.gap / task.approach * (near < 1.0), into)
    speeds += np.outer(growth / task.task_stiffness / task.rise * _smooth_rate(risen), into)
    speeds += np.outer(task.slide / task.sliding * _smooth_rate(part), along)
    change = np.outer(task.slide / task.sliding**2 * (6.0 - 12.0 * part) * ((part > 0.0) & (part < 1.0)), along)
    aims["place"][:, 0, :2] += places
    aims["twist"][:, 0, :2], aims["acceleration"][:, 0, :2] = speeds, change
    aims["wrench"][:, 0, :2] = np.outer(size, into)
    _check_reach(limb, task)
    across = direction(task.angle)
    settle = task.approach + task.rise + SETTLE
    return Scenario("force", aims, settle=settle, direction=(-float(across[1]), float(across[0])), wall=task.wall(limb))


def _smooth(part: Floats) -> Floats:
    """From 0 to 1 with speed 0 at both ends."""
    out: Floats = part**2 * (3.0 - 2.0 * part)
    return out


def _smooth_rate(part: Floats) -> Floats:
    out: Floats = 6.0 * part * (1.0 - part)
    return out


def _check_reach(limb: BenchLimb, task: ForceTask) -> None:
    into = direction(task.angle)
    depth = task.gap + task.force / task.stiffness
    least = abs(limb.spec.l1 - limb.spec.l2_effective)
    for part in np.linspace(0.0, task.slide, 16):
        place = np.array(limb.start) + depth * into + part * np.array((-into[1], into[0]))
        if not least < float(np.hypot(*place)) < 0.98 * limb.spec.length:
            allowed = (
                f"pressed in, the tip must stay {least:.3g} to {0.98 * limb.spec.length:.3g} m from the limb's port"
            )
            raise ScenarioError("force", "wall", f"({place[0]:.3g}, {place[1]:.3g}) m", allowed)

"""Numbers of the law of cooperative motion, and the speeds that follow from a robot's actuators."""

import math
from dataclasses import dataclass
from typing import Literal

import numpy as np

from .....errors import StatedError
from .....types import Floats
from ...robot import WalkerRobot
from .planted_feet import ACTUATOR, BALANCE, LEG, PlantedFeet

Form = Literal["right", "as printed"]


class CooperationError(StatedError):
    """A setting of the law that cannot be: names it, its value, what is allowed."""

    says = "{name} = {value}: {allowed}"
    name: str
    value: object
    allowed: str


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Cooperation:
    """How body and arm share the tool's motion."""

    speeds: Floats
    """Largest speeds of the freedoms, T_q's [m/s, rad/s], shape (6 + joints,)."""
    tool_speeds: Floats
    """Largest speeds of the tool, T_v's [m/s], shape (3,)."""
    gain: float = 1.0
    """k_p of the manipulability's gradient [-]."""
    lent: bool = False
    """Whether the plate is lent by a walk, where limits are kept: the manipulability that grows is the arm's alone, which goes on when the
    plate is taken back, and only the arm is damped: a height by itself is in no corner to shake in."""
    feedback: float = 2.0
    """Of the tool's position error [1/s]; 0 is the paper's open loop."""
    period: float = 0.02
    """Of a step [s]."""
    form: Form = "right"
    """Whether xi is that of the normalised Jacobian, as equation 19 needs it, or of the plain one, as (13) and (16) print it."""
    limited: bool = True
    """Whether the limits of joints, rates, actuators, legs and balance are kept, by a quadratic programme."""
    approach: float = 5.0
    """kappa: the rate towards a limit is at most this times what is left [1/s]."""
    inside: float = 2e-4
    """By how much the programme stays inside the limits of the plate's pose, which are curved [m]."""
    balance: float = 0.0
    """Least distance of the centre of mass from the edges of the support [m]."""
    softness: float = 1e-3
    """lambda, by which the tool's motion gives way to the limits in the programme [-]."""
    damping: float = 1.0
    """Of freedoms that spend much motion on little, over what they need to come to rest (`stretch`, `swerve`) [-]; 0: none."""

    def __post_init__(self) -> None:
        for name in ("speeds", "tool_speeds"):
            values = np.asarray(getattr(self, name))
            if not (np.isfinite(values).all() and (values >= 0.0).all()):
                raise CooperationError(name, values, "must be finite numbers, 0 or more")
        if not (np.asarray(self.tool_speeds) > 0.0).all() or np.shape(self.tool_speeds) != (3,):
            raise CooperationError("tool_speeds", self.tool_speeds, "must be three numbers over 0")
        for name in ("gain", "feedback", "inside", "balance", "softness", "damping"):
            value = getattr(self, name)
            if not (math.isfinite(value) and value >= 0.0):
                raise CooperationError(name, value, "must be a finite number, 0 or more")
        if not 0.0 < self.period < math.inf:
            raise CooperationError("period", self.period, "must be over 0 s")
        for name in ("feedback", "approach"):
            if not getattr(self, name) * self.period <= 1.0:
                raise CooperationError(
                    name, getattr(self, name), f"must be at most {1.0 / self.period:g} /s, one over the period"
                )
        if not self.approach > 0.0:
            raise CooperationError("approach", self.approach, "must be over 0 /s")
        if self.form not in ("right", "as printed"):
            raise CooperationError("form", repr(self.form), "must be 'right' or 'as printed'")


def stretch(settings: Cooperation, robot: WalkerRobot) -> float:
    """How far joints at their largest speed s turn the tool's normalised velocity within a step, by the arm's stretched posture [-].

    Stretched out, joints that are off by d move the tool by sigma = s H d / v, with v the tool's largest speed and H at most the sum of
    i L_i. Damped by lambda they go back by s dt sigma / lambda^2 in a step, at the tool's full speed. More than 2 d shakes; with lambda^2
    equal to s^2 dt H / v it is d at most.
    """
    bent = math.fsum((i + 1) * length for i, length in enumerate(robot.own_arm.links)) + abs(robot.own_arm.out)
    fastest = float(np.max(settings.speeds[6:]))
    return fastest * fastest * settings.period * bent / float(np.min(settings.tool_speeds))


def swerve(settings: Cooperation, robot: WalkerRobot) -> float:
    """The same of the plate in a corner of its limits, which are curved by no less than an actuator's shortest length [-]."""
    arm = robot.own_arm
    reach = sum(arm.links) + abs(arm.out) + abs(arm.up)
    fastest = max(float(np.max(settings.speeds[:3])), reach * float(np.max(settings.speeds[3:6])))
    return fastest * fastest * settings.period / (robot.mechanism.shortest * float(np.min(settings.tool_speeds)))


def own_speeds(robot: WalkerRobot) -> Floats:
    """The speed of each freedom, alone, at which an actuator, a leg or a joint is at its fastest in the middle pose [m/s, rad/s].

    Returns:
        Shape (6 + joints,).
    """
    from .limits import chain_of
    from .scratch import make_scratch, see_bounds, see_tool

    arm = robot.own_arm
    q = np.array([0.0, 0.0, robot.legs.nominal, 0.0, 0.0, 0.0, *arm.rest])
    chain, w = chain_of(robot, balance=0.0), make_scratch(arm.n_joints)
    footing = PlantedFeet(robot=robot, support="y", pose=q[:6]).record()
    see_tool(chain, q, w)
    see_bounds(chain, footing[0], q, w)
    fastest = np.concatenate([np.full(3, robot.mechanism.speed), [np.inf], np.full(6, robot.legs.speed)])
    out = np.empty(q.size)
    for k in range(6):
        rows = range(ACTUATOR, ACTUATOR + 3) if k in (0, 1, 3) else range(LEG, BALANCE)
        out[k] = min(fastest[row] / abs(w.gradients[row, k]) for row in rows if w.gradients[row, k] != 0.0)
    out[6:] = arm.fastest
    return out

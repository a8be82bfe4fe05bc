"""Other ways for the holding limbs to carry the body than by its own acceleration: leg by leg, and the scheme that came before SCCT.

All of them take the same aim of the body and the same map of holds, and fill in the torques of the limbs that hold.
"""

import math
from collections.abc import Callable
from typing import TYPE_CHECKING, Final, Protocol

import numpy as np

from ....control.controller import Controller, still_aim
from ....control.law_settings import LawSettings
from ....types import Floats
from ..control.body import distribute_wrench
from ..control.coordinated_transpose import share_from_first, transpose_torques

if TYPE_CHECKING:
    from .whole_body import WholeBody


class BodyScheme(Protocol):
    """Brings the body to its aim by the limbs that hold."""

    def hold(self, body: "WholeBody", holding: list[int]) -> None:
        """Fill `body.torques` of the limbs `holding`, at a body that has seen."""


class LegByLeg:
    """Every limb's own law brings its tip to where its hold is seen from the aim of the body; the weight is fed forward, shared.

    With `joint-pd` the control of positions that Bevly (1997), 4.2, warns of; other laws are in the gains of `leg_kp` and `leg_kd`.
    """

    def __init__(self, body: "WholeBody") -> None:
        gains = body.gains
        laws = LawSettings(law=gains.law, kp=gains.leg_kp, kd=gains.leg_kd)
        self._controllers = [Controller(chain, laws, period=body.period) for chain in body.chains]
        self._aim = still_aim((0.0, 0.0))
        self._states = np.zeros((1, 2, 2))
        self._before = [0] * body.n
        self._arms, self._forces = np.zeros((body.n, 2)), np.zeros((body.n, 2))

    def hold(self, body: "WholeBody", holding: list[int]) -> None:
        """As `BodyScheme` says."""
        held = np.zeros(body.n, np.int64)
        held[holding] = 1
        for i in holding:
            self._arms[i] = body.tasks[i].place - body.pose[:2]
        distribute_wrench(
            held, self._arms, np.array((0.0, body.gains.weight_fed * body.robot.weight, 0.0)), self._forces
        )
        for i, controller in enumerate(self._controllers):
            hold = body.tasks[i].hold if held[i] else 0
            if hold != self._before[i]:  # a law that remembers joint angles starts anew at each hold
                controller.reset()
                self._before[i] = hold
            if not hold:
                continue
            limb = body.robot.limbs[i]
            aim = self._aim
            aim["place"][0, :2], aim["twist"][0, :2] = self._seen_from_aim(body, i)
            force = -self._forces[i]
            turn = -(body.pose[2] + limb.port_angle)
            aim["wrench"][0, :2] = turned(force, turn)
            self._states[0, 0], self._states[0, 1] = body.q[i], body.qd[i]
            body.torques[i] = controller.command(aim, self._states)[0]

    @staticmethod
    def _seen_from_aim(body: "WholeBody", i: int) -> tuple[Floats, Floats]:
        """Place and speed of a hold in the limb's port frame, as the body would see it that is at its aim [m], [m/s]."""
        limb = body.robot.limbs[i]
        arm = body.tasks[i].place - body.aim[:2]
        speed = -body.aim_speed[:2] + body.aim_speed[2] * np.array((arm[1], -arm[0]))
        place = turned(arm, -body.aim[2]) - (limb.port_x, limb.port_y)
        return turned(place, -limb.port_angle), turned(speed, -body.aim[2] - limb.port_angle)


class Coordinated:
    """Coordinated Jacobian transpose (Sunada 1992; Bevly 1997, 4.4.5): see `control.coordinated_transpose`.

    The first limb that holds is the one that the position counts from; the tip of that farthest from it is commanded to a point inside its
    hold, as deep as its spring and the believed stiffness of the hold make the wanted pull. Gains are in N/m and N s/m. The weight is a
    disturbance, unless `weight_fed` says otherwise.
    """

    def __init__(self, body: "WholeBody") -> None:
        self._arms, self._forces, self._wrench = np.zeros((body.n, 2)), np.zeros((body.n, 2)), np.zeros(3)

    def hold(self, body: "WholeBody", holding: list[int]) -> None:
        """As `BodyScheme` says."""
        gains = body.gains
        self._wrench[:] = gains.kp * (body.aim - body.pose) + gains.kd * (body.aim_speed - body.twist)
        self._wrench[1] += gains.weight_fed * body.robot.weight
        self._forces[:] = 0.0
        for i in holding:
            self._arms[i] = body.tasks[i].place - body.pose[:2]
        first = holding[0]
        if len(holding) == 1:
            self._forces[first] = self._wrench[:2]
        else:
            second = max(holding[1:], key=lambda i: float(np.linalg.norm(self._arms[i] - self._arms[first])))
            share_from_first(self._arms, first, second, self._wrench, self._press(body, first, second), self._forces)
        for i in holding:
            transpose_torques(body.legs[i], body.q[i], body.pose, self._forces[i], body.torques[i])

    def _press(self, body: "WholeBody", first: int, second: int) -> float:
        """What the spring of the second tip brings along the line of the holds [N]."""
        gains = body.gains
        line = self._arms[second] - self._arms[first]
        line = line / (np.linalg.norm(line) or 1.0)
        # the spring of the limb and that of the hold bear the same force one after the other
        depth = gains.inside * (1.0 / gains.leg_kp + 1.0 / gains.hold_stiffness)
        inwards = 1.0 if float(body.grab_direction(second) @ line) > 0.0 else -1.0
        behind = float((body.tasks[second].place - body.felt_tip(second)) @ line)
        return gains.leg_kp * (behind + inwards * depth) - gains.leg_kd * float(body.tip_speed(second) @ line)


def turned(vector: Floats, angle: float) -> Floats:
    """A vector, shape (2,), turned by an angle [rad]."""
    c, s = math.cos(angle), math.sin(angle)
    return np.array((c * vector[0] - s * vector[1], s * vector[0] + c * vector[1]))


SCHEMES: Final[dict[str, Callable[["WholeBody"], BodyScheme]]] = {"leg-by-leg": LegByLeg, "coordinated": Coordinated}
"""Name -> scheme; "body" is that of the thesis's 4.4, in `whole_body`."""

"""Letting go into a hang: the weight below the hold that stays before the other hook comes off, so that nothing swings."""

import math
from typing import Final

import numpy as np

from ....types import Floats
from ..robot.robot import Limb
from .approach import free_distance
from .climber import Climber, FallenError
from .hang import DAMPING, Hang
from .hook_release import AWAY
from .motions import follow, move_body
from .pendulum import Pendulum
from .postures import Posture, postures

WAY: Final = 0.2
"""Turn of the body on one straight way of it [rad]."""
SETTLING: Final = 0.3
"""Before the load passes to one limb [s]."""
OFFSETS: Final = (0.0, 0.005, 0.01, 0.015, 0.02, 0.025, 0.03)
"""How far the weight may be from below the hold that stays, on the side where it is, tried in turn [m]: from farther the other hook bears
more than a tenth of the weight, and is caught on its hold. That counts for more than how far the hook can be lifted straight off."""
TURNS: Final = np.radians(np.arange(-75.0, 76.0, 7.5))
"""Of the body from where it is that are tried [rad]."""
DEPTHS: Final = np.arange(0.10, 0.33, 0.02)
"""Of the body below the hold [m]."""
ROUNDS: Final = 5
"""In which the body's x is found for an angle and a height."""
NEAR: Final = 0.002
"""Of the weight's place that they come to [m]."""
OFF: Final = 0.022
"""Way off a hold against the grab direction, after which a hook is out of its slot and its flare [m]."""
BACK: Final = 0.05
"""Way back towards the limb's own shoulder after it, always where the limb does not reach to where its hook is clear of its hold all round
[m]."""
ASIDE: Final = 0.25
"""It goes that way as well where its hook is clear, if this part of it leads away from the hold [-]: a body that swings would strike the
hold with it, and be driven on by every blow."""
CAUGHT: Final = 0.015
"""A tip that is nearer to its hold after that has not come off [m]."""
BRISK: Final = (0.055, 0.06)
"""Lag of its joints from which a hook that comes off is waited for: slowed down sooner, it drags the body aside by its friction [rad]."""
STRAIGHT: Final = math.radians(8.0)
"""A limb whose elbow is straighter is at the end of its reach [rad]."""
ON_TOP: Final = 0.5
"""A hook that pulls less downwards might come off where it bears the weight [-]."""
NOT_UNDER: Final = -0.1
"""Likewise that which leaves, and bears next to nothing [-]."""


def release_to_hang(climber: Climber, i: int, stay: int) -> Hang | None:
    """Take limb `i` off, so that the body hangs on limb `stay` alone.

    While both hold, the body goes to where its centre of gravity is below the hold that stays; the other one then bears next to nothing,
    and taking it off sets off no swing. What is left of one is damped.

    Returns:
        The hang; None where the limbs do not reach so far, and nothing has moved.

    Raises:
        FallenError: If the hook does not come off.
    """
    body = climber.body
    start = body.settled.copy()
    end = pose_to_let_go(climber, i, stay)
    if end is None:
        return None
    ways = max(1, math.ceil(abs(end[2] - start[2]) / WAY))
    for k in range(1, ways + 1):
        move_body(climber, start + k / ways * (end - start))
    climber.wait(SETTLING)
    climber.carry_with_all(but=i)
    hang = Hang(climber, stay, damping=0.0)
    if not lift_off(climber, i):
        raise FallenError("the hook that was to let go is caught on its hold")
    hang.damping = DAMPING
    hang.tune()
    hang.calm()
    return hang


def lift_off(climber: Climber, i: int) -> bool:
    """Take limb `i` off its hold by its joints, against its grab direction and then back towards its shoulder; whether it came off.

    Stretched as the limb may be, its joints do it more surely than its tip's law.
    """
    body = climber.body
    task, limb = body.tasks[i], climber.robot.limbs[i]
    g, place, hold = body.grab_direction(i), body.tip(i), task.place.copy()
    pose, clear = body.settled, _clear_off(climber, i)
    far = _bent(limb, pose, place - clear * g, float(body.q[i, 1])) is not None
    off = clear if far else OFF
    points = [place - part * off * g for part in (0.25, 0.5, 0.75, 1.0)]
    c, s = math.cos(pose[2]), math.sin(pose[2])
    port = pose[:2] + np.array((c * limb.port_x - s * limb.port_y, s * limb.port_x + c * limb.port_y))
    back = (port - points[-1]) / float(np.hypot(*(port - points[-1])))
    withdrawn = [points[-1] + part * BACK * back for part in (0.5, 1.0)]
    if not far or math.dist(withdrawn[-1], place) > off + ASIDE * BACK:
        points += withdrawn
    way = [body.q[i] - body.play[i]]
    for point in points:
        fit = [one for one in postures(limb, pose, point) if one.inside and one.angles[1] * way[0][1] > 0.0]
        way += [one.angles for one in fit]
    task.hold = 0
    follow(climber, i, np.array(way), BRISK)
    return float(np.hypot(*(body.felt_tip(i) - hold))) > CAUGHT


def pose_to_let_go(climber: Climber, i: int, stay: int) -> Floats | None:
    """The pose nearest to the present one in which both limbs are well on their holds and the weight is below that of `stay`.

    Limb `i` can be lifted off there, until its hook is clear of its hold all round if that can be. None where there is none.
    """
    for offset in OFFSETS:
        for off in (_clear_off(climber, i), OFF):
            pose = _pose_to_lift(climber, i, stay, off, offset)
            if pose is not None:
                return pose
    return None


def _clear_off(climber: Climber, i: int) -> float:
    """How far limb `i` has to be lifted off its hold until its hook may go anywhere [m]."""
    return free_distance(climber.peg_radius, climber.map.error(climber.body.tasks[i].hold)) + AWAY


def _pose_to_lift(climber: Climber, i: int, stay: int, off: float, offset: float) -> Floats | None:
    """The pose nearest to the present one where the weight is at most `offset` from below the hold of `stay`, with room to lift `i` off."""
    body, robot = climber.body, climber.robot
    pendulum, here, hold = Pendulum(robot, stay), body.settled.copy(), body.tasks[stay].place
    q = body.q - body.play
    now = (pendulum.arm(q) * complex(math.cos(here[2]), math.sin(here[2]))).real
    wished = math.copysign(min(offset, abs(now)), now)
    found = []
    for turn in TURNS:
        for depth in DEPTHS:
            pose = np.array((here[0] - now + wished, hold[1] - depth, here[2] + turn))
            moved = q.copy()
            for _ in range(ROUNDS):  # the weight moves with the limbs that reach for the holds
                holding, leaving = _well_on(climber, stay, pose, 0.0), _well_on(climber, i, pose, off)
                if holding is None or leaving is None:
                    break
                moved[stay], moved[i] = holding, leaving
                aside = (pendulum.arm(moved) * complex(math.cos(pose[2]), math.sin(pose[2]))).real - wished
                if abs(aside) < NEAR:
                    found.append(pose)
                    break
                pose[0] -= aside
    return min(
        found, key=lambda pose: float(np.hypot(*(pose[:2] - here[:2])) + 0.2 * abs(pose[2] - here[2])), default=None
    )


def _well_on(climber: Climber, i: int, pose: Floats, off: float) -> Floats | None:
    """Angles of a limb on its hold at a pose, its elbow on the side where it is, its hook well on top, and room to lift it off by `off`."""
    limb, task, side = climber.robot.limbs[i], climber.body.tasks[i], climber.body.q[i, 1]
    on = [one for one in postures(limb, pose, task.place) if one.inside and one.angles[1] * side > 0.0]
    if not on or on[0].on_top < (NOT_UNDER if off > 0.0 else ON_TOP) or abs(on[0].angles[1]) < STRAIGHT:
        return None
    if off > 0.0 and _bent(limb, pose, task.place - off * on[0].grab, side) is None:
        return None
    return on[0].angles


def _bent(limb: Limb, pose: Floats, place: Floats, side: float) -> Posture | None:
    """The posture with the tip at a place, the elbow bent to a side, within the joints' limits; None where there is none."""
    fit = (one for one in postures(limb, pose, place) if one.inside and one.angles[1] * side > 0.0)
    return next((one for one in fit if abs(one.angles[1]) > STRAIGHT), None)

"""Recovery of a slipped hook: the load to the limbs still on, at once; then the lost hold again or another, and on with the plan."""

import math
from collections.abc import Mapping
from typing import Final

import numpy as np

from ...types import Floats
from .climber import Climber, FallenError, SlippedError
from .ends import grab, release
from .hang import Hang
from .motions import clear_the_way, move_body
from .postures import postures

ONWARDS: Final = ("hold", "cling", "hang")
"""What a limb on its hold does."""
BRAKING: Final = 0.15
"""Time in which the body is only slowed down, wherever that takes it [s]."""
RESTING: Final = 0.3
"""Before the lost hold is taken again [s]."""
AT_HOLD: Final = 0.035
"""A hook that is pushed on and is nearer to its hold takes the load, whether it is seated or not [m]."""
TOUCHES: Final = 3.0
"""A limb that feels more than this there has caught it [N]."""
MOST_SLIPS: Final = 4
"""Hooks that may come off, one after the other, until the robot counts as fallen."""
PITCH: Final = math.radians(10.0)
"""Between angles of the holding limb's joints that are tried for a hang [rad]."""
NEARBY: Final = 0.7
"""Holds farther from the one that carries are out of reach [m]."""
ON_TOP: Final = 0.4
"""A hook that pulls less downwards might come off again [-]."""
STRAIGHT: Final = math.radians(12.0)
"""A limb whose elbow is straighter is at the end of its reach [rad]."""
WAYS: Final = 6
"""Most pairs of a limb and a hold that are tried from a hang."""


def recover(
    climber: Climber, slip: SlippedError, wanted: Mapping[int, int], pose: Floats, elbows: Mapping[int, int]
) -> str:
    """Catch the body after a hook has come off, and bring limbs and body to where they were to be.

    Args:
        climber: The robot, at the tick after the one that told the slip.
        slip: What it told.
        wanted: Index of a limb -> number of the hold where it should be.
        pose: Of the body, where it should be, shape (3,).
        elbows: Index of a limb -> side of its elbow there.

    Returns:
        Why the robot could not come there though it has not fallen; empty if it did.

    Raises:
        FallenError: If the robot falls.
    """
    for _ in range(MOST_SLIPS):
        try:
            hang = catch(climber, slip.limb)
            return _restore(climber, hang, wanted, pose, elbows)
        except SlippedError as another:
            slip = another
    raise slip


def catch(climber: Climber, lost: int) -> Hang | None:
    """Let the limbs that are on their holds carry, at once and where the body is; from one alone it hangs until it swings no more.

    A hook that comes to a hold as the body swings catches it.

    Returns:
        That hang; None where two carry.

    Raises:
        FallenError: If no limb is on a hold.
    """
    body = climber.body
    for i, task in enumerate(body.tasks):
        if i == lost or (task.doing not in ONWARDS and not (task.doing == "pull" and _hook_on(climber, i))):
            task.hold, task.doing, task.angles, task.rates = 0, "joints", body.q[i].copy(), np.zeros(2)
    on = [i for i, task in enumerate(body.tasks) if task.hold]
    if not on:
        raise FallenError("the last hook has come off")
    climber.fall.reset()
    climber.slip.reset()
    if len(on) == 1:
        hang = Hang(climber, on[0])
        hang.calm()
        for i in range(body.n):
            if i != on[0] and math.hypot(*climber.fall.forces[i]) > TOUCHES:
                _hook_on(climber, i)
        if not any(task.doing == "cling" for task in body.tasks):
            return hang
        climber.balance = None
        on = [i for i, task in enumerate(body.tasks) if task.hold]
    body.carry_at_once(on)

    def brake() -> None:
        body.aim[:], body.aim_speed[:] = body.pose, 0.0

    climber.balance = brake
    climber.wait(BRAKING)
    climber.balance = None
    climber.wait(RESTING)
    return None


def _hook_on(climber: Climber, i: int) -> bool:
    """Let a limb whose hook is where a free hold is count as on it: it may be, and nothing is lost if not."""
    task, tip = climber.body.tasks[i], climber.body.tip(i)
    taken = {one.hold for one in climber.body.tasks}
    near = min(
        (number for number in climber.holds if number not in taken),
        key=lambda number: math.dist(climber.holds[number], tip),
        default=0,
    )
    if not near or math.dist(climber.holds[near], tip) > AT_HOLD:
        return False
    task.hold, task.place, task.doing = near, climber.holds[near].copy(), "cling"
    task.pressed, task.tug = False, np.zeros(2)
    return True


def _restore(
    climber: Climber, hang: Hang | None, wanted: Mapping[int, int], pose: Floats, elbows: Mapping[int, int]
) -> str:
    if hang is not None and not _grab_from_hang(hang, wanted, pose, elbows):
        return "a hook has come off, the body hangs on one limb, and the others reach no hold"
    tasks = climber.body.tasks
    for moves in range(2):
        for i in sorted(wanted, key=lambda i: tasks[i].hold):  # free ones first
            others = sum(task.hold > 0 for k, task in enumerate(tasks) if k != i)
            if tasks[i].hold != wanted[i] and others > 1:
                grab(climber, i, wanted[i], elbow=elbows.get(i, 0))
        missing = [i for i in wanted if tasks[i].hold != wanted[i]]
        if missing and moves == 0:
            move_body(climber, _unwound(climber, pose))
    if missing:
        names = ", ".join(f"'{climber.robot.limbs[i].name}' to hold {wanted[i]}" for i in missing)
        return f"a hook has come off and does not come back: {names}"
    for i, task in enumerate(tasks):
        if task.hold and i not in wanted:
            release(climber, i)
    move_body(climber, _unwound(climber, pose))
    return ""


def _grab_from_hang(hang: Hang, wanted: Mapping[int, int], pose: Floats, elbows: Mapping[int, int]) -> bool:
    """Take a hold with a free limb while the body hangs on another; whether it is on, and both carry.

    Holds where limbs belong come first, then those that turn the body least from where it belongs.
    """
    climber = hang.climber
    tasks = climber.body.tasks
    own = tasks[hang.i].hold
    free = [i for i, task in enumerate(tasks) if not task.hold]
    near = [n for n, place in climber.holds.items() if n != own and math.dist(place, climber.holds[own]) < NEARBY]
    found = []
    for i in free:
        for number in near:
            meant = wanted.get(i) == number
            place = pose_to_grab(hang, i, number, elbows.get(i, 0) if meant else 0, float(pose[2]))
            if place is not None:
                found.append((not meant, abs(math.remainder(place[2] - pose[2], math.tau)), i, number, place))
    for other, _, i, number, place in sorted(found, key=lambda each: each[:4])[:WAYS]:
        clear_the_way(climber, place)
        hang.bring(place)
        hang.calm()
        if grab(climber, i, number, elbow=0 if other else elbows.get(i, 0)).held:
            hang.end()
            return True
    return False


def pose_to_grab(hang: Hang, i: int, number: int, elbow: int, angle: float) -> Floats | None:
    """The pose nearest to an angle in which a body that hangs lets limb `i` take a hold, both hooks well on top.

    Args:
        hang: The body.
        i: Index of the limb.
        number: Of the hold.
        elbow: Side of its elbow, +1, -1, or 0 for either.
        angle: Of the body [rad].
    """
    climber, pendulum = hang.climber, hang.pendulum
    body, limb, stay = climber.body, climber.robot.limbs[i], climber.robot.limbs[hang.i]
    hold, own, side = climber.holds[number], body.tasks[hang.i].place, hang.angles[1]
    best, least = None, math.inf
    q = body.q - body.play
    for shoulder in np.arange(stay.shoulder.lower, stay.shoulder.upper, PITCH):
        for elbow_angle in np.arange(stay.elbow.lower, stay.elbow.upper, PITCH):
            if elbow_angle * side < 0.0 or abs(elbow_angle) < STRAIGHT:
                continue
            q[hang.i] = shoulder, elbow_angle
            pose = pendulum.pose(q, own)
            turned = abs(math.remainder(pose[2] - angle, math.tau))
            down = stay.port_angle + pose[2] + shoulder + elbow_angle + stay.end.angle
            if turned >= least or -math.sin(down) < ON_TOP:
                continue
            for one in postures(limb, pose, hold):
                fit = one.inside and one.on_top > ON_TOP and abs(one.angles[1]) > STRAIGHT
                if fit and (not elbow or elbow * one.angles[1] > 0.0):
                    best, least = pose, turned
    return best


def _unwound(climber: Climber, pose: Floats) -> Floats:
    """A pose, its angle counted on from where the body is."""
    angle = climber.body.aim[2]
    return np.array((pose[0], pose[1], angle + math.remainder(pose[2] - angle, math.tau)))

"""Recovery of a slipped hook: the load to the limbs still on, at once; then the lost hold again or another, and on with the plan."""

import math
from collections.abc import Mapping
from typing import Final

import numpy as np

from ....types import Floats
from .climber import Climber, FallenError, SlippedError
from .grabbing import grab, release
from .hang import Hang
from .motions import clear_the_way, move_body
from .parking import OUT, unwound
from .postures import postures

ONWARDS: Final = ("stance", "unloaded_contact", "hang")
"""What a limb on its hold does."""
BRAKING: Final = 0.15
"""Time in which the body is only slowed down, wherever that takes it [s]."""
RESTING: Final = 0.3
"""Before the lost hold is taken again [s]."""
AT_HOLD: Final = 0.035
"""A hook that is pushed on and is nearer to its hold takes the load, whether it is seated or not [m]."""
CLOSE: Final = 0.02
"""One that bears already is that near: a tip farther off leans on its hold from outside [m]."""
SNATCH: Final = 15.0
"""Pull of a free hook along its grab direction, and at most as much towards its hold, while the body begins to swing [N]."""
SNATCHING: Final = 0.6
"""For so long [s]."""
CAUGHT: Final = 8.0
"""A hook that feels more than this against its hold has caught it [N] ..."""
FIRMLY: Final = 0.04
"""... where it does so for this long [s]."""
TOUCHES: Final = 3.0
"""A hook that feels more than this there, along its grab direction, has caught it [N]."""
LOOKING: Final = 0.25
"""For so long a hook that seems to have come off may show that it bears, unless it moves on and is told again [s]."""
IN_SLOT: Final = 0.008
"""A hook that was leaving is still on where it is nearer to its hold than this [m]."""
KNOCKING: Final = 6.0
"""A swing that has not died by then is kept up by a free limb that it knocks against a hold [s]."""
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
PARTS: Final = (0.25, 0.5, 0.75)
"""Of a way of the joints, where its hook is looked at [-]."""
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
            hang = catch(climber, slip.limb, surely=slip.surely)
            return _restore(climber, hang, wanted, pose, elbows)
        except SlippedError as another:
            slip = another
    raise slip


def catch(climber: Climber, lost: int, *, surely: bool = False) -> Hang | None:
    """Let the limbs that are on their holds carry, at once and where the body is; from one alone it hangs until it swings no more.

    A hook that comes to a hold as the body swings catches it.

    Args:
        climber: The robot.
        lost: Limb whose hook seems to have come off.
        surely: It has: what it feels is no load but what it is dragged against.

    Returns:
        That hang; None where two carry.

    Raises:
        FallenError: If no limb is on a hold.
    """
    body = climber.body
    climber.fall.reset()
    climber.slip.reset()
    for i, task in enumerate(body.tasks):
        if task.mode == "swing_cartesian" and task.hold and math.dist(body.tip(i), task.place) < IN_SLOT:
            task.mode = "unloaded_contact"
    others = sum(i != lost and (task.mode in ONWARDS or task.pushes) for i, task in enumerate(body.tasks))
    lose = surely or others < 2 or not _bears(climber, lost)  # a body that hangs on one hook swings at once
    for i, task in enumerate(body.tasks):
        off = task.mode not in ONWARDS and not (lose and task.pushes and _hook_on(climber, i, AT_HOLD))
        if off or (i == lost and lose):
            task.hold = 0
            task.stay(body.q[i])
    on = [i for i, task in enumerate(body.tasks) if task.hold]
    if not on:
        raise FallenError("the last hook has come off")
    climber.fall.reset()
    climber.slip.reset()
    if len(on) == 1:
        hang = Hang(climber, on[0])
        if not _snatch(climber, hang, lost) and not hang.calm(KNOCKING):
            clear_the_way(climber, body.settled, OUT)
            hang.calm()
        for i in range(body.n):
            if i != on[0] and _pull_of(climber, i) > TOUCHES:
                _hook_on(climber, i, CLOSE)
        if not any(task.mode == "unloaded_contact" for task in body.tasks):
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


def _bears(climber: Climber, i: int) -> bool:
    """Whether a hook that seems to have come off bears all the same: it has slid home, or joints have crossed their play.

    What pushes meanwhile, and may have lifted the body, pushes no more.
    """
    for task in climber.body.tasks:
        if task.mode == "contact_push":
            task.force, task.tug = np.zeros(2), np.zeros(2)
    felt, period = 0.0, climber.plant.period
    try:
        for _ in range(round(LOOKING / period)):
            climber.tick()
            felt = felt + period if _pull_of(climber, i) > CAUGHT else 0.0
            if felt > FIRMLY:
                return True
    except SlippedError as another:
        if another.limb != i:
            task = climber.body.tasks[i]
            task.hold = 0
            task.stay(climber.body.q[i])
            raise
    return False


def _snatch(climber: Climber, hang: Hang, lost: int) -> bool:
    """While the body begins to swing, draw free hooks that are at a hold onto it, but for the lost one; whether one has caught."""
    body, near = climber.body, {}
    for i, task in enumerate(body.tasks):
        hold = 0 if task.hold or i == lost else _free_hold(climber, i, AT_HOLD)
        if hold:
            near[i] = climber.holds[hold]
    if not near:
        return False

    def draw() -> None:
        hang.balance()
        for i, place in near.items():
            along, lack = body.grab_direction(i), place - body.tip(i)
            size = float(np.hypot(*lack))
            body.tasks[i].force = SNATCH * along + lack * (SNATCH / max(size, AT_HOLD))

    for i in near:
        body.tasks[i].mode, body.tasks[i].pressed = "contact_push", True
    climber.balance = draw
    felt = dict.fromkeys(near, 0.0)
    caught = False
    for _ in range(round(SNATCHING / climber.plant.period)):
        climber.tick()
        for i in near:
            bears = _pull_of(climber, i) > CAUGHT and _free_hold(climber, i, CLOSE) > 0
            felt[i] = felt[i] + climber.plant.period if bears else 0.0
        caught = max(felt.values()) > FIRMLY
        if caught:
            break
    climber.balance = hang.balance
    for i in near:
        task = body.tasks[i]
        task.pressed, task.tug = False, np.zeros(2)
        task.stay(body.q[i])
    return caught


def _pull_of(climber: Climber, i: int) -> float:
    """With what limb `i` feels its hook pull along its grab direction [N]; nothing where it cannot tell."""
    force = climber.fall.forces[i]
    return float(force @ climber.body.grab_direction(i)) if np.isfinite(force).all() else 0.0


def _free_hold(climber: Climber, i: int, within: float) -> int:
    """Number of the free hold that limb `i`'s hook is at, so near [m]; 0 where there is none."""
    tip, taken = climber.body.tip(i), {one.hold for one in climber.body.tasks}
    near = min(
        (number for number in climber.holds if number not in taken),
        key=lambda number: math.dist(climber.holds[number], tip),
        default=0,
    )
    return near if near and math.dist(climber.holds[near], tip) < within else 0


def _hook_on(climber: Climber, i: int, within: float) -> bool:
    """Let a limb whose hook is where a free hold is count as on it: it may be, and nothing is lost if not."""
    near, task = _free_hold(climber, i, within), climber.body.tasks[i]
    if not near:
        return False
    task.hold, task.place, task.mode = near, climber.holds[near].copy(), "unloaded_contact"
    task.pressed, task.tug = False, np.zeros(2)
    return True


def _restore(
    climber: Climber, hang: Hang | None, wanted: Mapping[int, int], pose: Floats, elbows: Mapping[int, int]
) -> str:
    if hang is not None and not _grab_from_hang(hang, wanted, elbows):
        return "a hook has come off, the body hangs on one limb, and the others reach no hold"
    tasks = climber.body.tasks
    for moves in range(2):
        for i in sorted(wanted, key=lambda i: tasks[i].hold):  # free ones first
            others = sum(task.hold > 0 for k, task in enumerate(tasks) if k != i)
            if tasks[i].hold != wanted[i] and others > 1:
                grab(climber, i, wanted[i], elbow=elbows.get(i, 0))
        missing = [i for i in wanted if tasks[i].hold != wanted[i]]
        if missing and moves == 0:
            move_body(climber, unwound(pose, float(climber.body.aim[2])))
    if missing:
        names = ", ".join(f"'{climber.robot.limbs[i].name}' to hold {wanted[i]}" for i in missing)
        return f"a hook has come off and does not come back: {names}"
    for i, task in enumerate(tasks):
        if task.hold and i not in wanted:
            release(climber, i)
    move_body(climber, unwound(pose, float(climber.body.aim[2])))
    return ""


def _grab_from_hang(hang: Hang, wanted: Mapping[int, int], elbows: Mapping[int, int]) -> bool:
    """Take a hold with a free limb while the body hangs on another; whether it is on, and both carry.

    Holds where limbs belong come first, then those that ask least of the holding limb's joints.
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
            way = way_to_grab(hang, i, number, elbows.get(i, 0) if meant else 0)
            if way is not None:
                angles, place = way
                found.append((not meant, float(np.abs(angles - hang.angles).max()), i, number, angles, place))
    for other, _, i, number, angles, place in sorted(found, key=lambda each: each[:4])[:WAYS]:
        clear_the_way(climber, place)
        before = hang.angles.copy()
        if not hang.fold(angles):
            hang.fold(before)
            continue
        hang.calm()
        if grab(climber, i, number, elbow=0 if other else elbows.get(i, 0)).held:
            hang.end()
            return True
    return False


def way_to_grab(hang: Hang, i: int, number: int, elbow: int) -> tuple[Floats, Floats] | None:
    """Where a body that hangs lets limb `i` take a hold, both hooks well on top there, and the one that holds on the way, too.

    Args:
        hang: The body.
        i: Index of the limb.
        number: Of the hold.
        elbow: Side of its elbow, +1, -1, or 0 for either.

    Returns:
        The angles of the holding limb's joints that are nearest to where they are, shape (2,) [rad], and the body's pose with them.
    """
    climber, pendulum = hang.climber, hang.pendulum
    body, limb, stay = climber.body, climber.robot.limbs[i], climber.robot.limbs[hang.i]
    hold, own, side = climber.holds[number], body.tasks[hang.i].place, hang.angles[1]
    q = body.q - body.play

    def hangs_at(angles: Floats) -> tuple[Floats, float]:
        q[hang.i] = angles
        pose = pendulum.pose(q, own)
        down = stay.port_angle + pose[2] + angles[0] + angles[1] + stay.end.angle
        return pose, -math.sin(down)

    def reaches(pose: Floats) -> bool:
        return any(
            one.inside
            and one.on_top > ON_TOP
            and abs(one.angles[1]) > STRAIGHT
            and (not elbow or elbow * one.angles[1] > 0.0)
            for one in postures(limb, pose, hold)
        )

    tried = [
        np.array((shoulder, elbow_angle))
        for shoulder in np.arange(stay.shoulder.lower, stay.shoulder.upper, PITCH)
        for elbow_angle in np.arange(stay.elbow.lower, stay.elbow.upper, PITCH)
        if elbow_angle * side > 0.0 and abs(elbow_angle) >= STRAIGHT
    ]
    for angles in sorted(tried, key=lambda one: float(np.abs(one - hang.angles).max())):
        pose, on_top = hangs_at(angles)
        if on_top < ON_TOP or not reaches(pose):
            continue
        least = min(on_top, hangs_at(hang.angles)[1])
        between = (hang.angles + u * (angles - hang.angles) for u in PARTS)
        if all(hangs_at(one)[1] >= least - 1e-9 for one in between):
            return angles, pose
    return None

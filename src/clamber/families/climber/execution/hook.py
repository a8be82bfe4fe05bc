"""Grab and release with a hook, or a foot: straight in from off the hold, pushed until it stops, tugged; straight back off it."""

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from typing import Final

import numpy as np

from ....compiled import Handle, ready
from ....types import Floats
from ..control.hook_push import GOES_ON, HANGING, IS_SEATED, PATIENCE, PUSHING, WIDE_DITHER, push_tick
from .approach import Approach, Wish
from .climber import Climber
from .hook_release import release as release
from .hook_release import stand_off_of
from .motions import JOINT_SPEED, follow, may_move, move_body, move_tip
from .postures import postures
from .swing_contact_monitor import PushedBody

SLACK: Final = 0.008
"""Beyond its doubt, how far a seated hook may be from where it should be: play and backlash [m]."""
SHALLOW: Final = (0.010, 0.015)
"""A hook that stops the first of these before its hold may rest on its flare against it, however hard it is pushed, and slip off later:
it counts as seated where it comes to the same place once more, pushed on from elsewhere; at the second it doesn't at all [m]."""
FAR_OFF: Final = (0.006, 0.012)
"""Likewise one that stops, beyond what the hold is in doubt by, the first of these off it, or the second in all, any way: it may lie on
it with the outer end of its flare [m]."""
PASSED: Final = 0.013
"""One that stops beyond its hold, so far off in all: it may have passed it by, and lean on it with the limb [m]."""
DEEPER: Final = 0.004
"""Likewise one that has come so much farther in an earlier try: nothing goes farther onto its hold than a hook that is home [m]."""
FROM_A_HANG: Final = (0.0115, 0.0125)
"""From a body that hangs one that stops less than the first before its hold, and where that may be, is home: taken off to be tried again, a
hook that was sets the body swinging, and few were not. At the second it isn't, even where it comes there again [m]."""
AT_FULL_REACH: Final = (math.radians(25.0), 0.006, 0.003)
"""A limb whose elbow is straighter than the first may have stopped at the end of its reach, not on its hold: it has if it stops the second
before, and may have where it stops so far off, or the third before [m]."""
SAME: Final = 0.003
"""Two places that are so near to each other are the same [m]."""


def comes_home(
    climber: Climber, i: int, hold: Floats, doubt: float, g: Floats, place: Floats, before: Sequence[Floats]
) -> bool:
    """Push a hook on at a place along its grab direction, and judge by where it stopped whether it is on its hold.

    Args:
        climber: The robot.
        i: Index of the limb.
        hold: Where the hold is believed to be, world frame, shape (2,) [m].
        doubt: How far it may be from there, either way [m].
        g: Grab direction, world frame, shape (2,) [-].
        place: At which it is pushed on, world frame, shape (2,) [m].
        before: Where the tip ended in earlier tries at this hold, world frame [m].

    Raises:
        FallenError: If the robot falls.
    """
    room = SLACK + doubt
    stopped = push_on(climber, i, place, g, room)
    tip = climber.body.tip(i)
    short = float((hold - tip) @ g)
    off = math.dist(tip, hold)
    again = any(math.dist(tip, end) < SAME for end in before)
    shallow = FROM_A_HANG if climber.hangs else SHALLOW
    if not stopped or off > (SHALLOW[1] if again else room) or short > shallow[1]:
        return False
    # twins are nearer to each other than the doubt
    if any(math.dist(tip, other) < off for other in climber.holds.values()):
        return False
    # a body that hangs is drawn near until the limb is straight
    straight = abs(climber.body.q.item(i, 1)) < AT_FULL_REACH[0] and not climber.hangs
    if straight and short > AT_FULL_REACH[1]:
        return False
    home = short < shallow[0]
    if straight:
        home = off < AT_FULL_REACH[1] and short < AT_FULL_REACH[2]
    elif not climber.hangs:
        home = home and off < min(FAR_OFF[0] + doubt, FAR_OFF[1] if short > 0.0 else PASSED)
    farther = any(float((end - tip) @ g) > DEEPER and math.dist(end, hold) < room for end in before)
    return (home and not farther) or again


def push_on(climber: Climber, i: int, place: Floats, g: Floats, room: float) -> bool:
    """Push a hook along its grab direction until it stops, then tug as hard as it will have to carry, until it no longer advances.

    One that stops short of where its hold should be is coaxed across under the tug, as its flare may have met the hold.

    Returns:
        Whether it came to rest under the tug, not farther in than a hold could be. Where the body hangs, it then goes on pulling: what
        let go of would swing.
    """
    body, task, period, hangs = climber.body, climber.body.tasks[i], climber.plant.period, climber.hangs
    task.mode, task.pressed, task.tug = "contact_push", False, np.zeros(2)
    push, forces = np.zeros(1, PUSHING), np.zeros((2, 2))
    push["period"], push["room"], push["hangs"], push["limb"] = period, room, hangs, i
    push["place"], push["grab"], push["most"], push["marks"] = place, g, round(PATIENCE / period), -math.inf
    push["part"], push["coaxing"] = HANGING if hangs else 1.0, WIDE_DITHER
    jobs = body.work.jobs
    go = ready(push_tick, Handle(push, body.pose, body.in_world, jobs, forces))
    task.force, task.tug = forces
    while (state := go()) == GOES_ON:
        climber.tick()
    if hangs and state == IS_SEATED:
        task.force, task.pressed = push["pull"][0], bool(jobs["pressed"][i])
        return True
    task.pressed, task.tug = False, np.zeros(2)
    return bool(state == IS_SEATED)


CLEAR: Final = 0.02
"""So far aside a hook that lies beside its hold comes off it without its flare, 15 mm either way, catching there [m]."""
CAUGHT: Final = 0.01
"""A hook that stays so far from where it is to be is caught [m] ..."""
NO_WAY: Final = (0.002, 0.15)
"""... when it has come no farther than the first of these for the second [m], [s]."""
STEP: Final = 0.01
"""Between postures on the way of a hook that its joints bring straight back [m]."""
BACK_SPEED: Final = 0.05
"""Of a hook on its way back: slow, for what it is caught on it pulls at no harder then [m/s]."""


def back_off(climber: Climber, i: int, hold: Floats, doubt: float, found: Approach) -> None:
    """Bring the hook off where it missed: back the way it came, for the hold may be beside it by now, then to before the hold.

    Where a lip of its flare catches below the hold, it goes to the one side first, then to the other; so does one that has passed the hold
    by, before it goes back: on its way there it had not caught, but hooks catch on their way back.
    """
    away, g, tip = stand_off_of(climber, i, doubt), found.grab, climber.body.tip(i)
    across = np.array((-g[1], g[0]))
    deep = float((tip - hold) @ g) + away
    side = math.copysign(CLEAR, float((tip - hold) @ across))  # the hold is more likely on the other one
    passed = deep - away > SLACK + doubt
    sides = (side, 0.0, -side) if passed else (0.0, side, -side)
    for aside in sides if deep > 0.0 else ():
        start = tip + aside * across
        if aside:
            _comes_to(climber, i, start)
        if _comes_to(climber, i, start - deep * g):
            break
    _comes_to(climber, i, hold - away * g)


def _comes_to(climber: Climber, i: int, place: Floats) -> bool:
    """Bring a tip straight to a place, or to where something holds it: pulled on, other hooks come off; whether it comes there."""
    if climber.hangs or abs(climber.body.q.item(i, 1)) < AT_FULL_REACH[0]:
        return _comes_by_joints(climber, i, place)
    body, period = climber.body, climber.plant.period
    task, start = body.tasks[i], body.tip(i)
    length = math.dist(start, place)
    way = (place - start) / max(length, 1e-9)
    task.mode, gone, mark, stands = "swing_cartesian", 0.0, 0.0, 0.0
    watch = PushedBody(climber)
    while stands < NO_WAY[1]:
        gone = min(gone + BACK_SPEED * period, length)
        task.place, task.speed = start + gone * way, (BACK_SPEED if gone < length else 0.0) * way
        climber.tick()
        if watch.gives_way(i):
            return False
        if math.dist(body.tip(i), place) < CAUGHT:
            break
        come = float((body.tip(i) - start) @ way)
        behind = gone - come > CAUGHT or gone == length
        mark, stands = (come, 0.0) if come > mark + NO_WAY[0] or not behind else (mark, stands + period)
    there = math.dist(body.tip(i), place) < CAUGHT
    task.place, task.speed = place if there else body.tip(i), np.zeros(2)
    return there


def _comes_by_joints(climber: Climber, i: int, place: Floats) -> bool:
    """The same along the postures between: a nearly straight elbow that is to bend at once is thrown by its tip's law.

    From a hang as fast as joints go: there is no other hook to pull off.
    """
    body, task, limb = climber.body, climber.body.tasks[i], climber.robot.limbs[i]
    start, way = body.tip(i), [body.q[i] - body.play[i]]
    side = task.side or math.copysign(1.0, way[0][1])
    for part in np.linspace(0.0, 1.0, max(2, math.ceil(math.dist(start, place) / STEP)) + 1)[1:]:
        fit = postures(limb, body.settled, start + part * (place - start))
        way += [one.angles for one in fit if one.inside and one.angles[1] * side > 0.0][:1]
    if len(way) == 1:
        return False
    turned = float(np.abs(np.diff(way, axis=0)).max(axis=1).sum())
    most = JOINT_SPEED if climber.hangs else min(JOINT_SPEED, BACK_SPEED * turned / max(math.dist(start, place), STEP))
    return follow(climber, i, np.array(way), most=most) and math.dist(body.tip(i), place) < CAUGHT


NEAR: Final = 0.022
"""From here on, and the hold's doubt farther off, the hook is pushed, not placed: nearer, its flare would meet the hold sideways [m]."""
ASIDE: Final = (0.0, 0.8, -0.8, 1.4, -1.4, 0.0)
"""Across the hook, where each try aims, in doubts of the map [-]."""
MOST_SHIFTS: Final = 2
"""That often the body makes room for one way: its limbs are elsewhere after the first [-]."""
ASTRAY: Final = 0.05
"""A body may be as far from where a plan has it when a limb takes a hold, if the others hold no worse there, along x and y [m] ..."""
TURNED: Final = 0.05
"""... and turned by as much [rad]."""
FORTH: Final = (0.2, 0.9)
"""In which a hook then goes to before the hold, the first time and after a miss, when it may meet the hold sideways: its motors, which
their gears make heavy, would knock other hooks off [s]."""
FADING: Final = 1.0
"""In which the pull of a hook that is not home goes down where the body hangs, about a swing [s]."""


def come_near(climber: Climber, i: int, number: int, doubt: float, elbow: int, home: Floats | None) -> Approach | None:
    """Move the body to where there is a way for a limb, and find the way from there; None where there is none."""
    body, hold = climber.body, climber.holds[number].copy()
    wish = Wish(elbow=elbow, stand_off=stand_off_of(climber, i, doubt), near=NEAR + doubt)

    def way(stands: Callable[[Floats], bool], *, straight: bool = True) -> Approach | None:
        climber.plant.pause()
        return climber.approaches.find(
            i,
            body.q[i] - body.play[i],
            body.settled,
            hold,
            climber.discs(),
            replace(wish, straight=straight),
            stands=stands,
        )

    if home is not None:
        found = way(_stays, straight=False)
        if found is not None:
            return found
        move_body(climber, home)
    for left in reversed(range(MOST_SHIFTS + 1)):
        may = left and not climber.hangs
        found = way(may_move(climber) if may else _stays)
        if found is None and may:  # holds are rarely as near as they may be
            found = way(may_move(climber, touching=True))
        if found is None or not found.shift.any():
            return found
        move_body(climber, body.aim + np.array((*found.shift, 0.0)))
    return None


def places(
    climber: Climber, i: int, hold: Floats, doubt: float, found: Approach, before: Sequence[Floats]
) -> Iterator[Floats]:
    """Where each try aims: at the hold as believed, then beside it, across the hook, first on the other side of where it missed."""
    across = np.array((-found.grab[1], found.grab[0]))
    for part in ASIDE:
        side = -math.copysign(1.0, float((before[0] - hold) @ across)) if before else 1.0
        yield hold + side * part * doubt * across


def close(
    climber: Climber, i: int, hold: Floats, doubt: float, found: Approach, place: Floats, before: Sequence[Floats]
) -> bool:
    """Push the hook on at a place; whether it came to rest where the hold may be, and not on its flare."""
    if not move_tip(climber, i, place - (NEAR + doubt) * found.grab, FORTH[bool(before)]):
        return False
    if comes_home(climber, i, hold, doubt, found.grab, place, before):
        return True
    if not climber.hangs:
        return False
    # as the pull fades the body comes back, and draws a hook that has caught with its flare across its hold
    _fade(climber, i)
    if comes_home(climber, i, hold, doubt, found.grab, place, before):
        return True
    _fade(climber, i)
    return False


def press_on(climber: Climber, i: int, hold: Floats, doubt: float) -> bool:
    """Push a hook that has slid back, but not off its hold, home from where it is; whether it came to rest there."""
    return comes_home(climber, i, hold, doubt, climber.body.grab_direction(i), hold, ())


def _fade(climber: Climber, i: int) -> None:
    """Let a hook pull less and less, until not at all: let go of at once, a body that it has drawn aside swings."""
    task, force = climber.body.tasks[i], climber.body.tasks[i].force.copy()
    count = round(FADING / climber.plant.period)
    for k in range(count):
        task.force = (1.0 - (k + 1) / count) * force
        climber.tick()


def may_stay(climber: Climber, i: int, pose: Floats) -> bool:
    """Whether limb `i` may take a hold from where the body is, near another pose: the limbs that then carry hold no worse here."""
    body = climber.body
    off = np.abs(pose - body.aim)
    if climber.hangs or off[:2].max() > ASTRAY or off[2] > TURNED:
        return False
    others = [j for j, task in enumerate(body.tasks) if j != i and task.hold]
    return body.stands(body.aim, others) >= min(0.0, body.stands(pose, others))


def _stays(pose: Floats) -> bool:
    return False

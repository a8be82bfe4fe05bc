"""Motions that all actions are made of: the body on smooth ways, free limbs out of its way, tips and joints of limbs."""

import math
from collections.abc import Callable, Mapping
from typing import Final

import numpy as np

from ....compiled import Handle, ready
from ....types import Floats
from ..control.swing_path import GOES, IS_HELD, IS_THERE, ON_WAY, go_along
from .climber import Climber
from .parking import SPARE, TIGHT, park, passes, poses_between, room_along
from .postures import postures
from .swing_contact_monitor import PushedBody

BODY_SPEED: Final = 0.08
"""Of the body's aim, at most [m/s]."""
BODY_RISE: Final = 0.3
"""In which it comes to that speed, at most; a short way is all rise [s]."""
SLOW: Final = 0.04
"""Likewise while a limb clings to its hold, which its rotors' inertia would drag off [m/s]."""
BODY_TURN: Final = 0.4
"""[rad/s]."""
JOINT_SPEED: Final = 2.6
"""Of a free limb's joints on their way, seven eighths of what their motors can, at `USUAL_SPEED` [rad/s]."""
JOINT_AGILITY: Final = 14.0
"""With which they come to it, half of what the weakest can, at `USUAL_AGILITY` [rad/s^2]."""
SURGE: Final = 20.0
"""Most that a joint is sped up by at corners of its way, in whichever direction, at `USUAL_AGILITY`: the body feels what motors do to limbs
[rad/s^2]."""
LAG: Final = (0.015, 0.045)
"""A limb this far behind on its way is slowed down, at the second until it has come after: its motors give all they can [rad]."""
STANDS: Final = (0.1, 0.25)
"""One that is slowed down to less than this part of its speed for so long is held by something [-], [s]."""
REGAINING: Final = 0.1
"""In which it comes from a stand back to its speed; it stops at once [s]."""
WAITING: Final = 1.5
"""For that long in all, on one way [s]."""
BEHIND: Final = (0.012, 0.022)
"""A body this far behind on its way is slowed down, at the second until it has come after [m]; not for ever (`WAITING`)."""
JAMMED: Final = 1.3
"""One that stands and presses a tip with more than this part of the weight on something has a link or hook jammed between holds [-]."""
HELD_BACK: Final = (0.04, 0.3)
"""One that is so for this long, or this far behind, is held by what it cannot overcome [m], [s]."""
BLEND: Final = 0.2
"""Over which corners of a limb's way are rounded [s]."""
WEAKER: Final = 3.0
"""By how much the worst of the holding limbs may be worse off where the body makes room for a grab [N]."""


def move_body(climber: Climber, pose: Floats, *, drawn: tuple[int, Floats, Floats] | None = None) -> bool:
    """Bring the body to a pose (x, y, theta) along a straight smooth way; free limbs first go to where they meet no hold on it.

    Where something holds it on its way it goes back to where it began: pulled on, its hooks would come off.

    Args:
        climber: The robot.
        pose: Shape (3,).
        drawn: A limb whose tip goes straight in the world in step with the body, where from, and its way, both shape (2,) [m].

    Returns:
        Whether it has gone all of the way.
    """
    clear_the_way(climber, pose)
    body, period = climber.body, climber.plant.period
    if drawn is not None:
        body.tasks[drawn[0]].mode = "swing_cartesian"
    speed = SLOW if any(task.mode == "unloaded_contact" for task in body.tasks) else BODY_SPEED
    start = body.aim.copy()
    change = pose - start
    # the way in seconds at full speed
    length = max(
        float(np.hypot(change[0], change[1])) / speed, abs(float(change[2])) / (BODY_TURN * speed / BODY_SPEED), 0.2
    )
    rise = min(BODY_RISE, 0.5 * length)
    gone, pace, waited, held = 0.0, 1.0, 0.0, 0.0
    yielding: set[int] = set()
    # hooks that hold each other sideways let a body sag, and press hard, before it moves
    sags, presses = math.dist(body.aim[:2], body.pose[:2]), _presses(climber)
    while gone < length + rise:
        behind = math.dist(body.aim.tolist()[:2], body.pose.tolist()[:2])
        wished = float(np.interp(behind - sags, BEHIND, (1.0, 0.0))) if drawn is None and waited < WAITING else 1.0
        pace = min(wished, pace + period / REGAINING)
        waited += (1.0 - pace) * period
        stuck = behind > HELD_BACK[0] or (pace < STANDS[0] and _is_jammed(climber, presses))
        held = held + period if stuck else 0.0
        if behind > BEHIND[0]:
            yielding |= _yield(climber)
        if held > HELD_BACK[1] and drawn is None:
            _go_back(climber, start, max(1, round(gone / period)))
            break
        gone = min(gone + pace * period, length + rise)
        done, rate = eased(gone, length, rise)
        body.aim[:] = start + done / length * change
        body.aim_speed[:] = pace * rate / length * change
        if drawn is not None:
            i, start_tip, way = drawn
            body.tasks[i].place, body.tasks[i].speed = start_tip + done / length * way, rate / length * way
        climber.tick()
    body.aim_speed[:] = 0.0
    for i in yielding:
        body.tasks[i].stay(body.q[i])
    if drawn is not None:
        body.tasks[drawn[0]].speed = np.zeros(2)
    return gone >= length + rise


def _yield(climber: Climber) -> set[int]:
    """Let free limbs that wait, and are pressed away from where they are to be, go where what presses them wants; which."""
    body, found = climber.body, set()
    for i, task in enumerate(body.tasks):
        if task.mode == "swing_joint" and float(np.abs(task.angles - body.q[i]).max()) > LAG[0]:
            task.give_way()
            found.add(i)
    return found


def _presses(climber: Climber) -> Floats:
    """With what each limb on a hold presses on what it touches, nothing where that cannot be told, shape (limbs,) [N]."""
    forces = np.where(np.isfinite(climber.fall.forces), climber.fall.forces, 0.0)
    holds = [task.holds for task in climber.body.tasks]
    return np.where(holds, np.hypot(forces[:, 0], forces[:, 1]), 0.0)


def _is_jammed(climber: Climber, before: Floats) -> bool:
    """Whether a limb on a hold presses on what it touches with more than the robot's weight lets it, and did much less before."""
    now, weight = _presses(climber), climber.robot.weight
    return bool(((now > JAMMED * weight) & (now - before > (JAMMED - 1.0) * weight)).any())


def _go_back(climber: Climber, start: Floats, ticks: int) -> None:
    """Bring a body back to where it began, in as many ticks."""
    body = climber.body
    change = start - body.aim
    for k in range(1, ticks + 1):
        body.aim[:] = start - (1.0 - k / ticks) * change
        body.aim_speed[:] = change / (ticks * climber.plant.period)
        climber.tick()


def eased(t: float, length: float, rise: float) -> tuple[float, float]:
    """Way and speed at a time on a way at speed 1 that begins and ends gently within `rise` [s], at most `length`."""
    left = length + rise - t
    u = min(t, left, rise) / rise
    way, speed = rise * u**3 * (1.0 - 0.5 * u) + max(0.0, min(t, left) - rise), u * u * (3.0 - 2.0 * u)
    return (way if t < left else length - way), speed


def clear_the_way(climber: Climber, pose: Floats, spare: float = SPARE) -> None:
    """Bring free limbs `spare` clear of holds [m], or as far as they can be, while the body goes straight to a pose."""
    for i, task in enumerate(climber.body.tasks):
        if not task.hold:
            _park(climber, i, pose, spare)


def is_clear(climber: Climber, pose: Floats, spare: float) -> bool:
    """Whether free limbs, where they are, are by `spare` clear of holds [m] while the body goes straight to a pose."""
    body = climber.body
    way, free = poses_between(body.settled, pose), [i for i, task in enumerate(body.tasks) if not task.hold]
    discs = climber.discs()
    return all(room_along(climber.approaches, i, body.q[i] - body.play[i], way, discs) >= spare for i in free)


def _park(climber: Climber, i: int, pose: Floats, spare: float) -> None:
    body = climber.body
    climber.plant.pause()
    poses = poses_between(body.settled, pose)
    way = park(climber.approaches, i, body.q[i] - body.play[i], poses, climber.discs(), spare, TIGHT)
    if way is not None:
        follow(climber, i, way)


def may_move(climber: Climber, *, touching: bool = False) -> Callable[[Floats], bool]:
    """Whether the body can go to another pose: limbs on holds hardly hold worse and meet no other hold, nor do free ones on the way.

    Args:
        climber: The robot.
        touching: Whether limbs on holds may meet others all the same.
    """
    body = climber.body
    least = min(0.0, body.stands(body.settled)) - WEAKER
    free = [(i, body.q[i] - body.play[i]) for i, task in enumerate(body.tasks) if not task.hold]
    discs, others = climber.discs(), {task.hold: climber.discs(task.hold) for task in body.tasks if task.hold}
    tight = -math.inf if touching else min(0.0, _room_of_links(climber, body.settled, others))

    def stands(pose: Floats) -> bool:
        if body.stands(pose) < least or _room_of_links(climber, pose, others) < tight:
            return False
        way = poses_between(body.settled, pose)
        return all(passes(climber.approaches, i, q, way, discs) for i, q in free)

    return stands


def _room_of_links(climber: Climber, pose: Floats, others: Mapping[int, Floats]) -> float:
    """Least room between limbs on holds and all other holds at a pose of the body [m]; negative: one meets one, or its own is too far.

    `others`: a limb's hold -> all but that as `Climber.discs`.
    """
    body, ways, least = climber.body, climber.approaches, math.inf
    for i, task in enumerate(body.tasks):
        if not task.hold:
            continue
        side = body.q[i, 1] - body.play[i, 1]
        fit = [one for one in postures(climber.robot.limbs[i], pose, task.place) if one.angles[1] * side > 0.0]
        if not fit:
            return -math.inf
        least = min(least, room_along(ways, i, fit[0].angles, [pose], others[task.hold]))
    return least


def move_tip(climber: Climber, i: int, place: Floats, seconds: float) -> bool:
    """Bring a free limb's tip straight to a place of the world [m], from rest to rest; whether it goes there.

    One that pushes the body away by what it meets gives way.
    """
    task, period = climber.body.tasks[i], climber.plant.period
    task.mode = "swing_cartesian"
    start = climber.body.tip(i)
    count, rise, way = max(1, round(seconds / period)), seconds / 3, place - start
    watch = PushedBody(climber)
    for k in range(1, count + 1):
        done, rate = eased(k / count * seconds, seconds - rise, rise)
        task.place, task.speed = start + done / (seconds - rise) * way, rate / (seconds - rise) * way
        climber.tick()
        if watch.gives_way(i):
            return False
    task.speed = np.zeros(2)
    return True


def follow(
    climber: Climber, i: int, way: Floats, lags: tuple[float, float] = LAG, *, most: float = JOINT_SPEED
) -> bool:
    """Bring a free limb's joints along a way, shape (n, 2) [rad], smoothly from rest to rest; whether it comes to the end.

    One that something holds stays there and pulls no more, and one that pushes the body away gives way: they would take other hooks off.

    Args:
        climber: The robot.
        i: Index of the limb.
        way: From corner to corner.
        lags: How far behind the limb is slowed down, and waited for [rad].
        most: Speed of its joints, at `USUAL_SPEED`; slower than they can, it gives way to less, for the body hardly sways then [rad/s].
    """
    task, period = climber.body.tasks[i], climber.plant.period
    lengths = np.abs(np.diff(way, axis=0)).max(axis=1)
    along = np.concatenate(([0.0], np.cumsum(lengths)))
    blend = max(2, round(BLEND / period))
    done = at_speed(along[-1], period, climber.swiftness * most, climber.agility * JOINT_AGILITY)
    angles = np.stack([np.interp(done, along, way[:, j]) for j in range(2)], axis=1)
    # rounded corners: a turn on the spot throws the body about
    window = np.hanning(blend + 2)[1:-1]
    padded = np.concatenate((np.repeat(way[:1], blend, axis=0), angles, np.repeat(way[-1:], blend, axis=0)))
    smooth = np.stack([np.convolve(padded[:, j], window / window.sum(), "valid") for j in range(2)], axis=1)
    rates = np.diff(smooth, axis=0) / period
    surges = np.diff(rates, axis=0, append=0.0) / period
    paces = _round_corners(surges, window, climber.agility * SURGE)
    task.mode = "swing_joint"
    body, aims = climber.body, np.zeros((3, 2))
    task.angles, task.rates, task.accelerations = aims
    on_way = np.zeros(1, ON_WAY)
    on_way[0] = 0.0, 1.0, 0.0, 0.0, period, period / REGAINING, WAITING, *STANDS, lags, 2.0
    joints = body.q[i], body.play[i], smooth, np.diff(smooth, axis=0), rates, surges, paces
    go = ready(go_along, Handle(on_way, *joints, aims, body.work.jobs[i : i + 1]))
    watch = PushedBody(climber, brisk=most >= JOINT_SPEED)
    while (state := go()) == GOES:
        climber.tick()
        if watch.gives_way(i):
            return False
    task.stay(body.q[i] if state == IS_HELD else way[-1] + body.play[i])
    return bool(state == IS_THERE)


def _round_corners(surges: Floats, window: Floats, surge: float) -> Floats:
    """Part of its speed with which a way is gone at each tick, so that no joint is sped up by more than `surge` [rad/s^2].

    Args:
        surges: Of the joints at full speed, shape (n, joints) [rad/s^2].
        window: Weights over which the pace changes, shape (ticks,).
    """
    most = np.abs(surges).max(axis=1)
    paces = np.sqrt(surge / np.maximum(most, surge))
    half = len(window) // 2
    wide = np.pad(paces, 2 * half, mode="edge")
    least = np.lib.stride_tricks.sliding_window_view(wide, 2 * half + 1).min(axis=1)
    return np.convolve(least, window[: 2 * half + 1] / window[: 2 * half + 1].sum(), "same")[half : half + len(paces)]


def at_speed(length: float, period: float, most: float = JOINT_SPEED, agility: float = JOINT_AGILITY) -> Floats:
    """How far along a way one is at each tick, from rest to rest, at most so fast [rad/s], [rad/s^2]; shape (ticks,)."""
    speed = min(most, float(np.sqrt(length * agility)))
    rise = speed / agility
    seconds = length / speed + rise if speed > 0.0 else 0.0
    t = period * np.arange(1, int(np.ceil(seconds / period)) + 1)
    left = np.maximum(seconds - t, 0.0)
    up, down = 0.5 * agility * t**2, length - 0.5 * agility * left**2
    done: Floats = np.where(t < rise, up, np.where(left < rise, down, speed * (t - 0.5 * rise)))
    return done

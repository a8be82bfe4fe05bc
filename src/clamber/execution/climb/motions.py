"""Motions: how each kind of action is carried out. Body moves on smooth ways, releases, and the grab of Bevly (1997), Fig. 4.14."""

import math
from collections.abc import Callable
from itertools import pairwise
from typing import Final

import numpy as np

from ...types import Floats
from .approach import SHIFTS, Approach, free_distance
from .climber import Climber, Grabbed
from .parking import park, passes, poses_between

BODY_SPEED: Final = 0.08
"""Of the body's aim, at most [m/s]."""
BODY_RISE: Final = 0.3
"""In which it comes to that speed, at most; a short way is all rise [s]."""
SLOW: Final = 0.04
"""Likewise while a limb clings to its hold, which its rotors' inertia would drag off [m/s]."""
BODY_TURN: Final = 0.4
"""[rad/s]."""
JOINT_SPEED: Final = 2.6
"""Of a free limb's joints on their way, seven eighths of what their motors can [rad/s]."""
JOINT_AGILITY: Final = 14.0
"""With which they come to it [rad/s^2]."""
LAG: Final = 0.06
"""A limb this far behind on its way is waited for: its motors give all they can [rad]."""
WAITING: Final = 1.5
"""For that long in all, on one way [s]."""
BLEND: Final = 0.2
"""Over which corners of a limb's way are rounded [s]."""
WIDE_STAND_OFF: Final = 0.042
"""Least distance from a hold at which a hook that opens along its link turns towards it: nearer, its flare knocks the hold [m]."""
NEAR: Final = 0.022
"""From here on, and the hold's doubt farther off, the hook is pushed, not placed: nearer, its flare would meet the hold sideways [m]."""
PUSH: Final = 10.0
"""Gentle pull along the grab direction until the hook stops [N]."""
HASTE: Final = 8.0
"""So much more while the hold, wherever it is, is still ahead: a stiff joint would creep there [N]."""
FREE: Final = 0.005
"""Least distance from the nearest place where the hold may be for all of that [m]."""
TUG: Final = 10.0
"""Pull on a hook that has stopped: a quarter of LIBRA's weight; more would lift the limb below off its hold [N]."""
LIFT: Final = (0.003, 0.006)
"""A push that lifts the body this far weakens, to a third at the second: it bears already, and other hooks would come off [m]."""
SLIDING: Final = (0.003, 0.006)
"""So does one under which the tips of holding limbs come apart this far: a hook is coming off, unless joints cross their play [m]."""
FIRM: Final = 0.7
"""A push that has weakened to less of itself tells no seat [-]: it begins anew from where the body has come to rest ..."""
ANEW: Final = 2
"""... so often at most."""
TUG_RISE: Final = 0.1
"""In which the tug grows to its full size [s]."""
BORNE_TIME: Final = 0.05
"""Over which what a push meets is smoothed [s]."""
DITHER: Final = 8.0
"""Pull across, to and fro, so that friction lets the hook slide in [N]."""
DITHER_RATE: Final = 5.0
"""[Hz]."""
AWAY: Final = 0.006
"""A limb that leaves a hold aims this far beyond where it is clear of it: its tip lags its aim [m]."""
LEAVING: Final = 0.5
"""Most time that it then gets to come clear [s]."""
SHAKING: Final = 2.0
"""Most time for which a wedged hook is shaken [s]."""
SHORT: Final = 0.004
"""A hook that stops this far before where its hold should be may have met it with its flare [m]."""
WIDE_DITHER: Final = 14.0
"""Then the dither is so strong [N] ..."""
WIDE_RATE: Final = 2.5
"""... and so slow that it moves the hook across by millimetres [Hz]."""
STUCK: Final = 0.8
"""At most for that long without an advance [s]."""
PROVING: Final = 0.2
"""For so long a hook that carries for the first time does so before the limb that carried until then leaves its own hold: one that has
stopped on its flare slides home in it, or off [s]."""
HANGING: Final = 0.4
"""Part of these forces where the body hangs on one limb, which gives way [-]."""
CENTRING: Final = 150.0
"""Pull towards the believed hold across the hook [N/m]."""
ADVANCE: Final = 0.0015
"""A tip that advances less than this along the grab direction has stopped [m]."""
CREEP: Final = 0.0006
"""So has one under a tug that advances less than this: a hook creeps in on its flare [m]."""
STOPPED: Final = 0.2
"""For that long, a period of the dither, before the tug begins [s]."""
STILL: Final = 0.25
"""For that long under the full tug before a hook counts as seated [s]."""
PATIENCE: Final = 5.0
"""For one push [s]."""
ASIDE: Final = (0.0, 0.8, -0.8, 1.4, -1.4, 0.0)
"""Across the hook, where each try aims, in doubts of the map [-]."""
WEAKER: Final = 3.0
"""By how much the worst of the holding limbs may be worse off where the body makes room for a grab [N]."""
MOST_SHIFTS: Final = 2
"""That often the body makes room for one way: its limbs are elsewhere after the first [-]."""
ASTRAY: Final = 0.05
"""A body may be as far from where a plan has it when a limb takes a hold, if the others hold no worse there, along x and y [m] ..."""
TURNED: Final = 0.05
"""... and turned by as much [rad]."""
SLACK: Final = 0.008
"""Beyond its doubt, how far a seated hook may be from where it should be: play and backlash [m]."""


def move_body(climber: Climber, pose: Floats, *, drawn: tuple[int, Floats, Floats] | None = None) -> None:
    """Bring the body to a pose (x, y, theta) along a straight smooth way; free limbs first go to where they meet no hold on it.

    Args:
        climber: The robot.
        pose: Shape (3,).
        drawn: A limb whose tip goes straight in the world in step with the body, where from, and its way, both shape (2,) [m].
    """
    clear_the_way(climber, pose)
    body, period = climber.body, climber.plant.period
    if drawn is not None:
        body.tasks[drawn[0]].doing = "tip"
    speed = SLOW if any(task.doing == "cling" for task in body.tasks) else BODY_SPEED
    start = body.aim.copy()
    change = pose - start
    # the way in seconds at full speed
    length = max(
        float(np.hypot(change[0], change[1])) / speed, abs(float(change[2])) / (BODY_TURN * speed / BODY_SPEED), 0.2
    )
    rise = min(BODY_RISE, 0.5 * length)
    count = max(1, round((length + rise) / period))
    for k in range(1, count + 1):
        done, rate = eased(k / count * (length + rise), length, rise)
        body.aim[:] = start + done / length * change
        body.aim_speed[:] = rate / length * change
        if drawn is not None:
            i, start_tip, way = drawn
            body.tasks[i].place, body.tasks[i].speed = start_tip + done / length * way, rate / length * way
        climber.tick()
    body.aim_speed[:] = 0.0
    if drawn is not None:
        body.tasks[drawn[0]].speed = np.zeros(2)


def eased(t: float, length: float, rise: float) -> tuple[float, float]:
    """Way and speed at a time on a way at speed 1 that begins and ends gently within `rise` [s], at most `length`."""
    left = length + rise - t
    u = min(t, left, rise) / rise
    way, speed = rise * u**3 * (1.0 - 0.5 * u) + max(0.0, min(t, left) - rise), u * u * (3.0 - 2.0 * u)
    return (way if t < left else length - way), speed


def clear_the_way(climber: Climber, pose: Floats) -> None:
    """Bring free limbs to where they meet no hold while the body goes straight to a pose."""
    for i, task in enumerate(climber.body.tasks):
        if not task.hold:
            _park(climber, i, pose)


def _park(climber: Climber, i: int, pose: Floats) -> None:
    body = climber.body
    climber.plant.pause()
    way = park(climber.approaches, i, body.q[i] - body.play[i], poses_between(body.settled, pose), climber.holds)
    if way is not None:
        follow(climber, i, way)


def move_tip(climber: Climber, i: int, place: Floats, seconds: float) -> None:
    """Bring a free limb's tip straight to a place of the world [m]."""
    task, period = climber.body.tasks[i], climber.plant.period
    task.doing = "tip"
    start = climber.body.tip(i)
    count = max(1, round(seconds / period))
    for k in range(1, count + 1):
        task.place = start + k / count * (place - start)
        task.speed = (place - start) / seconds
        climber.tick()
    task.speed = np.zeros(2)


def follow(climber: Climber, i: int, way: Floats) -> None:
    """Bring a free limb's joints along a way, shape (n, 2) [rad], smoothly from rest to rest."""
    task, period = climber.body.tasks[i], climber.plant.period
    lengths = np.abs(np.diff(way, axis=0)).max(axis=1)
    along = np.concatenate(([0.0], np.cumsum(lengths)))
    blend = max(2, round(BLEND / period))
    done = at_speed(along[-1], period)
    angles = np.stack([np.interp(done, along, way[:, j]) for j in range(2)], axis=1)
    # rounded corners: a turn on the spot throws the body about
    window = np.hanning(blend + 2)[1:-1]
    padded = np.concatenate((np.repeat(way[:1], blend, axis=0), angles, np.repeat(way[-1:], blend, axis=0)))
    smooth = np.stack([np.convolve(padded[:, j], window / window.sum(), "valid") for j in range(2)], axis=1)
    task.doing = "joints"
    q, waited = climber.body.q[i], 0.0
    for before, after in pairwise(smooth):
        # a limb that lags cuts the corners of its way, and knocks against what it was to go round
        while np.abs(before - q).max() > LAG and waited < WAITING:
            task.rates = np.zeros(2)
            climber.tick()
            waited += period
        task.angles, task.rates = after, (after - before) / period
        climber.tick()
    task.angles, task.rates = way[-1].copy(), np.zeros(2)


def at_speed(length: float, period: float) -> Floats:
    """How far along a way of some length one is at each tick, from rest to rest, at most JOINT_SPEED fast; shape (ticks,)."""
    speed = min(JOINT_SPEED, float(np.sqrt(length * JOINT_AGILITY)))
    rise = speed / JOINT_AGILITY
    seconds = length / speed + rise if speed > 0.0 else 0.0
    t = period * np.arange(1, int(np.ceil(seconds / period)) + 1)
    left = np.maximum(seconds - t, 0.0)
    up, down = 0.5 * JOINT_AGILITY * t**2, length - 0.5 * JOINT_AGILITY * left**2
    done: Floats = np.where(t < rise, up, np.where(left < rise, down, speed * (t - 0.5 * rise)))
    return done


def stand_off_of(climber: Climber, i: int, doubt: float) -> float:
    """How far from a hold a limb's hook turns towards it, the hold's place in doubt by so much [m]."""
    free = free_distance(climber.peg_radius, doubt)
    return free if climber.robot.limbs[i].end.offset > 0.0 else max(WIDE_STAND_OFF, free)


def release(climber: Climber, i: int) -> None:
    """Take a limb off its hold, against its grab direction, until its tip is clear of it; the others carry.

    A hook that stays wedged clings to its hold as before.
    """
    _lean_on_the_others(climber, i)
    climber.carry_with_all(but=i)
    if climber.latest >= 0 and not climber.proven:
        climber.wait(PROVING)
        climber.proven = True
    body, task = climber.body, climber.body.tasks[i]
    away = stand_off_of(climber, i, climber.map.error(task.hold)) + AWAY
    start, g = _draw_back(climber, i, away)

    def clear() -> bool:
        return float((start - body.tip(i)) @ g) > away - AWAY

    for _ in range(round(LEAVING / climber.plant.period)):
        if clear():
            break
        climber.tick()
    if not clear() and not _shake_off(climber, i, clear):
        task.doing = "cling"
        return
    task.hold, task.doing, task.angles = 0, "joints", body.q[i].copy()


def _shake_off(climber: Climber, i: int, clear: Callable[[], bool]) -> bool:
    """Pull a wedged hook back and to and fro, free to go where its walls let it; whether it comes clear."""
    body, task, period = climber.body, climber.body.tasks[i], climber.plant.period
    task.doing, task.pressed = "pull", True
    for k in range(round(SHAKING / period)):
        g = body.grab_direction(i)
        task.force = -PUSH * g + WIDE_DITHER * np.sin(2 * np.pi * WIDE_RATE * k * period) * np.array((-g[1], g[0]))
        climber.tick()
        if clear():
            break
    task.pressed = False
    return clear()


def _lean_on_the_others(climber: Climber, i: int) -> None:
    """Move the body to where the two others can carry it, if they cannot here, while limb `i` is still on its hold."""
    body = climber.body
    others = [j for j, task in enumerate(body.tasks) if j != i and task.hold]
    if climber.hangs or len(others) != 2:
        return
    climber.plant.pause()
    margins, stands = [], _stands(climber)
    for x, y in SHIFTS:
        pose = body.settled + np.array((x, y, 0.0))
        margin = body.stands(pose, others)
        margins.append(margin if body.stands(pose, [i]) >= 0.0 and stands(pose) else -np.inf)
        if margin >= 0.0 and margins[-1] == margin:
            break
    best = int(np.argmax(margins))
    if margins[best] > body.stands(body.settled, others) + WEAKER:
        move_body(climber, body.aim + np.array((*SHIFTS[best], 0.0)))


def _draw_back(climber: Climber, i: int, away: float) -> tuple[Floats, Floats]:
    """Draw a hook straight back off its hold by a distance [m], the body moved to where the limb can if it reaches no farther.

    The body moves at the same time where the elbow stays well bent on all of the way, before it otherwise.

    Returns:
        The tip's place and the grab direction from which it was drawn back.
    """
    body = climber.body
    start, g = body.tip(i), body.grab_direction(i)
    shift, in_step = _room_to_leave(climber, i, start, -away * g)
    pose = body.aim + np.array((*shift, 0.0))
    if in_step:
        move_body(climber, pose, drawn=(i, start, -away * g))
        return start, g
    if shift.any():
        move_body(climber, pose)
        start, g = body.tip(i), body.grab_direction(i)
    move_tip(climber, i, start - away * g, 0.35)
    return start, g


def _room_to_leave(climber: Climber, i: int, start: Floats, back: Floats) -> tuple[Floats, bool]:
    """How the body moves so that a limb can draw its hook back, shape (2,) [m], and whether both may move in step."""
    if climber.hangs:
        return np.zeros(2), False
    body, ways = climber.body, climber.approaches
    climber.plant.pause()
    side = float(np.sign(body.q[i, 1] - body.play[i, 1]))
    shift = ways.leave(i, side, body.settled, start, back, climber.holds, stands=_stands(climber))
    if shift is None or not shift.any():
        return np.zeros(2), False
    return shift, ways.bends(i, side, body.settled, start, back, shift)


def _stands(climber: Climber) -> Callable[[Floats], bool]:
    """Whether the body can go to another pose: limbs that hold do so hardly worse than here, and free ones meet no hold on the way."""
    body = climber.body
    least = min(0.0, body.stands(body.settled)) - WEAKER
    free = [(i, body.q[i] - body.play[i]) for i, task in enumerate(body.tasks) if not task.hold]

    def stands(pose: Floats) -> bool:
        if body.stands(pose) < least:
            return False
        way = poses_between(body.settled, pose)
        return all(passes(climber.approaches, i, q, way, climber.holds) for i, q in free)

    return stands


def grab(climber: Climber, i: int, number: int, *, elbow: int = 0, home: Floats | None = None) -> Grabbed:
    """Bring a limb to a hold and hook on: off the old one, round to the new, push until it stops, tug; try again beside where it misses.

    Args:
        climber: The robot.
        i: Index of the limb.
        number: Of the hold.
        elbow: Side of the elbow to hold with: +1, -1, or 0 for the hook most on top.
        home: Pose to which the body goes where there is no way from where it is, before it makes room; None: it is there.

    Raises:
        FallenError: If the robot falls.
    """
    body, task = climber.body, climber.body.tasks[i]
    if task.hold:
        release(climber, i)
    else:
        climber.carry_with_all(but=i)
    if task.hold:
        return Grabbed(False, 0, 0.0, 0.0)
    doubt = climber.doubt(number, i)
    hold = climber.holds[number].copy()
    wished, near, room = stand_off_of(climber, i, doubt), NEAR + doubt, SLACK + doubt
    found = _come_near(climber, i, hold, elbow, home, wished, near)
    if found is None:
        return Grabbed(False, 0, 0.0, 0.0)
    follow(climber, i, found.way)
    climber.wait(0.15)
    climber.learn_again()
    hold = climber.holds[number].copy()
    along = across = 0.0
    g = found.grab
    h = np.array((-g[1], g[0]))
    for tries, part in enumerate(ASIDE, 1):
        aside = part * doubt
        move_tip(climber, i, hold - near * g + aside * h, 0.5 if tries > 1 else 0.2)
        stopped = _push(climber, i, hold + aside * h, g, room)
        off = body.tip(i) - hold
        along, across = float(off @ g), float(off @ h)
        if stopped and math.hypot(along, across) < room:
            climber.learn(number, i, climber.holding())
            climber.latest, climber.proven = i, False
            task.doing, task.hold, task.place = "cling", number, climber.holds[number].copy()
            climber.wait(0.1)
            return Grabbed(True, tries, along, across)
        move_tip(climber, i, hold - wished * g, 0.5)
    task.doing, task.angles = "joints", body.q[i].copy()
    return Grabbed(False, len(ASIDE), along, across)


def _come_near(
    climber: Climber, i: int, hold: Floats, elbow: int, home: Floats | None, wished: float, near: float
) -> Approach | None:
    """Move the body to where there is a way for a limb, and find the way from there; None where there is none."""
    body = climber.body

    def way(stands: Callable[[Floats], bool]) -> Approach | None:
        climber.plant.pause()
        return climber.approaches.find(
            i, body.q[i] - body.play[i], body.settled, hold, climber.holds, elbow=elbow, stand_off=wished, near=near,
            stands=stands,
        )  # fmt: skip

    if home is not None:
        found = way(_stays)
        if found is not None:
            return found
        move_body(climber, home)
    for left in reversed(range(MOST_SHIFTS + 1)):
        found = way(_stands(climber) if left and not climber.hangs else _stays)
        if found is None or not found.shift.any():
            return found
        move_body(climber, body.aim + np.array((*found.shift, 0.0)))
    return None


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


def _push(climber: Climber, i: int, place: Floats, g: Floats, room: float) -> bool:
    """Push a hook along its grab direction until it stops, then tug as hard as it will have to carry, until it no longer advances.

    One that stops short of where its hold should be is coaxed across under the tug, as its flare may have met the hold.

    Returns:
        Whether it came to rest under the tug, not farther in than a hold could be.
    """
    body, task, period = climber.body, climber.body.tasks[i], climber.plant.period
    # believed to press from the start: in free air the tip is then farther in than believed, never less far
    task.doing, task.pressed, task.tug = "pull", True, np.zeros(2)
    stage, still, tugged, phase, borne = "push", 0.0, 0.0, 0.0, 0.0
    seated, marks, anew = False, np.full(2, -np.inf), 0
    rested, apart = body.pose[:2].copy(), _apart(climber)
    part = HANGING if climber.hangs else 1.0
    for _ in range(round(PATIENCE / period)):
        along = body.grab_direction(i)
        across = np.array((-along[1], along[0]))
        size = PUSH + (TUG - PUSH) * min(tugged / TUG_RISE, 1.0)
        lifted = float((rested - body.pose[:2]) @ g)
        if stage == "push":
            free = float((place - body.tip(i)) @ g) - room
            size += float(np.interp(free, (0.0, FREE), (0.0, HASTE)))
        # a joint that crosses its play, or is wrongly believed to, is seen in one of both; a hook that slides, in both
        slid = float(np.linalg.norm(_apart(climber) - apart, axis=1).min())
        faded = min(np.interp(lifted, LIFT, (1.0, 1 / 3)), np.interp(slid, SLIDING, (1.0, 1 / 3)))
        size *= part * faded
        strength, rate = (WIDE_DITHER, WIDE_RATE) if stage == "coax" else (DITHER, DITHER_RATE)
        phase += 2 * np.pi * rate * period
        side = part * strength * np.sin(phase)
        if stage == "push":
            side += CENTRING * float(across @ (place - body.tip(i)))
        else:
            tugged += period
        # what does not go into motion is borne by what the hook meets, and the other limbs carry that much less
        borne += (
            period / BORNE_TIME * (min(max(size - task.damping * float(body.tip_speed(i) @ along), 0.0), size) - borne)
        )
        task.tug = borne * along
        task.force = size * along + side * across
        climber.tick()
        # the play is crossed without a motor that turns, and the belief about it lags: both must have come to rest
        reached = np.array((body.felt_tip(i) @ g, body.tip(i) @ g))
        advanced = reached > marks + (ADVANCE if stage == "push" else CREEP)
        marks = np.where(advanced, reached, marks)
        still = 0.0 if advanced.any() else still + period
        ahead = float((place - body.tip(i)) @ g)
        # the belief about the play may be out for a while, the encoders know nothing of it: beyond by both is beyond
        if max(ahead, float((place - body.felt_tip(i)) @ g)) < -room:
            break
        if stage == "push" and still > STOPPED:
            stage, still = "coax" if ahead > SHORT else "tug", 0.0
        elif stage == "coax" and (still > STUCK or ahead < 0.5 * SHORT):
            stage, still = "tug", 0.0
        elif stage == "tug" and tugged > TUG_RISE and still > STILL:
            if faded > FIRM or anew == ANEW:
                seated = True
                break
            # a weak push lets a hook rest on its flare: from where the body is now, with all of it
            rested, apart, still, anew = body.pose[:2].copy(), _apart(climber), 0.0, anew + 1
    task.pressed, task.tug = False, np.zeros(2)
    return seated


def _apart(climber: Climber) -> Floats:
    """One holding tip less another by the encoders alone, and with the play counted, world frame, shape (2, 2) [m]."""
    body, i, j = climber.body, climber.holding()[0], climber.holding()[-1]
    return np.array((body.felt_tip(i) - body.felt_tip(j), body.tip(i) - body.tip(j)))

"""Motions: how each kind of action is carried out. Body moves on smooth ways, releases, and the grab of Bevly (1997), Fig. 4.14."""

from itertools import pairwise
from typing import Final

import numpy as np

from ...types import Floats
from .approach import Approach, free_distance
from .climber import Climber, Grabbed
from .parking import park, poses_between

BODY_SPEED: Final = 0.08
"""Of the body's aim, at most [m/s]."""
BODY_TURN: Final = 0.4
"""[rad/s]."""
JOINT_SPEED: Final = 1.6
"""Of a free limb's joints on their way [rad/s]."""
BLEND: Final = 0.3
"""Over which corners of a limb's way are rounded [s]."""
WIDE_STAND_OFF: Final = 0.042
"""Least distance from a hold at which a hook that opens along its link turns towards it: nearer, its flare knocks the hold [m]."""
NEAR: Final = 0.022
"""From here on, and the map's error farther off, the hook is pushed, not placed: nearer, its flare would meet the hold sideways [m]."""
PUSH: Final = 10.0
"""Gentle pull along the grab direction until the hook stops [N]."""
TUG: Final = 10.0
"""Pull on a hook that has stopped: a quarter of LIBRA's weight; more would lift the limb below off its hold [N]."""
LIFT: Final = (0.001, 0.003)
"""A push that lifts the body this far weakens, to a third at the second: it bears already, and other hooks would come off [m]."""
TUG_RISE: Final = 0.2
"""In which the tug grows to its full size [s]."""
DITHER: Final = 8.0
"""Pull across, to and fro, so that friction lets the hook slide in [N]."""
DITHER_RATE: Final = 5.0
"""[Hz]."""
CENTRING: Final = 150.0
"""Pull towards the believed hold across the hook [N/m]."""
ADVANCE: Final = 0.0015
"""A tip that advances less than this along the grab direction has stopped [m]."""
STOPPED: Final = 0.2
"""For that long, a period of the dither, before the tug begins [s]."""
STILL: Final = 0.3
"""For that long under the full tug before a hook counts as seated [s]."""
PATIENCE: Final = 5.0
"""For one push [s]."""
ASIDE: Final = (0.0, 0.8, -0.8, 1.4, -1.4, 0.0)
"""Across the hook, where each try aims, in errors of the map [-]."""
WEAKER: Final = 3.0
"""By how much the worst of the holding limbs may be worse off where the body makes room for a grab [N]."""
SLACK: Final = 0.006
"""Beyond the map's error, how far a seated hook may be from where it should be: play and backlash [m]."""


def move_body(climber: Climber, pose: Floats, *, speed: float = BODY_SPEED) -> None:
    """Bring the body to a pose (x, y, theta) along a straight smooth way; free limbs first go to where they meet no hold on it."""
    for i, task in enumerate(climber.body.tasks):
        if not task.hold:
            _park(climber, i, pose)
    body, period = climber.body, climber.plant.period
    start = body.aim.copy()
    change = pose - start
    seconds = 1.5 * max(float(np.hypot(change[0], change[1])) / speed, abs(float(change[2])) / (BODY_TURN * speed / BODY_SPEED), 0.2)
    count = max(1, round(seconds / period))
    for k in range(1, count + 1):
        u = k / count
        body.aim[:] = start + u * u * (3 - 2 * u) * change
        body.aim_speed[:] = 6 * u * (1 - u) / seconds * change
        climber.tick()
    body.aim_speed[:] = 0.0


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
    seconds = max(1.5 * along[-1] / JOINT_SPEED, 0.2)
    count, blend = round(seconds / period), max(2, round(BLEND / period))
    u = np.arange(1, count + 1) / count
    done = u * u * (3 - 2 * u) * along[-1]
    angles = np.stack([np.interp(done, along, way[:, j]) for j in range(2)], axis=1)
    # rounded corners: a turn on the spot throws the body about
    window = np.hanning(blend + 2)[1:-1]
    padded = np.concatenate((np.repeat(way[:1], blend, axis=0), angles, np.repeat(way[-1:], blend, axis=0)))
    smooth = np.stack([np.convolve(padded[:, j], window / window.sum(), "valid") for j in range(2)], axis=1)
    task.doing = "joints"
    for before, after in pairwise(smooth):
        task.angles, task.rates = after, (after - before) / period
        climber.tick()
    task.angles, task.rates = way[-1].copy(), np.zeros(2)


def stand_off_of(climber: Climber, i: int) -> float:
    """How far from a hold a limb's hook turns towards it [m]."""
    free = free_distance(climber.peg_radius, climber.map_error)
    return free if climber.robot.limbs[i].end.offset > 0.0 else max(WIDE_STAND_OFF, free)


def release(climber: Climber, i: int) -> None:
    """Take a limb off its hold, against its grab direction; the others carry."""
    climber.carry_with_all(but=i)
    task = climber.body.tasks[i]
    place = climber.body.tip(i) - stand_off_of(climber, i) * climber.body.grab_direction(i)
    move_tip(climber, i, place, 0.4)
    climber.learn_again()
    task.hold, task.doing, task.angles = 0, "joints", climber.body.q[i].copy()


def grab(climber: Climber, i: int, number: int, *, elbow: int = 0) -> Grabbed:
    """Bring a limb to a hold and hook on: off the old one, round to the new, push until it stops, tug; try again beside where it misses.

    Args:
        climber: The robot.
        i: Index of the limb.
        number: Of the hold.
        elbow: Side of the elbow to hold with: +1, -1, or 0 for the hook most on top.

    Raises:
        FallenError: If the robot falls.
    """
    body, task = climber.body, climber.body.tasks[i]
    climber.carry_with_all(but=i)
    if task.hold:
        release(climber, i)
    hold = climber.holds[number]
    wished = stand_off_of(climber, i)
    near = NEAR + climber.map_error
    found = _find(climber, i, hold, elbow, wished, near)
    if found is None:
        return Grabbed(False, 0, 0.0, 0.0)
    if found.shift.any():
        move_body(climber, body.aim + np.array((*found.shift, 0.0)))
        found = _find(climber, i, hold, elbow, wished, near) or found
    follow(climber, i, found.way)
    climber.wait(0.15)
    along = across = 0.0
    g = found.grab
    h = np.array((-g[1], g[0]))
    for tries, part in enumerate(ASIDE, 1):
        aside = part * climber.map_error
        move_tip(climber, i, hold - near * g + aside * h, 0.5)
        stopped = _push(climber, i, hold + aside * h, g)
        off = body.tip(i) - hold
        along, across = float(off @ g), float(off @ h)
        room = climber.map_error + SLACK
        if stopped and along > -room and abs(across) < room:
            climber.learn(number, i, [j for j, other in enumerate(body.tasks) if other.doing == "hold"])
            task.doing, task.hold, task.place = "cling", number, climber.holds[number].copy()
            climber.wait(0.1)
            return Grabbed(True, tries, along, across)
        move_tip(climber, i, hold - wished * g, 0.5)
    task.doing, task.angles = "joints", body.q[i].copy()
    return Grabbed(False, len(ASIDE), along, across)


def _find(climber: Climber, i: int, hold: Floats, elbow: int, wished: float, near: float) -> Approach | None:
    body = climber.body
    least = min(0.0, body.stands(body.settled)) - WEAKER
    climber.plant.pause()
    return climber.approaches.find(
        i, body.q[i] - body.play[i], body.settled, hold, climber.holds, elbow=elbow, stand_off=wished, near=near,
        stands=lambda pose: body.stands(pose) >= least,
    )  # fmt: skip


def _push(climber: Climber, i: int, place: Floats, g: Floats) -> bool:
    """Push a hook along its grab direction until it stops, then tug as hard as it will have to carry, until it no longer advances.

    Returns:
        Whether it came to rest under the tug, not farther in than a hold could be.
    """
    body, task, period = climber.body, climber.body.tasks[i], climber.plant.period
    # believed to press from the start: in free air the tip is then farther in than believed, never less far
    task.doing, task.pressed, task.tug = "pull", True, np.zeros(2)
    room = climber.map_error + SLACK
    still = tugged = 0.0
    tugging, seated, mark = False, False, -np.inf
    rested = body.pose[:2].copy()
    for k in range(round(PATIENCE / period)):
        along = body.grab_direction(i)
        across = np.array((-along[1], along[0]))
        size = PUSH + (TUG - PUSH) * min(tugged / TUG_RISE, 1.0)
        lifted = float((rested - body.pose[:2]) @ g)
        size *= np.interp(lifted, LIFT, (1.0, 1 / 3))
        side = DITHER * np.sin(2 * np.pi * DITHER_RATE * k * period)
        if tugging:
            tugged += period
            task.tug = size * along
        else:
            side += CENTRING * float(across @ (place - body.tip(i)))
        task.force = size * along + side * across
        climber.tick()
        reached = float(body.felt_tip(i) @ g)
        still += period
        if reached > mark + ADVANCE:
            mark, still = reached, 0.0
        if not tugging and still > STOPPED:
            tugging, still = True, 0.0
        if (body.tip(i) - place) @ g > room:
            break
        if tugged > TUG_RISE and still > STILL:
            seated = True
            break
    task.pressed, task.tug = False, np.zeros(2)
    return seated

"""Motions of a walker: settle, level, lower, lift, slide. Each is a loop of ticks that ends with the robot at rest.

A frame slides only while none of its feet is on the ground. Nothing else forbids it: six feet down do not block the actuators, they drag.
"""

import math
from collections.abc import Sequence
from typing import Final

import numpy as np

from ....types import Floats, Ints
from ..control.gait import (
    DELTA,
    SAMPLES,
    Y,
    eased_share,
    lengths_at,
    look_at_step,
    room_at,
    slide_places,
    slide_seconds,
)
from ..robot.plane_poses import placed, seen_from
from ..robot.robot import Legs
from .brake import OVER, Brake
from .falls import LIGHT
from .free_base_freedoms import ARRIVED, open_share
from .walker import LEGS, RefusedError, Walker, leg_name

ROOM: Final = 0.004
"""What is left of a leg's stroke at either end where there is a choice [m]."""
PATIENCE: Final = 60.0
"""For levelling, at most [s]."""
SETTLED: Final = 0.6
"""After a slide has sped up or slowed down, until the inclinometers have forgotten it [s]."""
LOOSE: Final = 0.5
"""A standing foot that feels less than this part of what counts as touching is lowered again before it has to carry [-]."""


def settle(walker: Walker, seconds: float | None = None) -> None:
    """Stand and level for a while [s]; None: as the settings say."""
    walker.wait(walker.settings.settling if seconds is None else seconds)


def level(walker: Walker) -> None:
    """Bring the plate level with all legs that stand, to where all of them have room, and wait until it is; at most a minute.

    Raises:
        RefusedError: If the legs' stroke does not allow it; the margin is what is missing.
        FallenError: If the robot falls.
    """
    walker.wanted[1:] = 0.0
    walker.height = heights_for(walker, walker.heights, walker.heights, np.zeros(LEGS))[1]
    check_stroke(walker, np.array((walker.height, 0.0, 0.0)), walker.stands)
    waited = 0.0
    while waited < PATIENCE:
        walker.tick()
        waited += walker.period
        unsure = walker.inclination.unsure
        arrived = walker.left < 1e-5 and walker.tilt() < walker.settings.level_within
        if arrived and unsure < 0.5 * walker.settings.level_within and waited > 1.0:
            return


def check_stroke(walker: Walker, posture: Floats, legs: Ints) -> None:
    """Refuse a posture that some of the legs, 1 in `legs`, are too short or too long for."""
    lengths = walker.targets(posture, walker.heights)
    spec = walker.robot.legs
    margins = np.where(legs > 0, np.minimum(lengths - spec.shortest, spec.longest - lengths), np.inf)
    worst = int(np.argmin(margins))
    if margins[worst] < -1e-9:
        raise RefusedError(
            f"{leg_name(worst)} would have to be {1e3 * lengths[worst]:.0f} mm long, "
            f"and can be {1e3 * spec.shortest:.0f} to {1e3 * spec.longest:.0f} mm",
            float(margins[worst]),
        )


def heights_for(walker: Walker, low: Floats, high: Floats, lifts: Floats) -> tuple[float, float, float]:
    """Heights of the plate, at the tilt that is kept, that leave the legs room: lowest, own and highest [m].

    None do where lowest is over highest; own is nominal over the middle of the ground, if it can be.

    Args:
        walker: The robot.
        low: Lowest places that each foot has to reach, shape (6,), world [m].
        high: Highest places that each has to stand on or clear, shape (6,) [m].
        lifts: By how much each foot has to clear them, shape (6,) [m].
    """
    (_, beta, gamma) = walker.wanted
    normal = math.cos(beta) * math.cos(gamma)
    base = np.array((0.0, beta, gamma))
    lowest, own, highest = room_of_heights(
        walker.robot.legs,
        longest=float(walker.targets(base, low).max()),
        shortest=float(walker.targets(base, high).min()),
        lifted=float(walker.targets(base, high + lifts).min()),
    )
    return normal * lowest, normal * own, normal * highest


def room_of_heights(legs: Legs, *, longest: float, shortest: float, lifted: float) -> tuple[float, float, float]:
    """By how much all legs may be longer: lowest, own, highest [m]; where they have no room, own is the middle of what is missing.

    Args:
        legs: Their stroke.
        longest: Length of the longest leg with the plate at height 0 [m].
        shortest: Likewise of the shortest that stands [m].
        lifted: Likewise of the shortest where feet are lifted [m].
    """
    least, most = legs.shortest + ROOM - lifted, legs.longest - ROOM - longest
    if least > most:
        return least, 0.5 * (least + most), most
    return least, min(most, max(least, legs.nominal - 0.5 * (longest + shortest))), most


def raise_plate(walker: Walker, by: float) -> None:
    """Have the plate higher by so much [m]; feet in the air stay at their height."""
    legs = walker.robot.legs
    walker.height += by
    walker.room.raised += by
    walker.free_aims[:] = np.clip(walker.free_aims + by, legs.shortest, legs.longest)


def find_ground(walker: Walker) -> list[int]:
    """Lower every foot that the ground does not carry until it does; before a robot lifts its first frame. Legs that find none."""
    return lower(walker, range(LEGS))


def lower(walker: Walker, legs: range) -> list[int]:
    """Lower feet until each feels the ground, and stop each there.

    Args:
        walker: The robot.
        legs: Indices of the legs; those that stand and feel the ground stay.

    Returns:
        Legs that found no ground: at the end of their stroke, or `deepest` below where it was expected.

    Raises:
        FallenError: If the robot falls.
    """
    settings, spec = walker.settings, walker.robot.legs
    for i in legs:
        if walker.stands[i] and walker.forces[i] < LOOSE * settings.touch:
            walker.leave(i)
    seeking = [i for i in legs if not walker.stands[i]]
    expected = {i: expected_height(walker, i) for i in seeking}
    for i in seeking:
        walker.free_aims[i], walker.free_speeds[i] = spec.longest, spec.speed
        walker.touched[i] = 0
    none: list[int] = []
    while seeking:
        walker.tick()
        for i in list(seeking):
            near = 0.0 < walker.soles[i, 2] - expected[i] < settings.near
            walker.free_speeds[i] = min(spec.speed, settings.near_speed) if near else spec.speed
            ended = walker.sensed[i] > spec.longest - 2.0 * spec.resolution
            if walker.touched[i] >= settings.touches:
                walker.land(i)
            elif ended or walker.soles[i, 2] < expected[i] - settings.deepest:
                walker.free_aims[i] = walker.lengths[i]
                none.append(i)
            else:
                continue
            seeking.remove(i)
    return none


def expected_height(walker: Walker, i: int) -> float:
    """Height at which a leg that does not stand should find the ground, by the plane through the others [m]."""
    if walker.settings.probe > 0.0 and walker.ground.known:
        return float(walker.ground.heights(walker.soles[i : i + 1, :2])[0])
    stands = walker.stands > 0
    if stands.sum() < 3:
        return float(walker.soles[i, 2])
    middle = walker.anchors[stands].mean(axis=0)
    return float(walker.heights[stands].mean() + walker.ground_slope() @ (walker.soles[i, :2] - middle))


def lift(walker: Walker, frame: int, *ends: Floats, by: float | None = None) -> None:
    """Lift a frame's feet off the ground: slowly while the others take its load, then until they clear what is expected on their way.

    The plate rises or sinks meanwhile to where the legs have room for that and for the landing.

    Args:
        walker: The robot.
        frame: The frame.
        ends: Poses that it will go to, seen from above, shape (3,) [m], [rad]; none: it stays over its place.
        by: By how much its feet clear the ground [m]; None: as the settings or the robot's file say.

    Raises:
        RefusedError: If the other frame's feet do not all stand, or would not carry the robot.
        FallenError: If the robot falls.
    """
    settings, robot = walker.settings, walker.robot
    lower(walker, walker.of_frame(1 - frame))  # those that hang loose
    others: Ints = np.zeros(LEGS, np.int32)
    others[walker.of_frame(1 - frame)] = walker.stands[walker.of_frame(1 - frame)]
    if others.sum() < 3:
        raise RefusedError("the feet of the frame that is to carry do not all stand")
    margin = walker.margin(others)
    if margin < settings.limits.balance:
        raise RefusedError(
            f"without the other frame the centre of mass would be {1e3 * margin:.0f} mm inside the feet that stand, "
            f"and {1e3 * settings.limits.balance:.0f} mm are asked for",
            margin - settings.limits.balance,
        )
    clear = by if by is not None else settings.lift if settings.lift is not None else robot.legs.lift
    mine, spec = list(walker.of_frame(frame)), robot.legs
    low, high, lifts = walker.heights.copy(), walker.heights.copy(), np.zeros(LEGS)
    if settings.probe > 0.0 and walker.ground.known:
        clear = 0.0
        low[mine], high[mine] = _reach_of_ground(walker, frame, ends)
    else:
        rises = np.stack([np.zeros(3), *(_rises(walker, frame, end) for end in ends)])
        low[mine] += rises.min(axis=0)
        high[mine] += rises.max(axis=0)
    lifts[mine] = clear
    lowest, own, highest = heights_for(walker, low, high, lifts)
    wish = 0.0 if walker.arm_task is None else walker.arm_task.raise_wished(walker)
    height = walker.room.hold(own, lowest, highest, wish)
    aims = np.clip(walker.targets(np.array((height, *walker.wanted[1:])), high + lifts), spec.shortest, spec.longest)
    for i in mine:
        walker.leave(i)
        walker.free_speeds[i] = settings.ease_speed
        walker.free_aims[i] = max(spec.shortest, walker.lengths[i] - settings.ease)
    _ease(walker, mine)
    for i in mine:
        walker.free_speeds[i] = spec.speed
        walker.free_aims[i] = aims[i]
    walker.height = height
    need = clear if settings.clear is None else min(clear, settings.clear)
    while walker.left > 1e-5 or np.abs(walker.lengths[mine] - aims[mine]).max() > 1e-6:
        walker.tick()
        if float((walker.soles[mine, 2] - high[mine]).min()) > need - 2.0 * spec.resolution:
            break


def _reach_of_ground(walker: Walker, frame: int, ends: Sequence[Floats]) -> tuple[Floats, Floats]:
    """How low a frame's feet may have to reach at the ends of its way, and how high they clear all that may lie on it, shape (3,) [m]."""
    ground, mine = walker.ground, list(walker.of_frame(frame))
    here = ground.heights(walker.soles[mine, :2])
    there = [ground.heights(_feet_at(walker, frame, end)) for end in ends] or [here]
    off = ground.rough + OVER
    return np.min(there, axis=0) - off, np.max([here, *there], axis=0) + off


def _feet_at(walker: Walker, frame: int, pose: Floats) -> Floats:
    """Feet of a frame at a pose, seen from above, shape (3, 2) [m]; level."""
    return placed(walker.robot.feet()[frame], pose)


def _ease(walker: Walker, legs: list[int]) -> None:
    """Wait until feet that are being lifted slowly feel no load, or are where they go."""
    free = 0
    while free < walker.settings.touches and np.abs(walker.lengths[legs] - walker.free_aims[legs]).max() > 1e-6:
        walker.tick()
        free = free + 1 if walker.forces[legs].max() < LIGHT else 0


def slide(walker: Walker, swing: int, end: Floats, *, lands: bool = True) -> None:
    """Bring the lifted frame to a pose in the world, straight, over the frame that stands.

    Inclinometers are not heard while it speeds up or slows down.

    Args:
        walker: The robot.
        swing: The lifted frame.
        end: Where it is to be, seen from above: x, y [m], heading [rad], shape (3,).
        lands: Whether it comes down there, so that its feet may already go down on the way.

    Raises:
        RefusedError: If a foot of the frame is on the ground, or the way is beyond the mechanism or the balance.
        FallenError: If the robot falls.
    """
    down = walker.on_ground(swing)
    if down:
        raise RefusedError(f"a frame slides only in the air: {leg_name(down[0])} is on the ground")
    if any(not walker.stands[i] for i in walker.of_frame(1 - swing)):
        raise RefusedError("the feet of the frame that is to carry do not all stand")
    settings, robot = walker.settings, walker.robot
    start, goal = walker.place.copy(), place_for(walker, swing, end)
    still, first, last = np.zeros(3), start, goal
    if swing == DELTA:
        first, last = seen_from(start, still), seen_from(goal, still)
    places = slide_places(still, first, last, swing, np.linspace(0.0, 1.0, 4 * SAMPLES))
    room = float(room_at(robot, places, settings.limits).min())
    if room < -settings.limits.reserve:
        raise RefusedError(f"the slide is beyond what the mechanism can by {-1e3 * room:.0f} mm", room)
    step = look_at_step(
        robot, walker.frames(), swing, 0.0, np.asarray(end, float), walker.arm, walker.payload, settings.limits
    )
    if walker.settings.level and step.balance < 0.0:
        raise RefusedError(f"the slide would tip the robot by {-1e3 * step.balance:.0f} mm", step.balance)
    seconds = slide_seconds(robot, places, settings.ramp)
    before = walker.inclination.frozen
    late = settings.ramp + SETTLED
    walker.inclination.learns = True
    time, rested, brake = 0.0, 0.0, Brake(walker, swing)
    while time < seconds:
        brake.see()
        time += brake.pace * walker.period
        walker.inclination.frozen = before or time < late or time > seconds - settings.ramp
        share = eased_share(time, seconds, settings.ramp)
        place = slide_places(still, first, last, swing, np.array([share]))
        walker.actuators[:] = lengths_at(robot, place)[0]
        if lands and settings.clear is not None:
            _approach(walker, swing, brake.free, end, seconds - time)
        if rested > 0.0 or abs(walker.height - walker.wanted[0]) < ARRIVED:  # what the lift began comes first
            rested += walker.period
        walker.room.open(open_share(rested, seconds - time))
        walker.tick()
    walker.room.open(0.0)
    walker.inclination.learns = False
    walker.inclination.frozen = True
    walker.wait(SETTLED)
    while walker.left > 1e-5:
        walker.tick()
    walker.inclination.frozen = before
    walker.inclination.doubt(settings.landing_doubt)


def _rises(walker: Walker, frame: int, end: Floats) -> Floats:
    """By how much the ground that is expected under a frame's feet rises on their way to a pose, shape (3,) [m].

    A frame slides in the plate's own plane, so what counts is how the ground rises against that.
    """
    feet = _feet_at(walker, frame, end)
    against = walker.ground_slope() + walker.matrix[:2, 2] / walker.matrix[2, 2]
    rises: Floats = (feet - walker.soles[list(walker.of_frame(frame)), :2]) @ against
    return rises


def _approach(walker: Walker, swing: int, legs: list[int], end: Floats, seconds: float) -> None:
    """Let lifted feet go down towards the ground that is expected where a slide ends, in time to be `clear` above it then.

    Args:
        walker: The robot.
        swing: The lifted frame.
        legs: Of it, those that may go down.
        end: Where it comes down, seen from above, shape (3,) [m], [rad].
        seconds: Until it is there [s].
    """
    settings, spec = walker.settings, walker.robot.legs
    assert settings.clear is not None
    mine = list(walker.of_frame(swing))
    heights = walker.heights.copy()
    heights[mine] = [expected_height(walker, i) for i in mine]
    heights[mine] += (
        np.maximum(0.0, _rises(walker, swing, end)) + settings.clear
    )  # over the highest ground from here on
    aims = np.clip(walker.targets(walker.wanted, heights), spec.shortest, spec.longest)
    for i in legs:
        if aims[i] - walker.lengths[i] >= spec.speed * (seconds - walker.period):
            walker.free_aims[i] = max(walker.free_aims[i], aims[i])


def place_for(walker: Walker, swing: int, end: Floats) -> Floats:
    """Place of the Y-frame in the Delta-frame that brings a frame to a pose seen from above while the other stays, shape (3,)."""
    flat = walker.matrix[:2, :2]
    frames = walker.frames()
    turn = math.remainder(end[2] - frames[swing, 2], math.tau)
    if swing == Y:
        there = np.linalg.solve(flat, np.asarray(end[:2]) - walker.pose[:2])
        return np.array((there[0], there[1], walker.place[2] + turn))
    # the plate seen from the Y-frame, in the plane that both share
    c, s = math.cos(walker.place[2]), math.sin(walker.place[2])
    there = np.linalg.solve(flat @ np.array(((c, -s), (s, c))), np.asarray(end[:2]) - frames[Y, :2])
    return seen_from(np.array((there[0], there[1], turn - walker.place[2])), np.zeros(3))

"""What is odd about a robot: limits that leave too little of it."""

import cmath
import math
from collections.abc import Iterator
from itertools import combinations
from typing import Final

import numpy as np

from ..robots.library import Robot
from ..robots.limbed import Limb, LimbedRobot
from ..robots.walker import WalkerRobot
from ..units import DEGREE, GRAVITY
from .finding import Finding

STRAIGHT: Final = 0.999
"""A limb that reaches this part of its length is called straight [-]."""
RING: Final = 0.75
"""A limb whose tip can't come nearer than this part of its reach serves a ring of places only [-]."""
NARROW: Final = 30 * DEGREE
"""A joint with less range is narrow [rad]."""
TWISTS: Final = np.linspace(-math.pi / 3, math.pi / 3, 241)
"""A walker's frames repeat after a third of a turn [rad]."""


def inspect_robot(robot: Robot) -> Finding:
    """Facts of a robot, and what is odd about it."""
    if isinstance(robot, LimbedRobot):
        odd = (*_odd_limbs(robot), *_odd_body(robot))
        return Finding(kind="robot", name=robot.name, title=robot.title, facts=_limbed_facts(robot), odd=odd)
    return Finding(
        kind="robot", name=robot.name, title=robot.title, facts=_walker_facts(robot), odd=tuple(_odd_frames(robot))
    )


def reach_of(limb: Limb) -> tuple[float, float]:
    """Least and largest distance of a limb's tip from its port that its elbow's limits leave [m]."""
    bends = [limb.elbow.lower, limb.elbow.upper]
    # the distance grows and falls with the angle between the links only, so its ends are at the limits, straight, or folded
    turns = (k * math.pi - limb.hook_beta for k in range(-4, 5))
    bends += [angle for angle in turns if limb.elbow.lower <= angle <= limb.elbow.upper]
    distances = [abs(limb.l1 + limb.second_link * cmath.exp(1j * angle)) for angle in bends]
    return min(distances), max(distances)


def _limbed_facts(robot: LimbedRobot) -> dict[str, str]:
    nearest, farthest = zip(*(reach_of(limb) for limb in robot.limbs), strict=True)
    torques = [robot.torque_limit_of(joint) for joint in robot.joints]
    made_up = sum(each.source == "made up" for each in robot.sources.values())
    return {
        "family": "limbed climber",
        "limbs": ", ".join(f"{limb.name} ({limb.end.kind})" for limb in robot.limbs),
        "weight": f"{robot.weight:.4g} N",
        "limbs reach": f"{min(nearest):.4g} to {max(farthest):.4g} m from their ports",
        "joint torque": _span(torques, "N m"),
        "numbers": f"{len(robot.sources)} with a source, {made_up} of them made up",
    }


def _span(values: list[float], unit: str) -> str:
    low, high = min(values), max(values)
    return f"{low:.4g} {unit}" if high - low < 1e-9 else f"{low:.4g} to {high:.4g} {unit}"


def _odd_limbs(robot: LimbedRobot) -> Iterator[str]:
    for limb in robot.limbs:
        least, most = reach_of(limb)
        if most < STRAIGHT * limb.length:
            yield (
                f"limb '{limb.name}' can't be straight: its elbow's limits, {limb.elbow.lower / DEGREE:.4g} to "
                f"{limb.elbow.upper / DEGREE:.4g} deg, leave it {most:.3g} m of {limb.length:.3g} m"
            )
        if least > RING * most:
            yield f"limb '{limb.name}' can't come near its port: it reaches {least:.3g} to {most:.3g} m only"
        for which, joint in (("shoulder", limb.shoulder), ("elbow", limb.elbow)):
            if joint.upper - joint.lower < NARROW:
                yield f"limb '{limb.name}': its {which} turns through {(joint.upper - joint.lower) / DEGREE:.3g} deg only"
            if joint.inertia == 0.0:
                yield (
                    f"limb '{limb.name}': its {which} has no inertia; control laws that weigh joints by it, such as scct, "
                    "need one"
                )
        if not limb.shoulder.lower <= 0.0 <= limb.shoulder.upper:
            yield f"limb '{limb.name}' can't point straight out of its port: its shoulder's limits leave 0 deg out"
        yield from _weak(robot, limb, most)
        yield from _short(robot, limb, most)


def _weak(robot: LimbedRobot, limb: Limb, reach: float) -> Iterator[str]:
    needed, limit = 0.5 * robot.weight * 0.5 * reach, robot.torque_limit_of(limb.shoulder)
    if needed > limit:
        yield (
            f"limb '{limb.name}' is weak: with half of the weight on it and its tip half of its reach to the side, its "
            f"shoulder needs {needed:.3g} N m; the limit is {limit:.3g} N m"
        )


def _short(robot: LimbedRobot, limb: Limb, reach: float) -> Iterator[str]:
    gaps = {
        other.name: math.hypot(other.port_x - limb.port_x, other.port_y - limb.port_y)
        for other in robot.limbs
        if other is not limb
    }
    nearest = min(gaps, key=gaps.__getitem__)
    if reach < gaps[nearest]:
        yield (
            f"limb '{limb.name}' is short: it reaches {reach:.3g} m, and the port of '{nearest}', the nearest, is "
            f"{gaps[nearest]:.3g} m away, so no hold passes from one limb to the other while the body stands"
        )


def _odd_body(robot: LimbedRobot) -> Iterator[str]:
    for a, b in combinations(robot.limbs, 2):
        if math.hypot(a.port_x - b.port_x, a.port_y - b.port_y) < 1e-6:
            yield f"limbs '{a.name}' and '{b.name}' have one port"
    masses = sum(sum(limb.link_masses) for limb in robot.limbs)
    share = masses * GRAVITY / robot.weight
    if share > 0.5:
        yield f"the links are {100 * share:.0f} % of the weight, but statics takes all of it at the body's origin"
    unstated = sorted(key for key, each in robot.sources.items() if each.source == "not stated")
    if unstated:
        yield f"{len(unstated)} numbers state no source, such as {unstated[0]}"


def _walker_facts(robot: WalkerRobot) -> dict[str, str]:
    mechanism, legs = robot.mechanism, robot.legs
    return {
        "family": "two-frame walker",
        "actuators": f"{mechanism.shortest:.4g} to {mechanism.longest:.4g} m",
        "legs": f"{legs.shortest:.4g} to {legs.longest:.4g} m",
        "feet": f"circles of {legs.radius_delta:.4g} and {legs.radius_y:.4g} m",
        "arm": "none" if robot.arm is None else f"{robot.arm.n_joints} joints",
    }


def _odd_frames(robot: WalkerRobot) -> Iterator[str]:
    delta, y = robot.attachments()
    c, s = np.cos(TWISTS), np.sin(TWISTS)
    turned = np.stack(
        (c[:, None] * y[:, 0] - s[:, None] * y[:, 1], s[:, None] * y[:, 0] + c[:, None] * y[:, 1]), axis=-1
    )
    lengths = np.linalg.norm(turned - delta, axis=-1)
    mechanism = robot.mechanism
    inside = ((lengths >= mechanism.shortest) & (lengths <= mechanism.longest)).all(axis=1)
    if not inside.any():
        low, high = float(lengths.min()), float(lengths.max())
        yield (
            f"the frames can't stand over each other at any angle: that takes actuators of {low:.3g} to {high:.3g} m, "
            f"and they have {mechanism.shortest:.3g} to {mechanism.longest:.3g} m"
        )

"""What is told of robots and worlds in space, and what is odd about them."""

import math
from collections.abc import Iterator, Set
from typing import Final

import numpy as np

from ...inspection.finding import FileKind, Finding, Inspection, nearest, span_words
from ...shown_units import SI, ShownUnits
from ...types import Floats
from ...units import DEGREE, GRAVITY
from .pictures.obstacles import distances
from .planning.surface import on_guide
from .planning.task import SpatialTask
from .robot.chains import Bools
from .robot.kinematics import Posed, link_frames
from .robot.robot import SpatialRobot
from .statics.stretch import stretched
from .world.guide import GRAIN
from .world.library import read_world, world_names
from .world.world import SCHEMA as WORLD_SCHEMA
from .world.world import World, build_world

NARROW: Final = 20.0 * DEGREE
"""A joint with less range is narrow [rad]."""
ENDLESS: Final = 4.0 * math.pi + 1e-6
"""A joint with more range, more than a whole turn either way, is odd [rad]."""
ALONE: Final = 3.0
"""A hold this many times farther from its nearest than holds usually are is alone [-]."""
INSIDE: Final = 0.002
"""A hold so deep in a solid, or with solid so far in front of it, is in the wrong place [m]."""
NAMED: Final = 5
"""So many things are named, the others counted."""


def _many(names: list[str]) -> str:
    return ", ".join(names[:NAMED]) + (f" and {len(names) - NAMED} more" if len(names) > NAMED else "")


def inspect_robot(robot: SpatialRobot, units: ShownUnits = SI) -> Finding:
    """Facts of a robot in space, and what is odd about it."""
    chains = robot.chains
    turning = chains.used & (chains.sliding == 0)
    lengths = np.array([stretched(chains, limb) for limb in range(len(chains.limb_names))])
    limbs = zip(chains.limb_names, robot.contacts, chains.n_joints, strict=True)
    facts = {
        "family": "robot in space",
        "limbs": ", ".join(f"{name} ({contact.kind}, {joints} joints)" for name, contact, joints in limbs),
        "mass": f"{chains.total_mass:.4g} kg, {chains.base_mass:.4g} kg of it the base's",
        "limbs reach": f"{span_words(lengths.tolist(), units.place)} from their first joints",
        "model": robot.spec.model,
    }
    if turning.any():
        facts["joint torque"] = span_words(chains.torque[turning].tolist(), units.torque)
    sliding = chains.used & (chains.sliding == 1)
    if sliding.any():
        facts["joint force"] = span_words(chains.torque[sliding].tolist(), units.force)
    return Finding(kind="robot", name=robot.name, title=robot.title, facts=facts, odd=tuple(_odd_robot(robot, units)))


def _odd_robot(robot: SpatialRobot, units: ShownUnits) -> Iterator[str]:
    chains = robot.chains
    weight, n_limbs = GRAVITY * chains.total_mass, len(chains.limb_names)
    for limb, (name, joints) in enumerate(zip(chains.limb_names, chains.joint_names, strict=True)):
        span = (chains.upper - chains.lower)[limb, : len(joints)]
        narrow = [joint for k, joint in enumerate(joints) if not chains.sliding[limb, k] and span[k] < NARROW]
        if narrow:
            yield f"limb '{name}': {_many(narrow)} turns through less than {NARROW / DEGREE:.0f} deg"
        endless = [joint for k, joint in enumerate(joints) if not chains.sliding[limb, k] and span[k] > ENDLESS]
        if endless:
            turns = float(span.max()) / math.tau
            yield f"limb '{name}': {_many(endless)} may turn {turns:.3g} times round; are limits in degrees where radians belong?"
        at_end = [
            joint
            for k, joint in enumerate(joints)
            if min(chains.nominal[limb, k] - chains.lower[limb, k], chains.upper[limb, k] - chains.nominal[limb, k])
            < 1e-6
        ]
        if at_end:
            yield f"limb '{name}': its nominal posture has {_many(at_end)} at an end of the range, where searches have no room"
        needed = weight / n_limbs * 0.5 * stretched(chains, limb)
        strongest = float(
            np.where(chains.sliding[limb, : len(joints)] == 1, math.inf, chains.torque[limb, : len(joints)]).max()
        )
        if needed > strongest:
            (unit, size, _) = units.torque
            yield (
                f"limb '{name}' is weak on Earth: with its share of the weight "
                f"half of its reach to the side it needs {needed / size:.3g} {unit}; "
                f"its strongest motor may give {strongest / size:.3g} {unit}"
            )
    light = [joint.name for limb in robot.choice.limbs for joint in limb.joints if not joint.rotor]
    if light:
        yield f"{_many(light)}: no inertia of rotors ('rotors' of a limb, or armature): gears with play rattle under noise"
    points = [contact.components == 3 for contact in robot.contacts]
    if all(points) and n_limbs <= 3:
        yield f"{n_limbs} limbs with point contacts: while one swings, {n_limbs - 1} are left, which can't be in balance but by accident"
    own = float(chains.mass.sum()) / chains.total_mass
    if own > 0.8:
        yield f"the limbs are {100 * own:.0f} % of the mass; is the base's stated?"
    if robot.contacts and not any(contact.friction > 0.0 for contact in robot.contacts):
        yield "no end effector has friction"


def inspect_world(world: World, units: ShownUnits = SI) -> Finding:
    """Facts of a world in space, and what is odd about it."""
    size = np.ptp(world.places, axis=0) if world.holds else np.zeros(3)
    kinds = [solid.kind for solid in world.solids]
    unit, metre, _ = units.place
    gravity = float(np.linalg.norm(world.gravity))
    facts = {
        "holds": str(len(world.holds)),
        "size": " x ".join(f"{side / metre:.4g}" for side in size) + f" {unit}",
        "guide": f"{units.length(GRAIN * (len(world.frames) - 1))} long",
        "solids": ", ".join(f"{kinds.count(kind)} {kind}" for kind in dict.fromkeys(kinds)) or "none",
        "gravity": f"{gravity:.4g} m/s^2" + ("" if world.gravity[2] <= -0.999 * gravity else " tilted"),
    }
    if world.fields:
        grains = ", ".join(units.length(field.grain) for field in world.fields)
        facts["terrain"] = f"{len(world.fields)} solid, distances from it every {grains}"
    if len(world.holds) > 1:
        facts["nearest two"] = units.length(float(nearest(world.places).min()))
    return Finding(kind="world", name=world.name, title=world.title, facts=facts, odd=tuple(_odd_world(world, units)))


def _holds(which: Bools) -> str:
    """In words; holds are numbered from 1."""
    numbers = [str(index + 1) for index in np.flatnonzero(which)]
    return f"hold {numbers[0]}" if len(numbers) == 1 else f"{len(numbers)} holds ({_many(numbers)})"


def _odd_world(world: World, units: ShownUnits) -> Iterator[str]:
    if not world.holds:
        yield "no holds: no robot can stand here"
        return
    if len(world.holds) > 2:
        away = nearest(world.places)
        usual = float(np.median(away))
        alone = away > ALONE * usual
        if alone.any():
            yield (
                f"{_holds(alone)} far from all others, up to {units.length(float(away.max()))} where holds usually are "
                f"{units.length(usual)} apart; is a unit or a decimal point wrong?"
            )
    records = world.solid_records
    if len(records):

        def gaps(places: Floats) -> Floats:
            nearest: Floats = np.min([distances(record, places) for record in records], axis=0)
            return nearest

        deep, ahead = gaps(world.places), gaps(world.places + 2.0 * INSIDE * world.normals)
        inside, inward = deep < -INSIDE, (deep >= -INSIDE) & (ahead < -INSIDE)
        if inside.any():
            yield f"{_holds(inside)} inside a solid, where links of a limb that takes it are, too"
        if inward.any():
            yield f"{_holds(inward)} with a normal that points into a solid; it must point out of the surface"
        if (gaps(world.frames[:, :3] + INSIDE * world.frames[:, 9:]) < -2.0 * INSIDE).any():
            yield "the guide runs through a solid"


def odd_task(task: SpatialTask, hard: Set[str]) -> Iterator[str]:
    """What is odd about a task in space, beside what is odd about any."""
    chains = task.robot.chains
    for name in ("equilibrium", "torque", "reach"):
        if name not in hard:
            yield f"'{name}' only reports, though without it a plan says nothing of what the robot can do"
    tips = link_frames(chains, Posed(np.zeros(3), np.eye(3), chains.nominal)).tips
    below = -float(tips[:, 2].mean())
    most = float(np.linalg.norm(chains.offset, axis=2).sum(axis=1).max())
    if task.start.height > most:
        yield f"the body starts {100 * task.start.height:.3g} cm over the guide, and no limb is longer than {100 * most:.3g} cm"
    elif below > 0.0 and not 0.3 * below < task.start.height < 2.5 * below:
        told = f"in the nominal posture it is {100 * below:.3g} cm over its tips"
        yield f"the body starts {100 * task.start.height:.3g} cm over the guide; {told}"
    on = on_guide(task.world.frames, task.world.places)
    goal = task.goals[-1]
    along_min, along_max, across_min, across_max = goal.box
    gap = np.hypot(
        np.maximum(0.0, np.maximum(along_min - on[:, 0], on[:, 0] - along_max)),
        np.maximum(0.0, np.maximum(across_min - on[:, 1], on[:, 1] - across_max)),
    )
    nearest = float(gap.min(initial=math.inf))
    if nearest > most:
        told = f"the nearest is {100 * nearest:.3g} cm away, the longest limb {100 * most:.3g} cm"
        yield f"no hold is within a limb's reach of the goal: {told}"


INSPECTION: Final = Inspection(
    robot=inspect_robot,
    kinds={"world": FileKind(WORLD_SCHEMA, world_names, lambda name: build_world(read_world(name)), inspect_world)},
    odd_task=odd_task,
)

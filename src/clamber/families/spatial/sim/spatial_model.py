"""A robot in space on its holds as a MuJoCo model: base and limbs from its own model, geared joints with play, tips, holds and solids."""

import math
from dataclasses import dataclass
from typing import Any, Final

import numpy as np

from ....sim.limb_model import (
    FRICTION_SOLIMP,
    FRICTION_SOLREF,
    PLAY_DAMPING,
    PLAY_INERTIA,
    SMALL_MASS,
    STOP_SOLIMP,
    STOP_SOLREF,
)
from ....types import Floats
from ..robot.contacts import Strength
from ..robot.parts import Part, parts_of
from ..robot.robot import SpatialRobot
from ..statics.records import BESIDE, CLEAR, FIXED
from ..world.solids import BAR, BOX, CYLINDER, PLANE, TUBE, frame_about
from ..world.world import World
from .spatial_flaws import Deviations, SpatialFlaws

LINKS: Final = 1 << 16
"""Bit of what links touch, solids ..."""
ON_SOLIDS: Final = 8
"""... each tip has one for its patch, by its limb's number, and one that is so much higher for solids ..."""
ON_LIMBS: Final = 17
"""... each limb's links have one for those of other limbs, by its number and so much higher, and one for the base behind them all."""
TIP: Final = 0.0001
"""Radius of the ball that a tip touches with [m]; what it touches lies so much lower, so that the tip itself is where the plan has it.

A limb that leans rolls it: a ball of 2 mm took a quadruped 26 mm farther over 5 m than legs with points for feet would.
"""
THICK: Final = 0.01
"""Half the thickness of a hold's patch [m]."""
THIN: Final = 1e-4
"""Shapes that are thinner touch nothing [m]."""
SIDES: Final = 48
"""Planes that stand for the wall of a tube: a thousandth of its radius off at most."""
CONTACT_SOLREF: Final = (0.004, 1.0)
CONTACT_SOLIMP: Final = (0.95, 0.99, 0.0005, 0.5, 2.0)
IMPRATIO: Final = 10.0
NOSLIP: Final = 10
"""Iterations that take the creep out of friction; only feet need them."""


@dataclass(frozen=True, slots=True)
class TrueWorld:
    """What the robot is really in."""

    world: World
    deviations: Deviations


def spatial_spec(robot: SpatialRobot, true: TrueWorld, flaws: SpatialFlaws) -> Any:
    """An `MjSpec` of the robot in its world.

    The base floats ("floating"); joints, links and motors are called as the robot's joints, their play "NAME play". The body at a limb's
    tip is "LIMB tip", as its site and its force sensors are, the constraint that attaches it "LIMB held", the hold that it may touch
    "LIMB patch". Motors are plain torques: their limits are the plant's.
    """
    import mujoco

    spec = mujoco.MjSpec()
    spec.compiler.degree = False
    spec.compiler.autolimits = True
    option = spec.option
    option.timestep = 1.0 / flaws.physics_rate
    option.integrator = mujoco.mjtIntegrator.mjINT_IMPLICITFAST
    option.cone = mujoco.mjtCone.mjCONE_ELLIPTIC
    option.impratio = IMPRATIO
    strengths = robot.strengths
    option.noslip_iterations = 0 if all(strength.capture for strength in strengths) else NOSLIP
    option.gravity = true.world.gravity
    option.disableflags |= mujoco.mjtDisableBit.mjDSBL_AUTORESET
    tips = ((1 << len(strengths)) - 1) << ON_SOLIDS
    for record in true.world.solid_records:  # once for links and once, a tip's radius lower, for tips
        _add_solid(mujoco, spec, record, 0.0, LINKS)
        _add_solid(mujoco, spec, record, TIP, tips)
    _add_robot(mujoco, spec, robot, strengths, true.deviations, flaws)
    return spec


def play_name(joint: str) -> str:
    """Of the joint behind a gear."""
    return f"{joint} play"


def tip_name(limb: str) -> str:
    """Of the body, site and sensors at a limb's tip."""
    return f"{limb} tip"


def held_name(limb: str) -> str:
    """Of the constraint that attaches a limb."""
    return f"{limb} held"


def patch_name(limb: str) -> str:
    """Of the body and geom that a limb's tip stands on."""
    return f"{limb} patch"


def _add_robot(
    mujoco: Any,
    spec: Any,
    robot: SpatialRobot,
    strengths: tuple[Strength, ...],
    deviations: Deviations,
    flaws: SpatialFlaws,
) -> None:
    chains = robot.chains
    parts = parts_of(robot)
    base = spec.worldbody.add_body(name="base")
    base.add_freejoint(name="floating")
    _fill(base, parts.base, float(deviations.masses[0]), deviations.payload)
    on_base, limbs = 1 << ON_LIMBS + len(parts.links), ((1 << len(parts.links)) - 1) << ON_LIMBS
    _add_shapes(mujoco, spec, base, parts.base, "base", None, (LINKS, on_base))
    number = 0
    for limb, (name, links) in enumerate(zip(chains.limb_names, parts.links, strict=True)):
        parent = base
        n = len(links)
        for k, part in enumerate(links):
            number += 1
            joint = chains.joint_names[limb][k]
            parent = parent.add_body(
                name=joint, pos=chains.offset[limb, k], quat=quaternion(mujoco, chains.rotation[limb, k])
            )
            _fill(parent, part, float(deviations.masses[number]))
            _add_joint(mujoco, spec, parent, robot, (limb, k), flaws)
            tip = chains.offset[limb, n] if k == n - 1 else None
            mine = 1 << ON_LIMBS + limb
            touching = (LINKS, 0) if k < BESIDE else (LINKS | mine | (on_base if k >= FIXED else 0), limbs & ~mine)
            _add_shapes(mujoco, spec, parent, part, joint, tip, touching)
        at = quaternion(mujoco, chains.rotation[limb, n])
        hand = parent.add_body(name=tip_name(name), pos=chains.offset[limb, n], quat=at)
        _add_tip(mujoco, spec, hand, name, strengths[limb], 1 << limb)
        _add_patch(mujoco, spec, name, 1 << limb)


def _fill(body: Any, part: Part, factor: float, payload: float = 0.0) -> None:
    """Give a body its inertia."""
    body.explicitinertial = True
    body.mass = max(factor * part.mass + payload, SMALL_MASS)
    body.ipos = part.centre
    inertia = factor * part.inertia + SMALL_MASS * np.eye(3)
    body.fullinertia = [inertia[i, j] for i, j in ((0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2))]


def _add_joint(
    mujoco: Any, spec: Any, body: Any, robot: SpatialRobot, at: tuple[int, int], flaws: SpatialFlaws
) -> None:
    """A geared joint about its frame's z, its motor, and its play."""
    chains, (limb, k) = robot.chains, at
    name, sliding = chains.joint_names[limb][k], bool(chains.sliding[at])
    kind = mujoco.mjtJoint.mjJNT_SLIDE if sliding else mujoco.mjtJoint.mjJNT_HINGE
    joint = body.add_joint(name=name, type=kind, axis=(0, 0, 1))
    of_model = robot.choice.limbs[limb].joints[k]
    joint.armature, joint.damping[0] = of_model.rotor, of_model.damping
    joint.frictionloss = flaws.friction * of_model.friction
    joint.solref_friction, joint.solimp_friction = FRICTION_SOLREF, FRICTION_SOLIMP
    if of_model.limits is not None:
        _stop(joint, *of_model.limits)
    motor = spec.add_actuator(name=name, trntype=mujoco.mjtTrn.mjTRN_JOINT, target=name)
    motor.set_to_motor()
    if flaws.backlash > 0.0 and not sliding:
        play = body.add_joint(name=play_name(name), type=kind, axis=(0, 0, 1))
        play.armature, play.damping[0] = PLAY_INERTIA, PLAY_DAMPING
        _stop(play, -flaws.backlash / 2, flaws.backlash / 2)


def _stop(joint: Any, lower: float, upper: float) -> None:
    joint.limited, joint.range = True, (lower, upper)
    joint.solref_limit = STOP_SOLREF
    joint.solimp_limit = STOP_SOLIMP


def _add_shapes(
    mujoco: Any, spec: Any, body: Any, part: Part, name: str, tip: Floats | None, touching: tuple[int, int]
) -> None:
    """Colliders of a part, less what is about its tip, with the bits of what touches and of what is touched."""
    bits = {"contype": touching[0], "conaffinity": touching[1], "mass": 0.0} | _contact(0.5)
    for number, (whole, radius) in enumerate(part.shapes):
        points = whole if tip is None else _away(whole, tip, CLEAR * max(radius, THIN))
        if len(points) == 1:
            body.add_geom(type=mujoco.mjtGeom.mjGEOM_SPHERE, pos=points[0], size=(radius, 0, 0), **bits)
        elif len(points) == 2:
            ends = points.ravel()
            body.add_geom(type=mujoco.mjtGeom.mjGEOM_CAPSULE, fromto=ends, size=(radius, 0, 0), **bits)
        elif len(points) and np.linalg.matrix_rank(points - points.mean(axis=0), tol=THIN) == 3:
            mesh = spec.add_mesh(name=f"{name} {number}")
            mesh.uservert = points.ravel()
            mesh.inertia = mujoco.mjtMeshInertia.mjMESH_INERTIA_CONVEX
            body.add_geom(type=mujoco.mjtGeom.mjGEOM_MESH, meshname=mesh.name, **bits)


def _away(points: Floats, tip: Floats, distance: float) -> Floats:
    """A shape's points where it keeps away from a tip: a capsule cut short, or as it is; none where nothing is left of it."""
    if len(points) == 2:
        near, far = sorted(points, key=lambda point: float(np.linalg.norm(point - tip)))
        length, short = float(np.linalg.norm(far - near)), distance - float(np.linalg.norm(near - tip))
        if short <= 0.0:
            return points
        if short >= length:
            return np.zeros((0, 3))
        return np.stack((near + short / length * (far - near), far))
    return points if float(np.linalg.norm(points - tip, axis=1).min()) > distance else np.zeros((0, 3))


def _add_tip(mujoco: Any, spec: Any, hand: Any, limb: str, strength: Strength, bit: int) -> None:
    """What touches, feels and attaches at a limb's end; a pad pushes with its corners."""
    name = tip_name(limb)
    hand.explicitinertial, hand.ipos = True, np.zeros(3)
    hand.add_site(name=name)
    for kind in (mujoco.mjtSensor.mjSENS_FORCE, mujoco.mjtSensor.mjSENS_TORQUE):
        spec.add_sensor(type=kind, objtype=mujoco.mjtObj.mjOBJ_SITE, objname=name)
    touches = bit | bit << ON_SOLIDS
    bits = {"contype": touches, "conaffinity": 0, "mass": 0.0, "priority": 1} | _contact(strength.friction)
    a, b = strength.halves if strength.moments else (0.0, 0.0)
    corners = [(a, b), (a, -b), (-a, b), (-a, -b)] if a or b else [(0.0, 0.0)]
    for x, y in corners:
        hand.add_geom(type=mujoco.mjtGeom.mjGEOM_SPHERE, pos=(x, y, 0.0), size=(TIP, 0, 0), **bits)
    if strength.capture:
        kind = mujoco.mjtEq.mjEQ_WELD if strength.moments else mujoco.mjtEq.mjEQ_CONNECT
        held = spec.add_equality(name=held_name(limb), type=kind, objtype=mujoco.mjtObj.mjOBJ_BODY)
        held.name1, held.name2, held.active = name, "world", False
        held.solref, held.solimp = HELD_SOLREF, HELD_SOLIMP


HELD_SOLREF: Final = (0.004, 1.0)
HELD_SOLIMP: Final = (0.98, 0.995, 0.0005, 0.5, 2.0)


def _add_patch(mujoco: Any, spec: Any, limb: str, bit: int) -> None:
    """What a limb's tip stands on: the patch of the hold that is nearest, which the plant puts there; others could not touch."""
    body = spec.worldbody.add_body(name=patch_name(limb), mocap=True)
    kind = mujoco.mjtGeom.mjGEOM_CYLINDER
    bits = {"contype": 0, "conaffinity": bit, "priority": 2}
    body.add_geom(name=patch_name(limb), type=kind, size=(THICK, THICK, 0.0), **bits, **_contact(0.5))


def _add_solid(mujoco: Any, spec: Any, record: np.void, lower: float, touched: int) -> None:
    """A solid whose surface lies lower than it is by some length."""
    bits = {"contype": 0, "conaffinity": touched} | _contact(0.5)
    axes, kind = record["axes"].T, int(record["kind"])
    at, turn = record["centre"], quaternion(mujoco, axes)
    size = record["size"] - lower if kind != BAR else record["size"] - (lower, 0.0, 0.0)
    geom = mujoco.mjtGeom
    if kind == PLANE:
        spec.worldbody.add_geom(type=geom.mjGEOM_PLANE, size=(0, 0, 1), pos=at - lower * axes[:, 2], quat=turn, **bits)
    elif kind == TUBE:
        angles = math.tau * np.arange(SIDES) / SIDES
        for angle in angles:
            out = math.cos(angle) * axes[:, 0] + math.sin(angle) * axes[:, 1]
            wall = at + (float(record["size"][0]) + lower) * out
            facing = quaternion(mujoco, frame_about(-out).T)
            spec.worldbody.add_geom(type=geom.mjGEOM_PLANE, size=(0, 0, 1), pos=wall, quat=facing, **bits)
    else:
        shape = {BOX: geom.mjGEOM_BOX, CYLINDER: geom.mjGEOM_CYLINDER, BAR: geom.mjGEOM_CAPSULE}[kind]
        spec.worldbody.add_geom(type=shape, size=size, pos=at, quat=turn, **bits)


def _contact(friction: float) -> dict[str, Any]:
    return {
        "solref": CONTACT_SOLREF,
        "solimp": CONTACT_SOLIMP,
        "condim": 3,
        "friction": (max(friction, 1e-5), 0.0, 0.0),
    }


def quaternion(mujoco: Any, turn: Floats) -> Floats:
    """The unit quaternion w, x, y, z of a rotation, shape (4,)."""
    out = np.zeros(4)
    mujoco.mju_mat2Quat(out, np.ascontiguousarray(turn).ravel())
    return out

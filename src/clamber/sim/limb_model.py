"""A limb as a MuJoCo model, built from its chain: geared joints with rotor and friction, play behind them, a tip, perhaps a wall."""

from typing import Any, Final

import numpy as np

from ..control.chain import Chain
from ..types import Floats
from .limb_flaws import LimbFlaws, PlantError, Wall

FRICTION_SOLREF: Final = (0.004, 1.0)
"""Time constant and damping ratio of Coulomb friction: with MuJoCo's default a loaded joint creeps."""
FRICTION_SOLIMP: Final = (0.95, 0.99, 0.001, 0.5, 2.0)
PLAY_INERTIA: Final = 1e-4
"""Of the play joint, so that it has a mass of its own [kg m^2]: a thousandth of a link's."""
STOP_SOLREF: Final = (0.002, 1.0)
"""Of the play's ends and of the joints' stops: as stiff as two physics steps allow."""
STOP_SOLIMP: Final = (0.95, 0.99, 0.0005, 0.5, 2.0)
TIP_RADIUS: Final = 0.005
"""Of the ball that touches a wall [m]."""
SMALL_MASS: Final = 1e-6
"""Where a link has no mass: MuJoCo asks for one [kg]."""


def limb_spec(chain: Chain, flaws: LimbFlaws) -> Any:
    """An `MjSpec` of the chain with the flaws that are mechanical. Joints are named as the chain's, their play "NAME play".

    The first joint is mounted on the world; the tip is the site "tip". Motors are plain torques: their limits are the plant's.

    Raises:
        PlantError: If the limb is to be upright but its chain has no gravity, whose direction only the robot's file knows.
    """
    import mujoco

    if flaws.upright and not np.any(chain.root["gravity"]):
        raise PlantError("upright", True, "needs a chain under gravity, made with upright=True")
    carried = chain.with_payload(flaws.payload)
    spec = mujoco.MjSpec()
    spec.compiler.degree = False  # else MuJoCo reads our ranges, the play's too, as degrees
    spec.option.timestep = 1.0 / flaws.physics_rate
    spec.option.integrator = mujoco.mjtIntegrator.mjINT_IMPLICITFAST
    spec.option.cone = mujoco.mjtCone.mjCONE_ELLIPTIC
    spec.option.impratio = 10.0
    spec.option.gravity = chain.root["gravity"][0]
    parent = spec.worldbody
    for name, record in zip(chain.joint_names, carried.joints, strict=True):
        parent = _add_link(mujoco, spec, parent, name, record, flaws)
    root = chain.root[0]
    parent.add_site(name="tip", pos=root["tip"], quat=_quaternion(mujoco, root["tip_turn"]))
    if flaws.wall is not None:
        _add_wall(mujoco, spec, parent, root["tip"], flaws.wall)
    return spec


def _add_link(mujoco: Any, spec: Any, parent: Any, name: str, record: Any, flaws: LimbFlaws) -> Any:
    body = parent.add_body(name=name, pos=record["place"], quat=_quaternion(mujoco, record["turn"]))
    body.explicitinertial = True
    body.mass = max(float(record["mass"]), SMALL_MASS)
    body.ipos = record["centre"]
    inertia = record["inertia"] + SMALL_MASS * np.eye(3)
    body.fullinertia = [inertia[i, j] for i, j in ((0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2))]
    kind = mujoco.mjtJoint.mjJNT_SLIDE if record["sliding"] else mujoco.mjtJoint.mjJNT_HINGE
    joint = body.add_joint(name=name, type=kind, axis=record["axis"])
    joint.armature = record["rotor"]
    joint.damping[0] = record["damping"] * flaws.damping
    joint.frictionloss = record["friction"] * flaws.friction
    joint.solref_friction = FRICTION_SOLREF
    joint.solimp_friction = FRICTION_SOLIMP
    if flaws.joint_limits:
        _stop(joint, float(record["lower"]), float(record["upper"]))
    motor = spec.add_actuator(name=name, trntype=mujoco.mjtTrn.mjTRN_JOINT, target=name)
    motor.set_to_motor()
    if flaws.backlash > 0.0:
        play = body.add_joint(name=f"{name} play", type=kind, axis=record["axis"])
        play.armature = PLAY_INERTIA
        _stop(play, -flaws.backlash / 2, flaws.backlash / 2)
    return body


def _stop(joint: Any, lower: float, upper: float) -> None:
    joint.limited = True
    joint.range = (lower, upper)
    joint.solref_limit = STOP_SOLREF
    joint.solimp_limit = STOP_SOLIMP


def _add_wall(mujoco: Any, spec: Any, tip_body: Any, tip: Floats, wall: Wall) -> None:
    """A plate on a spring along the wall's normal, and a ball at the tip: the spring, not the contact, is the wall's stiffness."""
    normal = np.array((np.cos(wall.angle), np.sin(wall.angle), 0.0))
    thick = 0.01
    centre = np.array((wall.x, wall.y, 0.0)) + (thick + TIP_RADIUS) * normal
    half = wall.angle / 2
    plate = spec.worldbody.add_body(name="wall", pos=centre, quat=(np.cos(half), 0.0, 0.0, np.sin(half)))
    plate.explicitinertial = True
    plate.mass, plate.inertia = 0.05, (1e-4, 1e-4, 1e-4)
    spring = plate.add_joint(name="wall", type=mujoco.mjtJoint.mjJNT_SLIDE, axis=(1.0, 0.0, 0.0))
    spring.stiffness[0], spring.damping[0] = wall.stiffness, wall.damping
    contact = {"solref": (0.002, 1.0), "solimp": (0.95, 0.99, 0.0005, 0.5, 2.0), "condim": 3}
    plate.add_geom(
        name="wall", type=mujoco.mjtGeom.mjGEOM_BOX, size=(thick, 1.0, 0.1), friction=(wall.friction, 0, 0), **contact
    )
    tip_body.add_geom(
        name="tip",
        type=mujoco.mjtGeom.mjGEOM_SPHERE,
        size=(TIP_RADIUS, 0, 0),
        pos=tip,
        friction=(wall.friction, 0, 0),
        **contact,
    )


def _quaternion(mujoco: Any, turn: Floats) -> Floats:
    out = np.zeros(4)
    mujoco.mju_mat2Quat(out, np.ascontiguousarray(turn).ravel())
    return out

"""A limb as a MuJoCo model from its chain: geared joints with rotor and friction, play behind them, a tip; wall and sensors."""

from typing import Any, Final

import numpy as np

from ..control.chain import Chain
from ..types import Floats
from .force_sensing import add_sensor, has_hand
from .limb_flaws import LimbFlaws, Wall
from .plant_rules import PlantError

TIP_RADIUS: Final = 0.005
"""Of the ball that touches the wall [m]."""
HALF_THICK: Final = 0.01
"""Half the plate's thickness [m]."""
LEAST_MASS: Final = 0.05
"""Of the plate [kg]."""
FASTEST: Final = 0.5
"""Most that the plate's own oscillation may turn in a physics step [rad]: a stiffer wall gets a heavier plate."""
CONTACT: Final = {"solref": (0.002, 1.0), "solimp": (0.999, 0.9999, 0.0005, 0.5, 2.0), "condim": 3}
"""So hard that the spring, not the contact, is the wall's stiffness."""


def plate_mass(wall: Wall, timestep: float) -> float:
    """Mass of the plate [kg]: small, and so large that its oscillation on the spring is resolved by steps of `timestep` [s]."""
    return max(LEAST_MASS, wall.stiffness * (timestep / FASTEST) ** 2)


def add_wall(mujoco: Any, spec: Any, hand: Any, wall: Wall, **bits: int) -> None:
    """Put the wall into the world and the ball on `hand`, a body whose origin is the tip.

    The ball's front touches the plate when the tip is on the untouched surface, so places of the tip and of the surface are the same.
    `bits`: what may touch what, as `add_geom` takes it.
    """
    normal = np.array((np.cos(wall.angle), np.sin(wall.angle), 0.0))
    half = wall.angle / 2
    plate = spec.worldbody.add_body(
        name="wall",
        pos=np.array((wall.x, wall.y, 0.0)) + (HALF_THICK + TIP_RADIUS) * normal,
        quat=(np.cos(half), 0.0, 0.0, np.sin(half)),
    )
    plate.explicitinertial = True
    plate.mass, plate.inertia = plate_mass(wall, spec.option.timestep), (1e-4, 1e-4, 1e-4)
    spring = plate.add_joint(name="wall", type=mujoco.mjtJoint.mjJNT_SLIDE, axis=(1.0, 0.0, 0.0))
    spring.stiffness[0], spring.damping[0] = wall.stiffness, wall.damping
    friction = (wall.friction, 0.0, 0.0)
    plate.add_geom(
        name="wall", type=mujoco.mjtGeom.mjGEOM_BOX, size=(HALF_THICK, 1.0, 0.1), friction=friction, **bits, **CONTACT
    )
    hand.add_geom(
        name="tip",
        type=mujoco.mjtGeom.mjGEOM_SPHERE,
        size=(TIP_RADIUS, 0, 0),
        mass=0.0,
        friction=friction,
        **bits,
        **CONTACT,
    )


FRICTION_SOLREF: Final = (0.004, 1.0)
"""Time constant and damping ratio of Coulomb friction [s], [-]: it is viscous below a speed of friction * 2 ms / inertia, 3 mrad/s."""
FRICTION_SOLIMP: Final = (0.9999, 0.9999, 0.001, 0.5, 2.0)
"""A joint loaded to its friction creeps by (1 - 0.9999) of that speed, 0.3 urad/s, and a force on a wall fades by as little; with an
impedance of 0.9, the default, by 340."""
PLAY_INERTIA: Final = 1e-4
"""Of the play joint, so that it has a mass of its own [kg m^2]: a thousandth of a link's."""
PLAY_DAMPING: Final = 0.005
"""Of the play [N m s/rad], our choice: grease and bearings, a hundredth of a joint's own. Without it a link that nothing weighs down
floats from end to end of its play for ever; from 0.003 on its size does not show."""
STOP_SOLREF: Final = (0.001, 1.0)
"""Of the play's ends and of the joints' stops: as stiff as two physics steps of 0.5 ms allow; MuJoCo softens it for longer ones."""
STOP_SOLIMP: Final = (0.95, 0.99, 0.0005, 0.5, 2.0)
SMALL_MASS: Final = 1e-6
"""Where a link has no mass: MuJoCo asks for one [kg]."""


def limb_spec(chain: Chain, flaws: LimbFlaws) -> Any:
    """An `MjSpec` of the chain with the flaws that are mechanical. Joints are named as the chain's, their play "NAME play".

    The first joint is mounted on the world; the tip is the site "tip". Motors are plain torques: their limits are the plant's.
    With a wall or a wrist sensor the tip carries the body "hand", whose sensor comes last; with a base sensor the limb hangs on the body
    "mount", whose sensor comes first.

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
    # A limb that leaves the finite numbers shows it, instead of starting over from zero angles
    spec.option.disableflags |= mujoco.mjtDisableBit.mjDSBL_AUTORESET
    spec.option.gravity = chain.root["gravity"][0]
    parent = spec.worldbody
    if flaws.base is not None:
        parent = parent.add_body(name="mount")
        add_sensor(mujoco, spec, "mount", parent)
    for name, record in zip(chain.joint_names, carried.joints, strict=True):
        parent = add_link(mujoco, spec, parent, name, record, flaws)
    root = chain.root[0]
    parent.add_site(name="tip", pos=root["tip"], quat=_quaternion(mujoco, root["tip_turn"]))
    if has_hand(flaws):
        hand = parent.add_body(name="hand", pos=root["tip"], quat=_quaternion(mujoco, root["tip_turn"]))
        hand.explicitinertial = True  # else MuJoCo puts its centre of mass, where pushes act, at its place once more
        hand.ipos = np.zeros(3)
        add_sensor(mujoco, spec, "hand", hand)
        if flaws.wall is not None:
            add_wall(mujoco, spec, hand, flaws.wall)
    return spec


def add_link(mujoco: Any, spec: Any, parent: Any, name: str, record: Any, flaws: LimbFlaws) -> Any:
    """Add a joint, its motor, its play and the link after it to a body of an `MjSpec`; returns the link's body."""
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
        play.damping[0] = PLAY_DAMPING
        _stop(play, -flaws.backlash / 2, flaws.backlash / 2)
    return body


def _stop(joint: Any, lower: float, upper: float) -> None:
    joint.limited = True
    joint.range = (lower, upper)
    joint.solref_limit = STOP_SOLREF
    joint.solimp_limit = STOP_SOLIMP


def _quaternion(mujoco: Any, turn: Floats) -> Floats:
    out = np.zeros(4)
    mujoco.mju_mat2Quat(out, np.ascontiguousarray(turn).ravel())
    return out

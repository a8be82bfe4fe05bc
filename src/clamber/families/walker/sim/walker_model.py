"""A two-frame walker on its ground as a MuJoCo model: two frames that three actuators slide on each other, six springy feet, an arm.

The Delta-frame is free; the Y-frame slides and turns in its plane. The actuators are spatial tendons between the attachments, so the
mechanism is as soft as it really is where it is nearly singular; `struts` builds them as bodies instead, as a check of that.
A motor's aim is a state of its own that runs at the speed of `ctrl`, within the motor's speed and stroke: so aims are even within a control
period, without a word from outside.
"""

from dataclasses import dataclass
from typing import Any, Final

import numpy as np

from ....sim.lone_robot import JointBounds
from ....units import GRAVITY
from ..robot import FRAMES, WalkerRobot
from ..world.ground import Ground
from .walker_flaws import WalkerFlaws


@dataclass(frozen=True, slots=True, kw_only=True)
class Servo:
    """A motor that holds its place like a spring and a damper."""

    stiffness: float
    """[N/m] or [N m/rad]."""
    damping: float
    """[N s/m] or [N m s/rad]."""
    armature: float = 0.0
    """What the motor's own inertia is worth at its output [kg] or [kg m^2]."""


@dataclass(frozen=True, slots=True, kw_only=True)
class WalkerBuild:
    """The parts that the dynamics need and the file does not have."""

    actuator: Servo = Servo(stiffness=1e6, damping=1e4)  # frozen
    """Those that slide the frames."""
    leg: Servo = Servo(stiffness=5e5, damping=2e4, armature=20.0)  # frozen
    joint: Servo = Servo(stiffness=1e5, damping=5e3, armature=5.0)  # frozen
    """Of the arm."""
    foot_stiffness: float = 3e4
    """Of a foot, to the sides: legs that are normal to a plate that tilts change the distance of their feet [N/m]. Physics steps of 2 ms
    carry up to 5e4; with 1e5 feet hum until they slip."""
    foot_damping: float = 1e3
    """To the sides [N s/m]; with three feet down the robot's sway along the ground is damped at a half of critical."""
    foot_radius: float = 0.005
    """Of the ball that a foot is, where its file says that feet are points [m]."""
    foot_mass: float = 0.5
    """Taken out of the frame's [kg]."""
    leg_mass: float = 0.5
    """Of the moving part, taken out of the frame's [kg]."""
    frame_height: float = 0.1
    """Frames have the inertia of discs of this height on the circle of their feet [m]."""


GROUND_BIT, FEET_BIT = 1, 2
"""Bits of what may touch what."""
SOLREF: Final = (0.01, 1.0)


def touch(friction: float, contype: int, conaffinity: int) -> dict[str, Any]:
    """How a foot and the ground touch, as `add_geom` takes it."""
    return {
        "solref": SOLREF,
        "condim": 3,
        "friction": (friction, 0.0, 0.0),
        "contype": contype,
        "conaffinity": conaffinity,
    }


def add_ground(mujoco: Any, spec: Any, ground: Ground, friction: float) -> None:
    """Put the ground into the world.

    Args:
        mujoco: The module.
        spec: An `MjSpec`.
        ground: Its bricks become boxes "tile NUMBER".
        friction: Coefficient of feet on it [-].
    """
    quat = np.zeros(4)
    mujoco.mju_mat2Quat(quat, ground.axes().ravel())
    body = spec.worldbody.add_body(name="ground", quat=quat)
    for i, (x_min, x_max, y_min, y_max, top) in enumerate(ground.tiles()):
        low, high = np.array((x_min, y_min, -ground.depth)), np.array((x_max, y_max, top))
        body.add_geom(
            name=f"tile {i}",
            type=mujoco.mjtGeom.mjGEOM_BOX,
            pos=(low + high) / 2,
            size=(high - low) / 2,
            mass=0.0,
            **touch(friction, GROUND_BIT, FEET_BIT),
        )


IMPRATIO: Final = 100.0
NOSLIP: Final = 5
"""Without these two a standing robot creeps."""
PLACE: Final = ("slide x", "slide y", "turn")
"""Joints of the Y-frame in the Delta-frame."""


ACTUATORS: Final = tuple(f"actuator {i}" for i in range(3))
"""Those that slide the frames: tendons, or rods of struts, and motors."""
LEGS: Final = tuple(f"{frame} leg {i}" for frame in FRAMES for i in range(3))
"""Frame by frame: bodies, joints and motors."""
FEET: Final = tuple(f"{frame} foot {i}" for frame in FRAMES for i in range(3))
"""Bodies and balls."""


def arm_names(robot: WalkerRobot) -> tuple[str, ...]:
    """Of arm joints and motors."""
    return () if robot.arm is None else tuple(f"arm {k}" for k in range(robot.arm.n_joints))


def foot_radius(robot: WalkerRobot, build: WalkerBuild) -> float:
    """Radius of the balls that are the feet [m]."""
    return robot.legs.pad_radius if robot.legs.pad_radius > 0.0 else build.foot_radius


def walker_spec(
    robot: WalkerRobot,
    ground: Ground | None,
    flaws: WalkerFlaws,
    *,
    build: WalkerBuild = WalkerBuild(),  # frozen
    struts: bool = False,
) -> Any:
    """An `MjSpec` of the robot on the ground.

    Joints: "plate" (free), "slide x", "slide y", "turn" of the Y-frame, "FRAME leg NUMBER", whose angle is the leg's length from the plate
    to the sole, "arm NUMBER". Motors: "actuator NUMBER", "FRAME leg NUMBER", "arm NUMBER". The site "tool" is the arm's tool point.

    Args:
        robot: The walker.
        ground: What it stands on; None: nothing.
        flaws: Friction, masses and payload are read here.
        build: What the robot's file does not have.
        struts: Whether actuators are bodies that close a loop by constraints, rather than tendons.
    """
    import mujoco

    spec = mujoco.MjSpec()
    spec.option.timestep = 1.0 / flaws.physics_rate
    spec.option.integrator = mujoco.mjtIntegrator.mjINT_IMPLICITFAST
    spec.option.cone = mujoco.mjtCone.mjCONE_ELLIPTIC
    spec.option.impratio = IMPRATIO
    spec.option.noslip_iterations = NOSLIP
    spec.option.gravity = (0.0, 0.0, -GRAVITY)
    spec.compiler.degree = False
    friction = flaws.friction
    if ground is not None:
        friction *= ground.friction
        add_ground(mujoco, spec, ground, friction)
    delta = spec.worldbody.add_body(name="delta")
    delta.add_freejoint(name="plate")
    y = delta.add_body(name="y")
    for name, axis in zip(PLACE[:2], ((1, 0, 0), (0, 1, 0)), strict=True):
        y.add_joint(name=name, type=mujoco.mjtJoint.mjJNT_SLIDE, axis=axis)
    y.add_joint(name=PLACE[2], type=mujoco.mjtJoint.mjJNT_HINGE, axis=(0, 0, 1))
    bodies = (delta, y)
    for f, body in enumerate(bodies):
        _weigh_frame(body, robot, build, f)
        for i in range(3):
            _add_leg(mujoco, spec, body, robot, build, (f, i), touch(friction, FEET_BIT, GROUND_BIT))
    _add_arm(mujoco, spec, delta, robot, build, flaws.payload)
    (_add_struts if struts else _add_tendons)(mujoco, spec, bodies, robot, build.actuator)
    if flaws.mass_error > 0.0:
        chance = np.random.default_rng(np.random.SeedSequence(flaws.seed).spawn(2)[0])
        for body in spec.bodies:
            factor = 1.0 + flaws.mass_error * chance.uniform(-1.0, 1.0)
            body.mass, body.inertia = factor * body.mass, factor * body.inertia
    return spec


def _weigh(body: Any, mass: float, inertia: tuple[float, float, float], at: tuple[float, float, float]) -> None:
    body.explicitinertial = True
    body.mass, body.inertia, body.ipos = mass, inertia, at


def _weigh_frame(body: Any, robot: WalkerRobot, build: WalkerBuild, f: int) -> None:
    """What the legs leave of the frame's mass, as a disc whose height makes up for them with legs of nominal length."""
    share = robot.mass.share_delta
    whole = robot.mass.frames * (share, 1.0 - share)[f]
    hanging = 3.0 * (build.leg_mass + build.foot_mass)
    assert whole > hanging, "a frame lighter than its legs"
    mass = whole - hanging
    legs = -3.0 * robot.legs.nominal * (0.5 * build.leg_mass + build.foot_mass)
    height = (whole * robot.mass.height - legs) / mass
    radius = (robot.legs.radius_delta, robot.legs.radius_y)[f]
    flat = mass * (radius**2 / 4.0 + build.frame_height**2 / 12.0)
    _weigh(body, mass, (flat, flat, mass * radius**2 / 2.0), (0.0, 0.0, height))


def _add_motor(
    mujoco: Any,
    spec: Any,
    name: str,
    kind: Any,
    servo: Servo,
    ends: tuple[float, float],
    speed: float,
    force: float | None = None,
) -> None:
    motor = spec.add_actuator(name=name, trntype=kind, target=name)
    motor.dyntype = mujoco.mjtDyn.mjDYN_INTEGRATOR
    motor.gaintype, motor.biastype = mujoco.mjtGain.mjGAIN_FIXED, mujoco.mjtBias.mjBIAS_AFFINE
    motor.gainprm[0] = servo.stiffness
    motor.biasprm[1], motor.biasprm[2] = -servo.stiffness, -servo.damping
    motor.actlimited, motor.actrange = True, ends
    motor.ctrllimited, motor.ctrlrange = True, (-speed, speed)
    if force is not None:
        motor.forcelimited, motor.forcerange = True, (-force, force)


def _add_leg(
    mujoco: Any, spec: Any, frame: Any, robot: WalkerRobot, build: WalkerBuild, which: tuple[int, int], contact: Any
) -> None:
    """A slide whose origin is the sole, and on it the ball, which gives way to the sides."""
    f, i = which
    x, y = robot.feet()[which]
    legs, radius = robot.legs, foot_radius(robot, build)
    leg = frame.add_body(name=LEGS[3 * f + i], pos=(x, y, 0.0))
    half = legs.nominal / 2.0
    rod = build.leg_mass * legs.nominal**2 / 12.0
    _weigh(leg, build.leg_mass, (rod, rod, 0.1 * rod), (0.0, 0.0, half))
    joint = leg.add_joint(name=leg.name, type=mujoco.mjtJoint.mjJNT_SLIDE, axis=(0, 0, -1))
    joint.armature = build.leg.armature
    ends = legs.shortest, legs.longest
    _add_motor(mujoco, spec, leg.name, mujoco.mjtTrn.mjTRN_JOINT, build.leg, ends, legs.speed, legs.force)
    foot = leg.add_body(name=FEET[3 * f + i], pos=(0.0, 0.0, radius))
    ball = 0.4 * build.foot_mass * max(radius, 0.02) ** 2
    _weigh(foot, build.foot_mass, (ball, ball, ball), (0.0, 0.0, 0.0))
    for name, axis in (("x", (1, 0, 0)), ("y", (0, 1, 0))):
        spring = foot.add_joint(name=f"{foot.name} {name}", type=mujoco.mjtJoint.mjJNT_SLIDE, axis=axis)
        spring.stiffness[0], spring.damping[0] = build.foot_stiffness, build.foot_damping
    foot.add_geom(name=foot.name, type=mujoco.mjtGeom.mjGEOM_SPHERE, size=(radius, 0, 0), mass=0.0, **contact)


def _add_arm(mujoco: Any, spec: Any, plate: Any, robot: WalkerRobot, build: WalkerBuild, payload: float) -> None:
    """Joint 0 about the plate's normal and joint 1 share a body, for what is between them has no mass of its own."""
    arm = robot.arm
    if arm is None:
        assert payload == 0.0, "a payload without an arm"
        return
    names = arm_names(robot)
    parent, start = plate, (arm.out, 0.0, arm.up)
    for k, (length, mass) in enumerate(zip(arm.links, arm.masses, strict=True)):
        link = parent.add_body(name=f"link {k + 1}", pos=start)
        if k == 0:
            turn = link.add_joint(name=names[0], type=mujoco.mjtJoint.mjJNT_HINGE, axis=(0, 0, 1))
            turn.pos = (-arm.out, 0.0, -arm.up)
            turn.armature = build.joint.armature
        pitch = link.add_joint(name=names[k + 1], type=mujoco.mjtJoint.mjJNT_HINGE, axis=(0, -1, 0))
        pitch.armature = build.joint.armature
        rod = mass * length**2 / 12.0
        _weigh(link, mass, (0.01 * rod, rod, rod), (length / 2.0, 0.0, 0.0))
        parent, start = link, (length, 0.0, 0.0)
    parent.add_site(name="tool", pos=start)
    if payload > 0.0:
        load = parent.add_body(name="payload", pos=start)
        ball = 0.4 * payload * 0.05**2
        _weigh(load, payload, (ball, ball, ball), (0.0, 0.0, 0.0))
    for name, low, high, speed in zip(names, arm.lowest, arm.highest, arm.fastest, strict=True):
        _add_motor(mujoco, spec, name, mujoco.mjtTrn.mjTRN_JOINT, build.joint, (low, high), speed)


def _add_tendons(mujoco: Any, spec: Any, bodies: tuple[Any, Any], robot: WalkerRobot, servo: Servo) -> None:
    places, mechanism = robot.attachments(), robot.mechanism
    for i, name in enumerate(ACTUATORS):
        tendon = spec.add_tendon(name=name)
        for f, body in enumerate(bodies):
            site = body.add_site(name=f"{FRAMES[f]} attachment {i}", pos=(*places[f, i], 0.0))
            tendon.wrap_site(site.name)
        ends = mechanism.shortest, mechanism.longest
        _add_motor(mujoco, spec, name, mujoco.mjtTrn.mjTRN_TENDON, servo, ends, mechanism.speed, mechanism.force)


STRUT_MASS: Final = 1e-3
"""Of each body of a strut [kg]: they are there to close the loop, not to weigh."""
STRUT_ARMATURE: Final = 20.0
"""Of its motor [kg]: without it, constraint and damping, which MuJoCo treats one after the other, get at odds."""


def _add_struts(mujoco: Any, spec: Any, bodies: tuple[Any, Any], robot: WalkerRobot, servo: Servo) -> None:
    """Each a barrel that turns on the Delta-frame and a rod that slides in it, whose end is held to the Y-frame by a constraint."""
    places, mechanism = robot.attachments(), robot.mechanism
    for i, name in enumerate(ACTUATORS):
        barrel = bodies[0].add_body(name=f"barrel {i}", pos=(*places[0, i], 0.0))
        barrel.add_joint(name=f"barrel {i}", type=mujoco.mjtJoint.mjJNT_HINGE, axis=(0, 0, 1))
        rod = barrel.add_body(name=f"rod {i}")
        slide = rod.add_joint(name=name, type=mujoco.mjtJoint.mjJNT_SLIDE, axis=(1, 0, 0))
        slide.armature = STRUT_ARMATURE
        for body in (barrel, rod):
            _weigh(body, STRUT_MASS, (1e-4, 1e-4, 1e-4), (0.0, 0.0, 0.0))
        bodies[1].add_site(name=f"y attachment {i}", pos=(*places[1, i], 0.0))
        rod.add_site(name=f"rod {i}")
        spec.add_equality(
            type=mujoco.mjtEq.mjEQ_CONNECT,
            objtype=mujoco.mjtObj.mjOBJ_SITE,
            name1=f"rod {i}",
            name2=f"y attachment {i}",
            solref=(0.004, 1.0),
            solimp=(0.999, 0.9999, 1e-5, 0.5, 2.0),
        )
        ends = mechanism.shortest, mechanism.longest
        _add_motor(mujoco, spec, name, mujoco.mjtTrn.mjTRN_JOINT, servo, ends, mechanism.speed, mechanism.force)


def lone_walker(robot: WalkerRobot) -> tuple[Any, dict[str, JointBounds]]:
    """`MjSpec` of a walker alone, and the bounds of its joints."""
    legs, arm = robot.legs, robot.arm
    bounds = {name: JointBounds(legs.shortest, legs.longest, None, legs.speed) for name in LEGS}
    if arm is not None:
        ends = zip(arm_names(robot), arm.lowest, arm.highest, arm.fastest, strict=True)
        bounds |= {name: JointBounds(low, high, None, speed) for name, low, high, speed in ends}
    return walker_spec(robot, None, WalkerFlaws()), bounds

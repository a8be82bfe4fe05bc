"""A climber on its board as a MuJoCo model: a planar body, limbs with play, hooks that pegs slide into or grippers, true pegs.

World frame: x right, y up, z out of the wall. All that touches lies in the plane z = 0, pegs as spheres and hooks as capsules in it, so
each contact is one point and quick; a peg is a bolt, and nothing moves along it.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Final

import numpy as np

from ....sim.force_sensing import add_sensor
from ....sim.limb_flaws import LimbFlaws
from ....sim.limb_model import add_link, add_wall
from ....sim.lone_robot import JointBounds
from ....types import Floats
from ....units import GRAVITY, INCH
from ..control.limb_chain import chain_of_limb
from ..robot.robot import Limb, LimbedRobot, body_inertia, body_mass
from ..world.board import Board
from .grippers import PEG_SOLIMP, PEG_SOLREF, add_gripper

HOOKS, PEGS, LINKS, WALL = 1, 2, 4, 8
"""Bits of what may touch what: hooks and links touch pegs, a wall and the ball that presses it each other, nothing else touches."""


PEG_RADIUS: Final = 0.1875 * INCH
"""Of the pegs that hooks are shaped for: the bolts of Bevly 1997, 3/8 in thick [m]."""


@dataclass(frozen=True, slots=True, kw_only=True)
class HookShape:
    """A slot that opens along the grab direction, with a flare that guides a peg in. Nobody prints its sizes: chosen so that it holds."""

    side_play: float = 0.001
    """Slot's width less the peg's diameter [m]."""
    depth: float = 0.008
    """Of the straight walls beyond the seated peg's centre [m]."""
    flare: float = 0.010
    """Length of each flared lip [m]."""
    flare_angle: float = math.radians(45.0)
    """Of each lip to the grab direction [rad]."""
    wire: float = 0.001
    """Radius of the walls [m]."""


def climber_spec(
    robot: LimbedRobot,
    board: Board,
    flaws: LimbFlaws,
    *,
    pegs: Floats | None = None,
    shape: HookShape = HookShape(),  # frozen
    presser: str | None = None,
) -> Any:
    """An `MjSpec` of the robot on the board.

    Joints: "x", "y", "theta" of the body, then every limb's as in `chain_of_limb`. Geoms of pegs are called "peg NUMBER"; tips are sites
    "LIMB tip".

    Args:
        robot: The climber.
        board: Where its holds are believed to be.
        flaws: Of joints and motors; gravity always acts.
        pegs: Where the pegs truly are, shape (n_holds, 2) [m]; None: where the board says.
        shape: Of the hooks.
        presser: The limb that presses against the wall of `flaws`: its tip has a ball and, last of all, a force sensor.
    """
    import mujoco

    spec = _empty_spec(mujoco, flaws)
    places = board.positions() if pegs is None else pegs
    for hold, (x, y) in zip(board.holds, places, strict=True):
        spec.worldbody.add_geom(
            name=f"peg {hold.number}",
            pos=(x, y, 0.0),
            type=mujoco.mjtGeom.mjGEOM_SPHERE,
            size=(hold.radius, 0.0, 0.0),
            contype=PEGS,
            conaffinity=HOOKS | LINKS,
            **_contact(0.0),
        )
    body = _add_body(mujoco, spec, robot)
    peg_radius = max(hold.radius for hold in board.holds)
    for limb in robot.limbs:
        link = _add_limb(mujoco, spec, body, robot, limb, flaws, shape, peg_radius)
        if limb.name == presser and flaws.wall is not None:
            hand = link.add_body(name="hand", pos=chain_of_limb(robot, limb.name).root["tip"][0])
            hand.explicitinertial = True
            hand.ipos = np.zeros(3)
            add_sensor(mujoco, spec, "hand", hand)
            add_wall(mujoco, spec, hand, flaws.wall, contype=WALL, conaffinity=WALL)
    return spec


def _empty_spec(mujoco: Any, flaws: LimbFlaws) -> Any:
    spec = mujoco.MjSpec()
    spec.option.timestep = 1.0 / flaws.physics_rate
    spec.option.integrator = mujoco.mjtIntegrator.mjINT_IMPLICITFAST
    spec.option.cone = mujoco.mjtCone.mjCONE_ELLIPTIC
    spec.option.impratio = 10.0
    spec.compiler.degree = False
    spec.option.gravity = (0.0, -GRAVITY, 0.0)
    return spec


def _contact(friction: float) -> dict[str, Any]:
    return {"solref": PEG_SOLREF, "solimp": PEG_SOLIMP, "condim": 3, "friction": (friction, 0.0, 0.0)}


def _add_body(mujoco: Any, spec: Any, robot: LimbedRobot) -> Any:
    body = spec.worldbody.add_body(name="body")
    body.explicitinertial = True
    body.mass, inertia = body_mass(robot), body_inertia(robot)
    body.inertia = (inertia / 2, inertia / 2, inertia)
    body.ipos = np.zeros(3)  # else a file that MuJoCo writes of it has no mass
    for name, axis in (("x", (1, 0, 0)), ("y", (0, 1, 0))):
        body.add_joint(name=name, type=mujoco.mjtJoint.mjJNT_SLIDE, axis=axis)
    body.add_joint(name="theta", type=mujoco.mjtJoint.mjJNT_HINGE, axis=(0, 0, 1))
    return body


def _add_limb(
    mujoco: Any,
    spec: Any,
    body: Any,
    robot: LimbedRobot,
    limb: Limb,
    flaws: LimbFlaws,
    shape: HookShape,
    peg_radius: float,
) -> Any:
    chain = chain_of_limb(robot, limb.name)
    half = limb.port_angle / 2
    port = body.add_frame(pos=(limb.port_x, limb.port_y, 0.0), quat=(math.cos(half), 0.0, 0.0, math.sin(half)))
    parent = body
    for k, (name, record, length) in enumerate(zip(chain.joint_names, chain.joints, (limb.l1, limb.l2), strict=True)):
        parent = add_link(mujoco, spec, parent, name, record, flaws)
        if k == 0:
            parent.set_frame(port)
        if robot.link_radius > 0.0:
            # clear of the joint before and of the peg that the hook holds
            parent.add_geom(
                type=mujoco.mjtGeom.mjGEOM_CAPSULE,
                fromto=(0.0, 0.0, 0.0, length - (0.0 if k == 0 else 3 * robot.link_radius), 0.0, 0.0),
                size=(robot.link_radius, 0.0, 0.0),
                contype=LINKS,
                conaffinity=PEGS,
                mass=0.0,
                **_contact(0.2),
            )
    tip = chain.root["tip"][0]
    parent.add_site(name=f"{limb.name} tip", pos=tip)
    END_MODELS[limb.end.kind](mujoco, spec, parent, limb, tip, shape, peg_radius)
    return parent


def _add_gripper(mujoco: Any, spec: Any, link: Any, limb: Limb, tip: Floats, _: HookShape, peg_radius: float) -> None:
    add_gripper(mujoco, spec, link, limb, tip, peg_radius, _hook_touch(limb))


def _hook_touch(limb: Limb) -> dict[str, Any]:
    friction = 0.2 if limb.end.friction is None else limb.end.friction
    return {"contype": HOOKS, "conaffinity": PEGS} | _contact(friction)


def _add_hook(mujoco: Any, _: Any, link: Any, limb: Limb, tip: Floats, shape: HookShape, peg_radius: float) -> None:
    """Bottom, walls and lips about a peg that is seated with its centre at the tip; g is the grab direction, h across it."""
    g = np.array((math.cos(limb.end.angle), math.sin(limb.end.angle), 0.0))
    h = np.array((-g[1], g[0], 0.0))
    reach = peg_radius + shape.wire
    side = reach + shape.side_play / 2
    bottom, edge = tip - reach * g, tip + shape.depth * g
    lip = math.cos(shape.flare_angle) * shape.flare * g
    out = math.sin(shape.flare_angle) * shape.flare * h
    strokes = [(bottom - side * h, bottom + side * h)]
    for sign in (-1.0, 1.0):
        wall = edge + sign * side * h
        strokes += [(bottom + sign * side * h, wall), (wall, wall + lip + sign * out)]
    touch = _hook_touch(limb)
    for start, end in strokes:
        link.add_geom(
            type=mujoco.mjtGeom.mjGEOM_CAPSULE,
            fromto=(*start, *end),
            size=(shape.wire, 0.0, 0.0),
            mass=0.0,
            **touch,
        )


END_MODELS: Final[dict[str, Callable[..., None]]] = {"hook": _add_hook, "foot": _add_hook, "gripper": _add_gripper}
"""Kind of end effector -> what adds it to a limb's last link; a foot pushes with a hook's bottom."""


def lone_climber(robot: LimbedRobot) -> tuple[Any, dict[str, JointBounds]]:
    """`MjSpec` of a climber alone, as `climber_spec` has it, and the bounds of its joints."""
    import mujoco

    flaws = LimbFlaws(joint_limits=True)
    bounds = {}
    spec = _empty_spec(mujoco, flaws)
    body = _add_body(mujoco, spec, robot)
    for limb in robot.limbs:
        _add_limb(mujoco, spec, body, robot, limb, flaws, HookShape(), PEG_RADIUS)
        chain = chain_of_limb(robot, limb.name)
        for name, record in zip(chain.joint_names, chain.joints, strict=True):
            lower, upper, limit, speed = (float(record[key]) for key in ("lower", "upper", "limit", "speed"))
            bounds[name] = JointBounds(lower, upper, limit, speed)
    for motor in spec.actuators:
        most = bounds[motor.name].effort
        assert most is not None  # every joint of a climber has a motor with a limit
        motor.ctrllimited, motor.ctrlrange = True, (-most, most)
    return spec, bounds


def boxed_climber(robot: LimbedRobot) -> str:
    """MJCF of a climber alone, its body a box: in the plane it has no shape, as links pass over it."""
    import mujoco

    spec, _ = lone_climber(robot)
    half = np.abs(robot.outline()).max(axis=0)
    spec.body("body").add_geom(type=mujoco.mjtGeom.mjGEOM_BOX, size=(*half, robot.link_radius), mass=0.0)
    spec.compile()
    text: str = spec.to_xml()
    return text

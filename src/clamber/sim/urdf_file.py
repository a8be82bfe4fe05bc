"""A robot as URDF: its tree of links and joints, and what of the model such a tree cannot say."""

import math
import xml.etree.ElementTree as ET
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Final

import numpy as np

from ..types import Floats
from .lone_robot import JointBounds, LoneRobot
from .mjcf_file import numbers, plain_name

GRAIN: Final = 1e-6
"""Mass of a link that is there only because a URDF link has one joint; taken from the next [kg]. Without, MuJoCo refuses the file."""
GRAIN_INERTIA: Final = 1e-9
"""Its moments of inertia [kg m^2]."""
UNKNOWN: Final = 1e6
"""Where a format asks for a limit that the robot's file does not state."""


@dataclass(frozen=True, slots=True)
class Urdf:
    """A robot's URDF."""

    text: str
    losses: tuple[str, ...]
    """What the model has and the file cannot say, a sentence each."""


def urdf_of(robot: LoneRobot) -> Urdf:
    """The URDF of a robot. Its root is the body: how that moves in the world is the reader's to say.

    Limbs' tips and the tool are links without mass, each on a fixed joint. Names have "_" where ours have a blank.
    """
    return _Writer(robot).write()


class _Writer:
    def __init__(self, robot: LoneRobot) -> None:
        import mujoco

        self.mujoco, self.robot, self.model = mujoco, robot, robot.model
        self.root = ET.Element("robot", name=plain_name(robot.name))
        self.shift: dict[int, Floats] = {}
        """Body -> its link's origin, which is on its last joint, in the body's own frame [m]."""
        self.losses: list[str] = []

    def write(self) -> Urdf:
        model = self.model
        for number in range(1, model.nbody):
            self._write_body(number)
        for k in range(model.nsite):
            self._write_site(k)
        self._tell_losses()
        words = [f" {self.robot.title} ", *(f" not said here: {loss} " for loss in self.losses)]
        for k, line in enumerate(words):
            self.root.insert(k, ET.Comment(line.replace("--", "-")))
        # MuJoCo's own reader: links stay apart, and pictures of links count
        extension = ET.SubElement(self.root, "mujoco")
        ET.SubElement(extension, "compiler", fusestatic="false", discardvisual="false")
        ET.indent(self.root)
        return Urdf(ET.tostring(self.root, encoding="unicode", xml_declaration=True) + "\n", tuple(self.losses))

    def _write_body(self, number: int) -> None:
        model, name = self.model, plain_name(self.model.body(number).name)
        parent = int(model.body_parentid[number])
        joints = [j for j in range(model.njnt) if model.jnt_bodyid[j] == number]
        sprung = [j for j in joints if model.jnt_stiffness[j] > 0.0]
        turning = [] if parent == 0 else [j for j in joints if j not in sprung]
        mass, at = float(model.body_mass[number]), np.zeros(3)
        place, turn = model.body_pos[number].copy(), rotation_of(self.mujoco, model.body_quat[number])
        if parent == 0:
            words = ", ".join(self.model.joint(j).name for j in joints)
            self.losses.append(f"how '{name}' moves in the world: {words}")
        else:
            below, origin = plain_name(self.model.body(parent).name), place - self.shift[parent]
            if not turning:
                add_joint(self.root, f"{name}_mount", "fixed", below, name, origin, turn)
            for k, j in enumerate(turning):
                last = k == len(turning) - 1
                link = name if last else f"{plain_name(self.model.joint(j).name)}_link"
                anchor = model.jnt_pos[j].copy()
                origin = origin + turn @ (anchor - at)
                self._moving(j, below, link, origin, turn)
                if not last:
                    add_link(self.root, link, GRAIN, np.zeros(3), GRAIN_INERTIA * np.eye(3))
                    mass -= GRAIN
                below, at, origin, turn = link, anchor, np.zeros(3), np.eye(3)
        self.shift[number] = at
        about = rotation_of(self.mujoco, model.body_iquat[number])
        inertia = about @ np.diag(model.body_inertia[number]) @ about.T
        written = add_link(self.root, name, mass, model.body_ipos[number] - at, inertia)
        first = int(model.body_geomadr[number])
        for k in range(first, first + int(model.body_geomnum[number])):
            self._shape(written, k, at)

    def _moving(self, j: int, parent: str, child: str, place: Floats, turn: Floats) -> None:
        model, name = self.model, self.model.joint(j).name
        sliding = model.jnt_type[j] == self.mujoco.mjtJoint.mjJNT_SLIDE
        bounds = self.robot.bounds.get(name)
        kind = "prismatic" if sliding else "revolute" if bounds is not None else "continuous"
        joint = add_joint(self.root, plain_name(name), kind, parent, child, place, turn)
        ET.SubElement(joint, "axis", xyz=numbers(model.jnt_axis[j]))
        free = JointBounds(-UNKNOWN, UNKNOWN, 0.0, None) if sliding else None
        if (stated := bounds or free) is not None:
            limit = {"lower": repr(stated.lower), "upper": repr(stated.upper)}
            limit["effort"] = repr(UNKNOWN if stated.effort is None else stated.effort)
            limit["velocity"] = repr(UNKNOWN if stated.speed is None else stated.speed)
            ET.SubElement(joint, "limit", limit)
        dof = int(model.jnt_dofadr[j])
        damping, friction = float(model.dof_damping[dof]), float(model.dof_frictionloss[dof])
        if damping > 0.0 or friction > 0.0:
            ET.SubElement(joint, "dynamics", damping=repr(damping), friction=repr(friction))

    def _shape(self, link: ET.Element, k: int, at: Floats) -> None:
        model, kinds = self.model, self.mujoco.mjtGeom
        size, kind = model.geom_size[k], int(model.geom_type[k])
        shapes = {
            int(kinds.mjGEOM_SPHERE): ("sphere", {"radius": repr(float(size[0]))}),
            int(kinds.mjGEOM_CAPSULE): ("cylinder", {"radius": repr(float(size[0])), "length": repr(2.0 * float(size[1]))}),
        }  # fmt: skip
        tag, attributes = shapes[kind]
        turn = rotation_of(self.mujoco, model.geom_quat[k])
        for part in ("visual", "collision"):
            shape = ET.SubElement(link, part)
            place = numbers(model.geom_pos[k] - at)
            ET.SubElement(shape, "origin", xyz=place, rpy=numbers(roll_pitch_yaw(turn)))
            ET.SubElement(ET.SubElement(shape, "geometry"), tag, attributes)

    def _write_site(self, k: int) -> None:
        body = int(self.model.site_bodyid[k])
        name = plain_name(self.model.site(k).name)
        ET.SubElement(self.root, "link", name=name)
        place = self.model.site_pos[k] - self.shift[body]
        turn = rotation_of(self.mujoco, self.model.site_quat[k])
        add_joint(self.root, f"{name}_mount", "fixed", plain_name(self.model.body(body).name), name, place, turn)

    def _tell_losses(self) -> None:
        model = self.model
        sprung = [model.joint(j).name for j in range(model.njnt) if model.jnt_stiffness[j] > 0.0]
        if sprung:
            self.losses.append(f"springs, here stiff: {', '.join(sprung)}")
        if model.ntendon:
            names = ", ".join(model.tendon(k).name for k in range(model.ntendon))
            joints = ", ".join(
                plain_name(model.joint(j).name)
                for j in range(model.njnt)
                if model.joint(j).name not in self.robot.bounds
                and model.jnt_stiffness[j] == 0.0
                and model.body_parentid[model.jnt_bodyid[j]] != 0
            )
            self.losses.append(f"closed loops: {names} move {joints} together; here these are free, without motors")
        if model.neq:
            names = ", ".join(model.equality(k).name for k in range(model.neq))
            self.losses.append(f"what joins and parts: {names}")
        if np.any(model.dof_armature > 0.0):
            self.losses.append("inertia of motors behind their gears (MJCF's armature)")
        if any(int(kind) == int(self.mujoco.mjtGeom.mjGEOM_CAPSULE) for kind in model.geom_type):
            self.losses.append("round ends of links: capsules are cylinders")
        unstated = [plain_name(name) for name, bounds in self.robot.bounds.items() if bounds.effort is None]
        if unstated:
            self.losses.append(
                f"largest forces of {', '.join(unstated)}: the robot's file states none; {UNKNOWN:g} here"
            )


def add_link(root: ET.Element, name: str, mass: float, centre: Floats, inertia: Floats) -> ET.Element:
    """Add a link: its mass [kg], centre of mass [m], shape (3,), and inertia about that [kg m^2], shape (3, 3)."""
    link = ET.SubElement(root, "link", name=name)
    inertial = ET.SubElement(link, "inertial")
    ET.SubElement(inertial, "origin", xyz=numbers(centre), rpy="0 0 0")
    ET.SubElement(inertial, "mass", value=repr(mass))
    moments = {f"i{a}{b}": repr(float(inertia["xyz".index(a), "xyz".index(b)])) for a, b in
               ("xx", "xy", "xz", "yy", "yz", "zz")}  # fmt: skip
    ET.SubElement(inertial, "inertia", moments)
    return link


def add_joint(
    root: ET.Element, name: str, kind: str, parent: str, child: str, place: Floats, turn: Floats
) -> ET.Element:
    """Add a joint between two links, where the child is in its parent [m], shape (3,), and how it is turned, shape (3, 3)."""
    joint = ET.SubElement(root, "joint", name=name, type=kind)
    ET.SubElement(joint, "origin", xyz=numbers(place), rpy=numbers(roll_pitch_yaw(turn)))
    ET.SubElement(joint, "parent", link=parent)
    ET.SubElement(joint, "child", link=child)
    return joint


def rotation_of(mujoco: Any, quaternion: Floats) -> Floats:
    """The matrix of a quaternion (w, x, y, z), shape (3, 3)."""
    flat = np.zeros(9)
    mujoco.mju_quat2Mat(flat, quaternion)
    return flat.reshape(3, 3)


def roll_pitch_yaw(turn: Floats) -> Sequence[float]:
    """Angles about the fixed axes x, then y, then z, that make a rotation matrix, as URDF has them [rad]."""
    level = math.hypot(turn[0, 0], turn[1, 0])
    pitch = math.atan2(-turn[2, 0], level)
    if level < 1e-9:  # straight up or down: roll and yaw are one
        return 0.0, pitch, math.atan2(-turn[0, 1], turn[1, 1])
    return math.atan2(turn[2, 1], turn[2, 2]), pitch, math.atan2(turn[1, 0], turn[0, 0])

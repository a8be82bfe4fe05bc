"""Whole-body control of other software on our trees: placo and TSID, from a URDF that is written of the same masses and joints."""

import importlib.util
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, Final, Protocol
from xml.etree import ElementTree

import numpy as np

from ....control.whole_body.law import BodyLaw
from ....control.whole_body.programme import HOLDS, SWINGS
from ....control.whole_body.tree import FREE, State
from ....regular_files import write_atomically
from ....sim.urdf_file import add_joint, add_link
from ....types import Floats

FRICTION: Final = 0.5
"""Of contacts of both."""


class Rival(Protocol):
    """Another program's law at a moment."""

    def tick(self) -> Floats:
        """Torques, shape (n,)."""


def urdf_text(law: BodyLaw) -> str:
    """A law's tree as URDF; called b0 ..., j001 ... (joints are sorted by name there), and t0 ... for tips."""
    tree, limits = law.tree, law.limits
    root = ElementTree.Element("robot", name="tree")
    for i, parent in enumerate(tree.parent.tolist()):
        add_link(root, f"b{i}", float(tree.mass[i]), tree.centre[i], tree.inertia[i])
        if i == 0:
            continue
        kind, k = "prismatic" if tree.sliding[i] else "revolute", i - 1
        joint = add_joint(root, f"j{i:03}", kind, f"b{parent}", f"b{i}", tree.offset[i], tree.turn[i])
        ElementTree.SubElement(joint, "axis", xyz="0 0 1")
        ElementTree.SubElement(
            joint,
            "limit",
            lower=repr(float(limits.lower[k])),
            upper=repr(float(limits.upper[k])),
            velocity=repr(float(limits.speed[k])),
            effort=repr(float(limits.torque[k])),
        )
    for limb, end in enumerate(tree.end.tolist()):
        ElementTree.SubElement(root, "link", name=f"t{limb}")
        add_joint(root, f"f{limb}", "fixed", f"b{end}", f"t{limb}", tree.tip[limb], tree.tip_turn[limb])
    return ElementTree.tostring(root, encoding="unicode")


@contextmanager
def _urdf_file(law: BodyLaw) -> Iterator[Path]:
    with TemporaryDirectory() as folder:
        file = Path(folder) / "robot.urdf"
        write_atomically(file, urdf_text(law))
        yield file


def _pose(rotation: Floats, position: Floats) -> Floats:
    made = np.eye(4)
    made[:3, :3], made[:3, 3] = rotation, position
    return made


def pulls(law: BodyLaw, limb: int) -> bool:
    """Whether a limb's contact bears a force towards the robot that draws at its surface."""
    count = law.aims.n_rows[limb]
    return bool((law.aims.rows[limb, :count, 0] >= 0.0).all() or (law.aims.limits[limb, :count] > 0.0).all())


class PlacoBody:
    """The `DynamicsSolver` of placo, which solves by eiquadprog: base, swinging tips, contacts and posture, limits of torques."""

    def __init__(self, law: BodyLaw) -> None:
        import placo

        with _urdf_file(law) as file:
            robot = placo.RobotWrapper(str(file), placo.Flags.ignore_collisions)
        names = [f"j{k + 1:03}" for k in range(law.tree.joints)]
        for name, rotor in zip(names, law.tree.rotor.tolist(), strict=True):
            robot.set_rotor_inertia(name, rotor)
            robot.set_gear_ratio(name, 1.0)
        robot.set_gravity(law.tree.gravity)
        self.robot, self.solver = robot, placo.DynamicsSolver(robot)
        self.solver.enable_torque_limits(True)
        base = self.solver.add_frame_task("b0", _pose(law.aims.rotation, law.aims.position))
        base.configure("base", "soft", law.gains.base, law.gains.base)
        for limb in range(law.tree.limbs):
            self._add_limb(law, limb)
        joints = self.solver.add_joints_task()
        joints.set_joints(dict(zip(names, law.aims.posture.tolist(), strict=True)))
        joints.configure("posture", "soft", law.gains.posture)
        self.q, self.v = _pinocchio_state(law.state)

    def _add_limb(self, law: BodyLaw, limb: int) -> None:
        """A limb's contact, or the way of its tip."""
        aims, dynamics, solver = law.aims, law.dynamics, self.solver
        name, does = f"t{limb}", aims.does[limb]
        if does == HOLDS and aims.components[limb] == 6:
            pose = _pose(dynamics.tip_turn[limb], dynamics.tip[limb])
            solver.add_fixed_contact(solver.add_frame_task(name, pose))
        elif does == HOLDS:
            task = solver.add_position_task(name, dynamics.tip[limb])
            contact = solver.add_point_contact(task)
            contact.mu, contact.unilateral = FRICTION, not pulls(law, limb)
            contact.R_world_surface = aims.frame[limb, (1, 2, 0)].T  # its z is the normal
        elif does == SWINGS:
            task = solver.add_position_task(name, aims.tip[limb])
            task.configure(name, "soft", law.gains.swing)

    def tick(self) -> Floats:
        """Torques, shape (n,)."""
        self.robot.state.q = self.q
        self.robot.state.qd = self.v
        self.robot.update_kinematics()
        torques: Floats = self.solver.solve().tau[FREE:]
        return torques


class TsidBody:
    """Accelerations and forces as TSID has them, by eiquadprog: base, swinging tips, contacts and posture, limits of torques."""

    def __init__(self, law: BodyLaw) -> None:
        import pinocchio
        from tsid import tsid_pywrap as tsid  # some of its wheels have nothing in the package itself

        self.pinocchio, self.tsid, self.law = pinocchio, tsid, law
        with _urdf_file(law) as file:
            folders = pinocchio.StdVec_StdString()
            folders.append(str(file.parent))
            floating = pinocchio.JointModelFreeFlyer()
            robot = tsid.RobotWrapper(str(file), folders, floating, False)
        robot.model().armature = np.concatenate((np.zeros(FREE), law.tree.rotor))
        robot.setGravity(pinocchio.Motion(law.tree.gravity, np.zeros(3)))
        self.robot, (self.q, self.v) = robot, _pinocchio_state(law.state)
        self.inverse = tsid.InverseDynamicsFormulationAccForce("body", robot, False)
        self.inverse.computeProblemData(0.0, self.q, self.v)
        self.kept: list[Any] = []
        """Tasks, of which TSID keeps no references."""
        for limb, does in enumerate(law.aims.does.tolist()):
            if does == HOLDS:
                self._hold(limb)
            elif does == SWINGS:
                self._swing(limb)
        gains = law.gains
        aims = law.aims
        base = tsid.TaskSE3Equality("base", robot, "b0")
        aim = tsid.TrajectorySE3Constant("base", pinocchio.SE3(aims.rotation, aims.position))
        self._follow(base, (gains.base_rate, gains.base), FREE, aim)
        leaning = tsid.TaskJointPosture("posture", robot)
        aim = tsid.TrajectoryEuclidianConstant("posture", aims.posture)
        self._follow(leaning, (gains.posture_rate, gains.posture), law.tree.joints, aim)
        torques = tsid.TaskActuationBounds("torques", robot)
        torques.setBounds(-law.limits.torque, law.limits.torque)
        self.inverse.addActuationTask(torques, 1.0, 0, 0.0)
        self.kept.append(torques)
        self.solver = tsid.SolverHQuadProgFast("eiquadprog")
        self.solver.resize(self.inverse.nVar, self.inverse.nEq, self.inverse.nIn)

    def _follow(self, task: Any, how: tuple[float, float], size: int, aim: Any) -> None:
        """A task with so many equations, its rate [1/s] and weight, whose aim stands still."""
        rate, weight = how
        task.setKp(rate**2 * np.ones(size))
        task.setKd(2.0 * rate * np.ones(size))
        task.setReference(aim.computeNext())
        self.inverse.addMotionTask(task, weight, 1, 0.0)
        self.kept.append(task)

    def _swing(self, limb: int) -> None:
        """The way of a tip."""
        law, name = self.law, f"t{limb}"
        task = self.tsid.TaskSE3Equality(name, self.robot, name)
        task.setMask(np.array((1.0, 1, 1, 0, 0, 0)))
        pose = self.pinocchio.SE3(law.dynamics.tip_turn[limb], law.aims.tip[limb])
        aim = self.tsid.TrajectorySE3Constant(name, pose)
        self._follow(task, (law.gains.swing_rate, law.gains.swing), 6, aim)

    def _hold(self, limb: int) -> None:
        """A contact in a point or, where it bears moments, of a small square."""
        law, tsid, name = self.law, self.tsid, f"t{limb}"
        most = float(law.tree.mass.sum()) * 100.0
        least = -most if pulls(law, limb) else 0.0
        bears = law.aims.frame[limb, 0].copy(), FRICTION, least, most
        size = 3 if law.aims.components[limb] == 3 else 6
        if size == 3:
            contact = tsid.ContactPoint(name, self.robot, name, *bears)
            contact.useLocalFrame(False)
        else:
            square = 0.01 * np.array(((1.0, 1, -1, -1), (1, -1, 1, -1), (0, 0, 0, 0)))
            contact = tsid.Contact6d(name, self.robot, name, square, *bears)
        contact.setKp(np.zeros(size))
        contact.setKd(law.gains.rest_rate * np.ones(size))
        turn, tip = law.dynamics.tip_turn[limb], law.dynamics.tip[limb]
        contact.setReference(self.pinocchio.SE3(turn, tip))
        self.inverse.addRigidContact(contact, 1e-5)
        self.kept.append(contact)

    def tick(self) -> Floats:
        """Torques, shape (n,)."""
        found = self.solver.solve(self.inverse.computeProblemData(0.0, self.q, self.v))
        torques: Floats = self.inverse.getActuatorForces(found)
        return torques


def _pinocchio_state(state: State) -> tuple[Floats, Floats]:
    """As Pinocchio counts it: quaternion x, y, z, w, and the base's velocity in its own frame."""
    from scipy.spatial.transform import Rotation

    turn = Rotation.from_matrix(state.rotation).as_quat()
    q = np.concatenate((state.position, turn, state.joints))
    return q, np.concatenate((state.rotation.T @ state.speed[:3], state.speed[3:]))


RIVALS: Final[dict[str, Callable[[BodyLaw], Rival]]] = {"placo": PlacoBody, "tsid": TsidBody}
"""Module -> a law at a moment by it; each is optional."""


def installed(name: str) -> bool:
    """Whether a rival is there."""
    return importlib.util.find_spec(name) is not None

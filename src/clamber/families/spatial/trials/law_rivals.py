"""Whole-body control of other software on our trees: placo and TSID, from a URDF that is written of the same masses and joints."""

import importlib.util
import math
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, Final, TypeAlias

import numpy as np

from ....control.whole_body.law import BodyLaw
from ....control.whole_body.programme import HOLDS, SWINGS
from ....control.whole_body.tree import FREE, State
from ....regular_files import write_atomically
from ....types import Floats

Tick: TypeAlias = Callable[[int], Floats]
"""Torques at a moment of those that it was made of, by its index, shape (n,)."""
FRICTION: Final = 0.5
"""Of contacts of both."""


def urdf_of(law: BodyLaw) -> str:
    """A law's tree as URDF; called b0 ..., j001 ... (joints are sorted by name there), and t0 ... for tips."""

    def origin(place: Floats, turn: Floats) -> str:
        level = math.hypot(turn[0, 0], turn[1, 0])
        roll, yaw = math.atan2(turn[2, 1], turn[2, 2]), math.atan2(turn[1, 0], turn[0, 0])
        if level < 1e-9:  # z turns as x does, and is left alone
            roll, yaw = math.atan2(-turn[1, 2], turn[1, 1]), 0.0
        angles = f"{roll!r} {math.atan2(-turn[2, 0], level)!r} {yaw!r}"
        return f'<origin xyz="{" ".join(map(repr, place.tolist()))}" rpy="{angles}"/>'

    tree, limits, parts = law.tree, law.limits, ['<robot name="tree">']
    for i, parent in enumerate(tree.parent.tolist()):
        spin = tree.inertia[i]
        inertia = " ".join(f'i{"xyz"[a]}{"xyz"[b]}="{float(spin[a, b])!r}"' for a in range(3) for b in range(a, 3))
        mass = f'{origin(tree.centre[i], np.eye(3))}<mass value="{float(tree.mass[i])!r}"/><inertia {inertia}/>'
        parts.append(f'<link name="b{i}"><inertial>{mass}</inertial></link>')
        if i > 0:
            k, kind = i - 1, "prismatic" if tree.sliding[i] else "revolute"
            bounds = {"lower": limits.lower, "upper": limits.upper, "velocity": limits.speed, "effort": limits.torque}
            limit = " ".join(f'{name}="{float(values[k])!r}"' for name, values in bounds.items())
            ends = f'<parent link="b{parent}"/><child link="b{i}"/><axis xyz="0 0 1"/><limit {limit}/>'
            parts.append(f'<joint name="j{i:03}" type="{kind}">{origin(tree.offset[i], tree.turn[i])}{ends}</joint>')
    for limb, end in enumerate(tree.end.tolist()):
        ends = f'<parent link="b{end}"/><child link="t{limb}"/>'
        parts.append(f'<link name="t{limb}"/><joint name="f{limb}" type="fixed">')
        parts.append(f"{origin(tree.tip[limb], tree.tip_turn[limb])}{ends}</joint>")
    return "".join([*parts, "</robot>"])


@contextmanager
def _urdf_file(law: BodyLaw) -> Iterator[Path]:
    with TemporaryDirectory() as folder:
        file = Path(folder) / "robot.urdf"
        write_atomically(file, urdf_of(law))
        yield file


def _pose(rotation: Floats, position: Floats) -> Floats:
    made = np.eye(4)
    made[:3, :3], made[:3, 3] = rotation, position
    return made


def pulls(law: BodyLaw, limb: int) -> bool:
    """Whether a limb's contact bears a force towards the robot that draws at its surface."""
    count = law.aims.n_rows[limb]
    return bool((law.aims.rows[limb, :count, 0] >= 0.0).all() or (law.aims.limits[limb, :count] > 0.0).all())


def placo_tick(laws: Sequence[BodyLaw]) -> Tick:
    """The `DynamicsSolver` of placo, which solves by eiquadprog: base, swinging tips, contacts and posture, limits of torques."""
    import placo

    def made(law: BodyLaw) -> Callable[[], Floats]:
        aims, dynamics, n = law.aims, law.dynamics, law.tree.joints
        with _urdf_file(law) as file:
            robot = placo.RobotWrapper(str(file), placo.Flags.ignore_collisions)
        for k in range(n):
            robot.set_rotor_inertia(f"j{k + 1:03}", float(law.tree.rotor[k]))
            robot.set_gear_ratio(f"j{k + 1:03}", 1.0)
        robot.set_gravity(law.tree.gravity)
        solver = placo.DynamicsSolver(robot)
        solver.enable_torque_limits(True)
        base = solver.add_frame_task("b0", _pose(aims.rotation, aims.position))
        base.configure("base", "soft", law.gains.base, law.gains.base)
        for limb, does in enumerate(aims.does.tolist()):
            name = f"t{limb}"
            if does == HOLDS and aims.components[limb] == 6:
                task = solver.add_frame_task(name, _pose(dynamics.tip_turn[limb], dynamics.tip[limb]))
                solver.add_fixed_contact(task)
            elif does == HOLDS:
                contact = solver.add_point_contact(solver.add_position_task(name, dynamics.tip[limb]))
                contact.mu, contact.unilateral = FRICTION, not pulls(law, limb)
                contact.R_world_surface = aims.frame[limb, (1, 2, 0)].T  # its z is the normal
            elif does == SWINGS:
                solver.add_position_task(name, aims.tip[limb]).configure(name, "soft", law.gains.swing)
        joints = solver.add_joints_task()
        posture = {f"j{k + 1:03}": float(aims.posture[k]) for k in range(n)}
        joints.set_joints(posture)
        joints.configure("posture", "soft", law.gains.posture)
        q, v = _pinocchio_state(law.state)

        def tick() -> Floats:
            robot.state.q, robot.state.qd = q, v
            robot.update_kinematics()
            torques: Floats = solver.solve().tau[FREE:]
            return torques

        return tick

    ticks = [made(law) for law in laws]
    return lambda i: ticks[i]()


def tsid_tick(laws: Sequence[BodyLaw]) -> Tick:
    """Accelerations and forces as TSID has them, by eiquadprog: base, swinging tips, contacts and posture, limits of torques."""
    import pinocchio
    from tsid import tsid_pywrap as tsid  # some of its wheels have nothing in the package itself

    def constant(name: str, value: Any) -> Any:
        kind = tsid.TrajectorySE3Constant if isinstance(value, pinocchio.SE3) else tsid.TrajectoryEuclidianConstant
        return kind(name, value).computeNext()

    def made(law: BodyLaw) -> Callable[[], Floats]:
        aims, dynamics, gains, n = law.aims, law.dynamics, law.gains, law.tree.joints
        with _urdf_file(law) as file:
            folders = pinocchio.StdVec_StdString()
            folders.append(str(file.parent))
            robot = tsid.RobotWrapper(str(file), folders, pinocchio.JointModelFreeFlyer(), False)
        robot.model().armature = np.concatenate((np.zeros(FREE), law.tree.rotor))
        robot.setGravity(pinocchio.Motion(law.tree.gravity, np.zeros(3)))
        q, v = _pinocchio_state(law.state)
        inverse = tsid.InverseDynamicsFormulationAccForce("body", robot, False)
        inverse.computeProblemData(0.0, q, v)
        most = float(law.tree.mass.sum()) * 100.0
        kept: list[Any] = [robot]

        def follow(task: Any, rate: float, size: int, weight: float, sample: Any) -> None:
            task.setKp(rate**2 * np.ones(size))
            task.setKd(2.0 * rate * np.ones(size))
            task.setReference(sample)
            inverse.addMotionTask(task, weight, 1, 0.0)
            kept.append(task)

        for limb, does in enumerate(aims.does.tolist()):
            name, place = f"t{limb}", pinocchio.SE3(dynamics.tip_turn[limb], dynamics.tip[limb])
            if does == HOLDS:
                least = -most if pulls(law, limb) else 0.0
                normal, size = aims.frame[limb, 0].copy(), 3 if aims.components[limb] == 3 else 6
                if size == 3:
                    contact = tsid.ContactPoint(name, robot, name, normal, FRICTION, least, most)
                    contact.useLocalFrame(False)
                else:
                    patch = 0.01 * np.array(((1.0, 1, -1, -1), (1, -1, 1, -1), (0, 0, 0, 0)))
                    contact = tsid.Contact6d(name, robot, name, patch, normal, FRICTION, least, most)
                contact.setKp(np.zeros(size))
                contact.setKd(gains.rest_rate * np.ones(size))
                contact.setReference(place)
                inverse.addRigidContact(contact, 1e-5)
                kept.append(contact)
            elif does == SWINGS:
                task = tsid.TaskSE3Equality(name, robot, name)
                task.setMask(np.array((1.0, 1, 1, 0, 0, 0)))
                aim = pinocchio.SE3(dynamics.tip_turn[limb], aims.tip[limb])
                follow(task, gains.swing_rate, 6, gains.swing, constant(name, aim))
        aim = pinocchio.SE3(aims.rotation, aims.position)
        follow(tsid.TaskSE3Equality("base", robot, "b0"), gains.base_rate, 6, gains.base, constant("base", aim))
        leaning = tsid.TaskJointPosture("posture", robot)
        follow(leaning, gains.posture_rate, n, gains.posture, constant("posture", aims.posture))
        torques = tsid.TaskActuationBounds("torques", robot)
        torques.setBounds(-law.limits.torque, law.limits.torque)
        inverse.addActuationTask(torques, 1.0, 0, 0.0)
        kept.append(torques)
        solver = tsid.SolverHQuadProgFast("eiquadprog")
        solver.resize(inverse.nVar, inverse.nEq, inverse.nIn)

        def tick() -> Floats:
            found = solver.solve(inverse.computeProblemData(0.0, q, v))
            made: Floats = inverse.getActuatorForces(found)
            return made

        tick.kept = kept  # type: ignore[attr-defined]  # TSID keeps no references to its tasks
        return tick

    ticks = [made(law) for law in laws]
    return lambda i: ticks[i]()


def _pinocchio_state(state: State) -> tuple[Floats, Floats]:
    """As Pinocchio counts it: quaternion x, y, z, w, and the base's velocity in its own frame."""
    from scipy.spatial.transform import Rotation

    turn = Rotation.from_matrix(state.rotation).as_quat()
    q = np.concatenate((state.position, turn, state.joints))
    return q, np.concatenate((state.rotation.T @ state.speed[:3], state.speed[3:]))


RIVALS: Final[dict[str, Callable[[Sequence[BodyLaw]], Tick]]] = {"placo": placo_tick, "tsid": tsid_tick}
"""Module -> what it does in a tick; each is optional."""


def installed(name: str) -> bool:
    """Whether a rival is there."""
    return importlib.util.find_spec(name) is not None

"""Floating trees of made-up numbers, and the same ones as MuJoCo models."""

import mujoco
import numpy as np

from clamber.control.whole_body.tree import State, Tree
from plain_spatial import turn_about


def random_tree(seed: int, limbs: int = 3, joints: int = 3, *, slide: bool = True) -> Tree:
    """A base with limbs of hinges, the last joint of the first limb a slide if asked for."""
    random = np.random.default_rng(seed)
    n = limbs * joints
    parent = [-1]
    for limb in range(limbs):
        parent += [0] + [1 + limb * joints + k for k in range(joints - 1)]
    sliding = np.zeros(n + 1, np.int32)
    sliding[joints] = int(slide)
    inertia = np.zeros((n + 1, 3, 3))
    for i in range(n + 1):
        square = random.normal(size=(3, 3))
        inertia[i] = 0.02 * (square @ square.T + 0.5 * np.eye(3))
        inertia[i] = np.trace(inertia[i]) * np.eye(3) - inertia[i]
    return Tree(
        parent=np.array(parent, np.int32),
        sliding=sliding,
        offset=random.uniform(-0.3, 0.3, (n + 1, 3)) * (np.arange(n + 1) > 0)[:, None],
        turn=np.array([np.eye(3)] + [random_turn(random) for _ in range(n)]),
        mass=random.uniform(0.2, 2.0, n + 1),
        centre=random.uniform(-0.1, 0.1, (n + 1, 3)),
        inertia=inertia,
        rotor=random.uniform(0.0, 0.05, n),
        end=np.arange(1, limbs + 1, dtype=np.int32) * joints,
        tip=random.uniform(-0.2, 0.2, (limbs, 3)),
        tip_turn=np.array([random_turn(random) for _ in range(limbs)]),
        gravity=np.array([0.5, -1.0, -9.0]),
    )


def random_turn(random: np.random.Generator) -> np.ndarray:
    """A rotation of any axis and angle."""
    axis = random.normal(size=3)
    return turn_about(axis / np.linalg.norm(axis), random.uniform(-3.0, 3.0))


def random_state(tree: Tree, seed: int, speed: float = 1.0) -> State:
    """Anywhere, moving."""
    random = np.random.default_rng(seed)
    return State(
        random_turn(random),
        random.uniform(-3.0, 3.0, 3),
        speed * random.normal(size=tree.speeds),
        random.uniform(-1.0, 1.0, tree.joints),
    )


def as_mujoco(tree: Tree) -> mujoco.MjModel:
    """The same robot as a MuJoCo model; its tips are sites called by their limbs' numbers."""
    spec = mujoco.MjSpec()
    spec.compiler.degree = False
    spec.option.gravity = tree.gravity
    bodies = []
    for i, above in enumerate(tree.parent):
        parent = spec.worldbody if above < 0 else bodies[above]
        body = parent.add_body(pos=tree.offset[i], quat=quaternion(tree.turn[i]))
        body.explicitinertial, body.mass, body.ipos = True, tree.mass[i], tree.centre[i]
        spin = tree.inertia[i]
        body.fullinertia = [spin[a, b] for a, b in ((0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2))]
        if above < 0:
            body.add_freejoint()
        else:
            kind = mujoco.mjtJoint.mjJNT_SLIDE if tree.sliding[i] else mujoco.mjtJoint.mjJNT_HINGE
            joint = body.add_joint(type=kind, axis=(0, 0, 1))
            joint.armature = tree.rotor[i - 1]
        bodies.append(body)
    for limb, end in enumerate(tree.end):
        bodies[end].add_site(name=str(limb), pos=tree.tip[limb], quat=quaternion(tree.tip_turn[limb]))
    return spec.compile()


def quaternion(turn: np.ndarray) -> np.ndarray:
    """Of a rotation: w, x, y, z."""
    out = np.zeros(4)
    mujoco.mju_mat2Quat(out, np.ascontiguousarray(turn).ravel())
    return out


def posed(model: mujoco.MjModel, state: State) -> mujoco.MjData:
    """The model in a state, everything worked out."""
    data = mujoco.MjData(model)
    data.qpos[:3], data.qpos[3:7] = state.position, quaternion(state.rotation)
    data.qpos[7:], data.qvel[:] = state.joints, state.speed
    mujoco.mj_forward(model, data)
    return data

"""Small robots in space and random stances of them, for tests: every number is made up."""

import math

import numpy as np

from clamber.families.spatial.robot.chains import Chains
from clamber.families.spatial.robot.contacts import Contact, cone
from clamber.families.spatial.statics.judging import Statics
from clamber.types import Floats, Records
from plain_spatial import frames, turn_about

X, Y, Z = np.eye(3)


def point_foot(friction: float) -> Contact:
    """A foot that touches in a point: pushes only, within its friction cone."""
    return Contact(kind="point", rows=cone(), friction=friction)


def gripper(friction: float, pull: float) -> Contact:
    """A gripper on a hold as a point that also pulls: a friction cone whose apex lies at the pull-off force [N]."""
    return Contact(kind="gripper", rows=cone(), friction=friction, pull=pull)


def spider(limbs: int, *, torque: float = 3.0, base_mass: float = 1.2, link_mass: float = 0.08) -> Chains:
    """Limbs of three hinges around a disc, as of a small insect: hip about the vertical, two bending joints."""
    offset = np.zeros((limbs, 4, 3))
    rotation = np.tile(np.eye(3), (limbs, 4, 1, 1))
    for limb in range(limbs):
        angle = math.tau * (limb + 0.5) / limbs
        offset[limb] = [[0.08 * math.cos(angle), 0.08 * math.sin(angle), 0.0], [0.05, 0, 0], [0.1, 0, 0], [0.12, 0, 0]]
        rotation[limb, 0], rotation[limb, 1] = turn_about(Z, angle), turn_about(X, -math.pi / 2)
        rotation[limb, 3] = turn_about(Y, math.pi / 2)
    each = np.ones((limbs, 3))
    return Chains(
        name=f"spider{limbs}",
        limb_names=tuple(f"limb{limb}" for limb in range(limbs)),
        joint_names=tuple(tuple(f"joint{limb}{k}" for k in range(3)) for limb in range(limbs)),
        n_joints=np.full(limbs, 3, np.int32),
        offset=offset,
        rotation=rotation,
        sliding=np.zeros((limbs, 3), np.int32),
        lower=each * [-1.2, -1.8, -0.2],
        upper=each * [1.2, 1.8, 2.7],
        torque=each * torque,
        speed=each * math.inf,
        nominal=each * [0.0, -0.6, 1.9],
        mass=each * link_mass,
        centre=np.tile([[0.02, 0.0, 0.01], [0.05, 0.01, 0.0], [0.06, 0.0, -0.01]], (limbs, 1, 1)),
        radius=each * 0.01,
        base_mass=base_mass,
        base_centre=np.array([0.01, -0.005, 0.02]),
        base_half=np.array([0.05, 0.05, 0.02]),
    )


def arms(limbs: int, joints: int = 6, *, slide: bool = False, torque: float = 60.0) -> Chains:
    """Long limbs of six or seven joints around a drum, the wrist as of an industrial arm; one joint may be a slide."""
    offset = np.zeros((limbs, joints + 1, 3))
    rotation = np.tile(np.eye(3), (limbs, joints + 1, 1, 1))
    lengths = [0.0, 0.1, 0.4, 0.2, 0.2, 0.08, 0.06]
    turns = [np.eye(3), turn_about(X, -math.pi / 2), np.eye(3), turn_about(Y, math.pi / 2)]
    turns += [turn_about(Y, -math.pi / 2), turn_about(Y, math.pi / 2), turn_about(X, math.pi / 2)]
    for limb in range(limbs):
        angle = math.tau * (limb + 0.5) / limbs
        for k in range(1, joints + 1):
            offset[limb, k] = [lengths[k % 7], 0.0, 0.0] if k <= 3 or k == 5 else [0.0, 0.0, lengths[k % 7]]
            rotation[limb, k] = turns[k] if k < joints else np.eye(3)
        offset[limb, 0] = [0.2 * math.cos(angle), 0.2 * math.sin(angle), 0.0]
        rotation[limb, 0] = turn_about(Z, angle)
        offset[limb, joints] = [0.0, 0.0, 0.08]
    each = np.ones((limbs, joints))
    sliding = np.zeros((limbs, joints), np.int32)
    nominal = np.array([0.0, -0.7, 1.6, 0.0, 0.7, 0.0, 0.0])[:joints]
    lower, upper = each * -2.4, each * 2.4
    if slide:
        sliding[:, 3], lower[:, 3], upper[:, 3] = 1, -0.05, 0.15
    return Chains(
        name=f"arms{limbs}x{joints}",
        limb_names=tuple(f"limb{limb}" for limb in range(limbs)),
        joint_names=tuple(tuple(f"joint{limb}{k}" for k in range(joints)) for limb in range(limbs)),
        n_joints=np.full(limbs, joints, np.int32),
        offset=offset,
        rotation=rotation,
        sliding=sliding,
        lower=lower,
        upper=upper,
        torque=each * torque,
        speed=each * math.inf,
        nominal=each * nominal,
        mass=each * np.linspace(1.5, 0.3, joints),
        centre=np.tile([0.05, 0.02, 0.03], (limbs, joints, 1)),
        radius=each * 0.03,
        base_mass=12.0,
        base_centre=np.array([0.02, 0.01, -0.03]),
        base_half=np.array([0.1, 0.1, 0.05]),
    )


def random_postures(chains: Chains, n: int, spread: float, rng: np.random.Generator) -> Floats:
    """Postures about the nominal one, within the limits, shape (n, limbs, joints); `spread` in shares of the joints' ranges."""
    noise = rng.uniform(-0.5, 0.5, (n, *chains.nominal.shape)) * spread * (chains.upper - chains.lower)
    postures: Floats = np.clip(chains.nominal + noise, chains.lower + 0.01, chains.upper - 0.01)
    return postures


def random_turn(rng: np.random.Generator) -> Floats:
    """Rotation matrix, uniform."""
    q = rng.normal(size=4)
    a, b, c, d = q / np.linalg.norm(q)
    return np.array(
        [
            [1 - 2 * (c * c + d * d), 2 * (b * c - a * d), 2 * (b * d + a * c)],
            [2 * (b * c + a * d), 1 - 2 * (b * b + d * d), 2 * (c * d - a * b)],
            [2 * (b * d - a * c), 2 * (c * d + a * b), 1 - 2 * (b * b + c * c)],
        ]
    )


def random_stances(
    statics: Statics, chains: Chains, n: int, rng: np.random.Generator, spread: float = 0.3
) -> tuple[Records, Records]:
    """Bodies at any pose and contacts where random postures have their tips, normals about the end effectors' backs."""
    bodies = statics.bodies(n)
    postures = random_postures(chains, n, spread, rng)
    limbs = len(chains.limb_names)
    places, normals = np.zeros((n, limbs, 3)), np.zeros((n, limbs, 3))
    aligned = statics.robot["aligned"][0]
    for i in range(n):
        base = np.eye(4)
        base[:3, :3], base[:3, 3] = random_turn(rng), rng.normal(size=3)
        bodies["rotation"][i], bodies["place"][i] = base[:3, :3].reshape(-1), base[:3, 3]
        for limb in range(limbs):
            end = frames(chains, limb, postures[i, limb], base)[-1]
            places[i, limb] = end[:3, 3]
            normal = base[:3, 2] + 0.3 * rng.normal(size=3)
            normals[i, limb] = -end[:3, 2] if aligned[limb] else normal / np.linalg.norm(normal)
        down = -base[:3, 2] + 0.6 * rng.normal(size=3)
        bodies["gravity"][i] = 9.81 * down / np.linalg.norm(down)
    return bodies, statics.contacts(places, normals)

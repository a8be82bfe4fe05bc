"""Stances of robots in space that checks are timed on: a quadruped as jet-leg knows it, and robots that come with Clamber."""

import math
from dataclasses import dataclass
from typing import Any, Final

import numpy as np

from ....tasks.robots import read_robot
from ....types import Floats, Records
from ..robot.chains import Chains
from ..robot.contacts import Contact, Row, line
from ..statics.judging import Statics
from ..statics.kinematics_kernels import limb_frames
from ..statics.records import WORK

FRICTION: Final = 0.8
MASS: Final = 85.0
"""Of the quadruped [kg]: jet-leg's default, all of it in the trunk."""
TORQUE: Final = 60.0
"""Of each of its motors [N m]: about half of the stances stand."""
HIP: Final = (0.3735, 0.207)
"""From the centre of the trunk to a hip, ahead and aside [m]: HyQ, as jet-leg has it."""
LENGTHS: Final = (0.08, 0.35, 0.341)
"""From the hip's roll to its pitch, thigh, shank [m]: HyQ, as jet-leg has it."""
SIDES: Final = ((1, 1), (1, -1), (-1, 1), (-1, -1))
"""Ahead and aside of legs in jet-leg's order: LF, RF, LH, RH."""
SPREAD: Final = 0.25
"""Of random postures about the nominal one, in parts of each joint's range."""


@dataclass(frozen=True, slots=True)
class Stances:
    """Stances of one robot, ready to be judged."""

    name: str
    chains: Chains
    kinds: tuple[Contact, ...]
    statics: Statics
    bodies: Records
    contacts: Records

    def __len__(self) -> int:
        return len(self.bodies)


def pyramid(friction: float) -> Contact:
    """A point foot whose friction cone is the pyramid of four sides around it that jet-leg counts with."""
    rows = tuple(
        Row(coefficients=tangent, per_friction=line(n=-1.0))
        for sign in (1.0, -1.0)
        for tangent in (line(f1=sign), line(f2=sign))
    )
    return Contact(kind="foot", rows=rows, friction=friction)


def jet_quadruped() -> Chains:
    """HyQ as jet-leg has it: legs of a roll and two pitches without a mass, knees bent inwards."""
    offset, rotation = np.zeros((4, 4, 3)), np.tile(np.eye(3), (4, 4, 1, 1))
    each = np.ones((4, 3))
    nominal = np.zeros((4, 3))
    for leg, (ahead, aside) in enumerate(SIDES):
        offset[leg, 0] = ahead * HIP[0], aside * HIP[1], 0.0
        rotation[leg, 0] = np.array(((0, 0, -1), (0, -1, 0), (-1, 0, 0)))  # z against the trunk's x, x down
        rotation[leg, 1] = np.array(((1, 0, 0), (0, 0, -1), (0, 1, 0)))  # z to the left of the trunk
        rotation[leg, 3] = np.array(((0, 0, 1), (0, 1, 0), (-1, 0, 0)))  # z along the shank
        nominal[leg] = 0.0, 0.75 * ahead, -1.5 * ahead
        for k, length in enumerate(LENGTHS):
            offset[leg, k + 1, 0] = length
    return Chains(
        name="hyq of jet-leg",
        limb_names=("LF", "RF", "LH", "RH"),
        joint_names=tuple((f"{leg}_HAA", f"{leg}_HFE", f"{leg}_KFE") for leg in ("LF", "RF", "LH", "RH")),
        n_joints=np.full(4, 3, np.int32),
        offset=offset,
        rotation=rotation,
        sliding=np.zeros((4, 3), np.int32),
        lower=np.where(nominal < 0.0, nominal - 0.9, nominal - 0.7),
        upper=np.where(nominal < 0.0, nominal + 0.7, nominal + 0.9),
        torque=TORQUE * each,
        speed=math.inf * each,
        nominal=nominal,
        mass=0.0 * each,
        centre=np.zeros((4, 3, 3)),
        radius=0.0 * each,
        base_mass=MASS,
        base_centre=np.zeros(3),
        base_half=np.array((0.3, 0.1, 0.05)),
    )


def tips_of(statics: Statics, postures: Floats) -> Floats:
    """Places of all tips of a robot [m], base frame, shape (limbs, 3), of postures of shape (limbs, joints)."""
    work = np.zeros(1, WORK)
    work["posture"][0, : len(postures), : postures.shape[1]] = postures
    for limb in range(len(postures)):
        limb_frames(statics.robot[0], limb, work[0])
    n = statics.robot["n_joints"][0]
    return np.array([work["origin"][0, limb, n[limb]] for limb in range(len(postures))])


def jet_stances(n: int, seed: int = 1) -> Stances:
    """The quadruped level on feet at various places, each fourth stance without one of them."""
    chains, kind = jet_quadruped(), pyramid(FRICTION)
    made = _stances("HyQ", chains, (kind,) * 4, n, seed)
    made.contacts["normal"] = 0.0, 0.0, 1.0
    made.contacts["along"] = 1.0, 0.0, 0.0
    made.contacts["bears"][np.arange(0, n, 4), np.arange(0, n, 4) // 4 % 4] = 0
    return made


def shipped_stances(robot: str, n: int, seed: int = 1) -> Stances:
    """A robot that comes with Clamber on holds about its nominal tips, normals leaning at random."""
    from ..robot.robot import build_robot

    built = build_robot(read_robot(robot))
    return _stances(robot, built.chains, tuple(built.contacts), n, seed)


def _stances(name: str, chains: Chains, kinds: tuple[Contact, ...], n: int, seed: int) -> Stances:
    statics, rng = Statics(chains, kinds), np.random.default_rng(seed)
    noise = rng.uniform(-0.5, 0.5, (n, *chains.nominal.shape)) * SPREAD * (chains.upper - chains.lower)
    postures = np.clip(chains.nominal + noise, chains.lower + 0.02, chains.upper - 0.02)
    places = np.array([tips_of(statics, each) for each in postures])
    normals = rng.normal(size=places.shape) * 0.15 + (0.0, 0.0, 1.0)
    normals /= np.linalg.norm(normals, axis=2, keepdims=True)
    aligned = statics.robot["aligned"][0, : places.shape[1]]
    normals[:, aligned == 1] = 0.0, 0.0, 1.0
    contacts: Any = statics.contacts(places, normals)
    return Stances(name, chains, kinds, statics, statics.bodies(n), contacts)

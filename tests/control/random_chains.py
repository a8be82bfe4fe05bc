"""Random serial chains, Pinocchio's model of a chain, and one tick of a law: what the tests of `clamber.control` share."""

from functools import cache
from typing import Any

import hypothesis
import numpy as np
import pinocchio
from scipy.spatial.transform import Rotation

from clamber.control.chain import Chain, empty_chain
from clamber.control.controller import Controller, still_aim
from clamber.control.law_settings import LawSettings
from clamber.families.climber.control.limb_chain import chain_of_limb
from clamber.tasks.robots import load_robot
from clamber.types import Floats

PERIOD = 0.005
quarter = hypothesis.settings(max_examples=hypothesis.settings.default.max_examples // 4)
"""Fewer examples, for properties that are tried on many laws and chains."""


def random_chain(seed: int, n: int, *, sliding: int | None = None, gravity: bool = True) -> Chain:
    """A spatial chain with links of any shape; joint `sliding` slides."""
    rng = np.random.default_rng(seed)
    joints, root = empty_chain(n)
    joints["place"] = rng.normal(size=(n, 3)) * 0.15
    joints["turn"] = Rotation.random(n, rng).as_matrix()
    axes = rng.normal(size=(n, 3))
    joints["axis"] = axes / np.linalg.norm(axes, axis=1)[:, None]
    if sliding is not None:
        joints["sliding"][sliding] = 1
    joints["mass"] = rng.uniform(0.1, 1.0, n)
    joints["centre"] = rng.normal(size=(n, 3)) * 0.1
    for j in range(n):
        points = rng.normal(size=(4, 3)) * 0.05  # four equal masses make any inertia
        points -= points.mean(axis=0)
        joints["inertia"][j] = joints["mass"][j] / 4 * sum(p @ p * np.eye(3) - np.outer(p, p) for p in points)
    joints["rotor"] = rng.uniform(0.1, 0.8, n)
    joints["damping"] = rng.uniform(0.2, 1.0, n)
    joints["friction"] = rng.uniform(0.1, 0.6, n)
    joints["rest"] = rng.uniform(-1.0, 1.0, n)
    root["tip"][0] = rng.normal(size=3) * 0.15
    root["tip_turn"][0] = Rotation.random(rng=rng).as_matrix()
    root["gravity"][0] = rng.normal(size=3) * 5.0 if gravity else 0.0
    names = tuple(f"joint {j}" for j in range(n))
    return Chain(f"random chain {seed}", names, joints, root).with_shares("inertia")


def planar_chain(n: int, *, limit: float = np.inf) -> Chain:
    """A plane arm of `n` equal links of 0.15 m with geared motors."""
    joints, root = empty_chain(n)
    joints["place"][1:] = (0.15, 0.0, 0.0)
    joints["mass"], joints["centre"] = 0.1, (0.075, 0.0, 0.0)
    joints["inertia"] = np.diag((0.0, 2e-4, 2e-4))
    joints["rotor"], joints["damping"] = np.linspace(0.8, 0.3, n), 0.5
    joints["limit"], joints["rest"] = limit, np.linspace(0.3, 0.9, n)
    root["tip"][0] = (0.15, 0.0, 0.0)
    return Chain(f"plane arm of {n}", tuple(f"joint {j}" for j in range(n)), joints, root, plane=True).with_shares(
        "inertia"
    )


@cache
def libra() -> Any:
    """The robot of the thesis."""
    return load_robot("libra")


def limb(name: str = "right", *, upright: bool = False, limited: bool = False) -> Chain:
    """A limb of LIBRA; its motors have no limits unless `limited`."""
    chain = chain_of_limb(libra(), name, upright=upright)
    if not limited:
        chain.joints["limit"] = np.inf
    return chain


def motors_only(chain: Chain) -> Chain:
    """The chain without its links' mass: what the simplification of SCCT takes for the truth."""
    joints = chain.joints.copy()
    joints["mass"], joints["inertia"] = 0.0, 0.0
    return Chain(chain.name, chain.joint_names, joints, chain.root, plane=chain.plane)


def random_state(chain: Chain, seed: int) -> tuple[Floats, Floats]:
    """Joint angles and speeds."""
    rng = np.random.default_rng(seed)
    return rng.uniform(-2.0, 2.0, chain.n), rng.normal(size=chain.n)


def tick(chain: Chain, settings: LawSettings, aim: Any, q: Floats, qd: Floats, felt: Floats | None = None) -> Floats:
    """Torques of a law's first tick, shape (n,)."""
    controller = Controller(chain, settings, period=PERIOD)
    wrench = None if felt is None else felt[None]
    return controller.command(aim, np.array([[q, qd]]), wrench)[0].copy()


def random_aim(chain: Chain, q: Floats, seed: int, *, away: float = 0.05) -> Any:
    """An aim near the tip at `q`, with speed, acceleration and turn."""
    rng = np.random.default_rng(seed)
    aim = still_aim(chain.place(q) + rng.normal(size=3) * away)
    aim["turn"] = (Rotation.from_rotvec(rng.normal(size=3)) * Rotation.from_matrix(tip_turn(chain, q))).as_matrix()
    aim["twist"], aim["acceleration"] = rng.normal(size=6) * 0.1, rng.normal(size=6)
    return aim


def tip_turn(chain: Chain, q: Floats) -> Floats:
    """Turn of the tip in the base frame, shape (3, 3), joint by joint from the records."""
    turn = np.eye(3)
    for record, angle in zip(chain.joints, q, strict=True):
        turn = turn @ record["turn"]
        if not record["sliding"]:
            turn = turn @ Rotation.from_rotvec(angle * record["axis"]).as_matrix()
    out: Floats = turn @ chain.root["tip_turn"][0]
    return out


class Pinocchio:
    """Pinocchio's model of a chain, built from the same records."""

    def __init__(self, chain: Chain) -> None:
        self.model = pinocchio.Model()
        parent = 0
        for name, record in zip(chain.joint_names, chain.joints, strict=True):
            kind = (
                pinocchio.JointModelPrismaticUnaligned if record["sliding"] else pinocchio.JointModelRevoluteUnaligned
            )
            place = pinocchio.SE3(record["turn"], record["place"])
            parent = self.model.addJoint(parent, kind(record["axis"]), place, name)
            inertia = pinocchio.Inertia(float(record["mass"]), record["centre"], record["inertia"])
            self.model.appendBodyToJoint(parent, inertia, pinocchio.SE3.Identity())
        root = chain.root[0]
        tip = pinocchio.Frame("tip", parent, 0, pinocchio.SE3(root["tip_turn"], root["tip"]), pinocchio.OP_FRAME)
        self.tip = self.model.addFrame(tip)
        self.model.armature = chain.joints["rotor"].copy()
        self.model.gravity.linear = root["gravity"]
        self.data = self.model.createData()

    def place(self, q: Floats) -> tuple[Floats, Floats]:
        """Place and turn of the tip."""
        pinocchio.framesForwardKinematics(self.model, self.data, q)
        at = self.data.oMf[self.tip]
        return at.translation.copy(), at.rotation.copy()

    def jacobian(self, q: Floats) -> Floats:
        """Of the tip's twist, base frame."""
        frame = pinocchio.ReferenceFrame.LOCAL_WORLD_ALIGNED
        out: Floats = pinocchio.computeFrameJacobian(self.model, self.data, q, self.tip, frame).reshape(6, -1)
        return out

    def inertia(self, q: Floats) -> Floats:
        """Inertia matrix with the motors."""
        upper = np.triu(pinocchio.crba(self.model, self.data, q))
        out: Floats = upper + np.triu(upper, 1).T
        return out

    def bias(self, q: Floats, qd: Floats) -> Floats:
        """Coriolis, centrifugal and weight."""
        out: Floats = pinocchio.nonLinearEffects(self.model, self.data, q, qd).copy()
        return out

    def drift(self, q: Floats, qd: Floats) -> Floats:
        """Jdot qd."""
        pinocchio.forwardKinematics(self.model, self.data, q, qd, np.zeros_like(q))
        pinocchio.updateFramePlacements(self.model, self.data)
        frame = pinocchio.ReferenceFrame.LOCAL_WORLD_ALIGNED
        motion = pinocchio.getFrameClassicalAcceleration(self.model, self.data, self.tip, frame)
        out: Floats = motion.vector.copy()
        return out

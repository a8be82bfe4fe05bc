"""Differential inverse kinematics of mink and pink on our own arm: what the motion of one tick costs there."""

import importlib.util
from collections.abc import Callable
from typing import Any, Final, TypeAlias

import numpy as np

from ..control.chain import Chain
from ..sim.limb_flaws import LimbFlaws
from ..sim.limb_model import limb_spec
from ..types import Floats

Tick: TypeAlias = Callable[[Floats, Floats], Floats]
"""Joint speeds [rad/s] that bring the tip from the joint angles [rad] to a place of the base frame [m] within one period."""
PERIOD: Final = 0.005
SOLVER: Final = "daqp"


def mink_tick(chain: Chain) -> tuple[Tick, Tick]:
    """A tick of mink on the limb's MuJoCo model: with the new angles read in, and `solve_ik` alone.

    The quadratic programme has no limits in it, the least work that it can be.
    """
    import mink

    configuration: Any = mink.Configuration(limb_spec(chain, LimbFlaws()).compile())
    task: Any = mink.FrameTask("tip", "site", position_cost=[1.0, 1.0, 0.0], orientation_cost=0.0)

    def solve(q: Floats, place: Floats) -> Floats:
        task.set_target(mink.SE3.from_translation(place))
        out: Floats = mink.solve_ik(configuration, [task], PERIOD, SOLVER, limits=[])
        return out

    def tick(q: Floats, place: Floats) -> Floats:
        configuration.update(q)
        return solve(q, place)

    return tick, solve


def pink_tick(chain: Chain) -> tuple[Tick, Tick]:
    """A tick of pink on a Pinocchio model of the same arm: with the new angles read in, and `solve_ik` alone."""
    import pinocchio
    from pink import Configuration, solve_ik
    from pink.tasks import FrameTask

    model = pinocchio.Model()
    parent = 0
    for name, joint in zip(chain.joint_names, chain.joints, strict=True):
        place = pinocchio.SE3(joint["turn"].copy(), joint["place"].copy())
        parent = model.addJoint(parent, pinocchio.JointModelRevoluteUnaligned(*joint["axis"]), place, name)
    root = chain.root[0]
    tip = pinocchio.SE3(root["tip_turn"].copy(), root["tip"].copy())
    model.addFrame(pinocchio.Frame("tip", parent, 0, tip, pinocchio.FrameType.OP_FRAME))
    configuration: Any = Configuration(model, model.createData(), np.zeros(chain.n))
    # pink counts a task's rows in the tip's frame: all three, so that any turn of it asks for the same place
    task: Any = FrameTask("tip", position_cost=1.0, orientation_cost=0.0)

    def solve(q: Floats, place: Floats) -> Floats:
        task.set_target(pinocchio.SE3(np.eye(3), place))
        out: Floats = solve_ik(configuration, [task], PERIOD, SOLVER, limits=[])
        return out

    def tick(q: Floats, place: Floats) -> Floats:
        configuration.update(q)
        return solve(q, place)

    return tick, solve


IK_PEERS: Final[dict[str, Callable[[Chain], tuple[Tick, Tick]]]] = {"mink": mink_tick, "pink": pink_tick}
"""Library -> what it does in a tick; each is optional."""


def installed(peer: str) -> bool:
    """Whether a library is there, with its solver."""
    return all(importlib.util.find_spec(name) is not None for name in (peer, "qpsolvers", SOLVER))

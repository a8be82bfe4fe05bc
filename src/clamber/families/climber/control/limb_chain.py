"""The limbs of a climber as the laws know them: each as a chain, and all as records of the body's control."""

import math
from collections.abc import Sequence

import numpy as np

from ....control.chain import Chain, ShareBasis, _wrapped, empty_chain, rotation
from ....types import Records
from ....units import GRAVITY
from ..robot.robot import Joint, Limb, LimbedRobot
from .planar_limb import PLANAR_LIMB


def chain_of_limb(robot: LimbedRobot, name: str, *, basis: ShareBasis = "inertia", upright: bool = False) -> Chain:
    """One limb of a climber as a chain in its port frame: x along the stretched limb, y to its left, z out of the wall.

    Links are thin rods with their mass spread evenly, as the robot file states no more; the hook's offset belongs to the second.

    Args:
        robot: The climber.
        name: Of the limb.
        basis: What K' is made of.
        upright: Whether weight acts, down the wall with the body level; else the limb lies in a horizontal plane (Bevly 1997, 3.4.1).
    """
    limb = robot.limbs[robot.limb_index(name)]
    joints, root = empty_chain(2)
    joints["place"][1] = (limb.l1, 0.0, 0.0)
    for j, (joint, length, mass) in enumerate(
        zip((limb.shoulder, limb.elbow), (limb.l1, limb.l2), limb.link_masses, strict=True)
    ):
        _fill_joint(joints[j : j + 1], joint, robot)
        joints["mass"][j] = mass
        joints["centre"][j] = (length / 2, 0.0, 0.0)
        across = mass * length**2 / 12
        joints["inertia"][j] = np.diag((0.0, across, across))
    root["tip"][0] = (limb.second_link.real, limb.second_link.imag, 0.0)
    root["tip_turn"][0] = rotation((0.0, 0.0, limb.end.angle))
    if upright:
        root["gravity"][0] = rotation((0.0, 0.0, -limb.port_angle)) @ (0.0, -GRAVITY, 0.0)
    chain = Chain(f"{robot.name}'s {name} limb", (f"{name} shoulder", f"{name} elbow"), joints, root, plane=True)
    return chain.with_shares(basis)


def chosen_limb(robot: LimbedRobot, limb: str) -> str:
    """Name of a limb that is called by its name or by its place from 1.

    Raises:
        UnknownNameError: If there is no such limb.
    """
    names = robot.limb_names
    if limb.isdecimal() and 1 <= int(limb) <= len(names):
        return names[int(limb) - 1]
    robot.limb_index(limb)
    return limb


def _fill_joint(record: Records, joint: Joint, robot: LimbedRobot) -> None:
    record["rotor"], record["damping"], record["friction"] = joint.inertia, joint.damping, joint.friction
    record["limit"] = robot.torque_limit_of(joint)
    record["speed"] = robot.no_load_speed_of(joint)
    record["back_emf"] = (joint.gear * robot.motor.torque_constant) ** 2 / robot.motor.resistance
    record["lower"], record["upper"] = joint.lower, joint.upper
    record["rest"] = (joint.lower + joint.upper) / 2


def closed_branches(limb: Limb, x: float, y: float) -> tuple[tuple[float, float], ...]:
    """Joint angles that put a limb's tip at (x, y) of its port frame [m], elbow angle positive first; none out of reach [rad]."""
    l1, l2, beta = limb.l1, limb.l2_effective, limb.hook_beta
    cosine = (x * x + y * y - l1 * l1 - l2 * l2) / (2 * l1 * l2)
    if not abs(cosine) <= 1.0:
        return ()
    bend, towards = float(np.arccos(cosine)), float(np.arctan2(y, x))
    out = []
    for inner in (bend, -bend):
        to_tip = float(np.arctan2(l2 * math.sin(inner), l1 + l2 * math.cos(inner)))
        out.append((_wrapped(towards - to_tip), _wrapped(inner - beta)))
    return tuple(out)


def legs_of(robot: LimbedRobot, chains: Sequence[Chain] | None = None) -> Records:
    """Records of `control.planar_limb.PLANAR_LIMB`, shape (limbs,); `chains` are those of the limbs, where there are any already."""
    legs = np.zeros(len(robot.limbs), PLANAR_LIMB)
    for i, limb in enumerate(robot.limbs):
        joints = (chain_of_limb(robot, limb.name) if chains is None else chains[i]).joints
        masses, centres = joints["mass"], joints["centre"][:, 0]
        legs[i] = (
            *(limb.port_x, limb.port_y, limb.port_angle, limb.l1, limb.l2_effective, limb.hook_beta),
            *(limb.end.angle, limb.end.kind == "hook", *joints["share"]),
            *(GRAVITY * (masses[0] * centres[0] + masses[1] * limb.l1), GRAVITY * masses[1] * centres[1]),
            GRAVITY * masses.sum(),
            *joints["rotor"],
            *joints["friction"],
            *joints["damping"],
            *joints["limit"],
        )
    return legs

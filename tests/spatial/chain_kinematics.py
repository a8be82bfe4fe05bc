"""Kinematics and gravity of `Chains`, link by link and slowly: what tests hold against MuJoCo and Pinocchio."""

from collections.abc import Iterator

import numpy as np

from clamber.families.spatial.robot.chains import Chains
from clamber.types import Floats


def frames(chains: Chains, limb: int, positions: Floats) -> Iterator[tuple[Floats, Floats]]:
    """Origin and axes of each joint's frame, then of the tip's, in the base frame."""
    place, axes = np.zeros(3), np.eye(3)
    for k in range(chains.n_joints[limb] + 1):
        place = place + axes @ chains.offset[limb, k]
        axes = axes @ chains.rotation[limb, k]
        if k < chains.n_joints[limb]:
            if chains.sliding[limb, k]:
                place = place + axes[:, 2] * positions[k]
            else:
                c, s = np.cos(positions[k]), np.sin(positions[k])
                axes = axes @ np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]])
        yield place, axes


def tip(chains: Chains, limb: int, positions: Floats) -> tuple[Floats, Floats]:
    """Place and axes of a limb's tip, base frame."""
    *_, last = frames(chains, limb, positions)
    return last


def jacobian(
    chains: Chains, limb: int, positions: Floats, point: Floats | None = None, up_to: int | None = None
) -> Floats:
    """Velocity of the tip, or of a point on a link, per joint speed, base frame, shape (3, joints)."""
    n = int(chains.n_joints[limb])
    found = list(frames(chains, limb, positions))
    point = found[-1][0] if point is None else point
    columns = np.zeros((3, n))
    for k in range(n if up_to is None else up_to + 1):
        place, axes = found[k]
        columns[:, k] = axes[:, 2] if chains.sliding[limb, k] else np.cross(axes[:, 2], point - place)
    return columns


def gravity_torques(chains: Chains, limb: int, positions: Floats, gravity: Floats) -> Floats:
    """What motors must give against gravity [m/s^2, base frame] [N m] or [N], shape (joints,)."""
    torques = np.zeros(int(chains.n_joints[limb]))
    for k, (place, axes) in enumerate(list(frames(chains, limb, positions))[:-1]):
        centre = place + axes @ chains.centre[limb, k]
        torques -= jacobian(chains, limb, positions, centre, k).T @ gravity * chains.mass[limb, k]
    return torques


def first_moment(chains: Chains, positions: list[Floats]) -> Floats:
    """Mass times centre of mass of the whole robot [kg m], base frame."""
    moment = chains.base_mass * chains.base_centre
    for limb, of_limb in enumerate(positions):
        for k, (place, axes) in enumerate(list(frames(chains, limb, of_limb))[:-1]):
            moment = moment + chains.mass[limb, k] * (place + axes @ chains.centre[limb, k])
    return moment


def random_positions(chains: Chains, random: np.random.Generator) -> list[Floats]:
    """Of every limb, within its limits."""
    return [random.uniform(chains.lower[limb, :n], chains.upper[limb, :n]) for limb, n in enumerate(chains.n_joints)]

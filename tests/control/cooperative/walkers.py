"""Walkers with random arms and random poses, for the tests of cooperative motion."""

from dataclasses import replace

import numpy as np

from clamber.control.quintic import quintic_share
from clamber.families.walker.robot import WalkerRobot
from clamber.tasks.robots import load_robot
from clamber.types import Floats


def hoshino() -> WalkerRobot:
    robot = load_robot("hoshino")
    assert isinstance(robot, WalkerRobot)
    return robot


def with_links(links: tuple[float, ...], masses: tuple[float, ...] | None = None) -> WalkerRobot:
    """The robot with an arm of other links."""
    robot = hoshino()
    n = len(links)
    arm = replace(
        robot.own_arm,
        links=links,
        masses=masses or tuple(1.0 + 0.5 * k for k in range(n)),
        lowest=(-3.0,) * (n + 1),
        highest=(3.0,) * (n + 1),
        fastest=(0.35,) * (n + 1),
        rest=(0.2,) + (0.5,) * n,
    )
    return replace(robot, arm=arm)


ROBOTS = {
    "hoshino": hoshino(),
    "one link": with_links((0.4,)),
    "two links": with_links((0.25, 0.2)),
    "four links": with_links((0.2, 0.3, 0.1, 0.15)),
    "six links": with_links((0.2, 0.3, 0.1, 0.15, 0.1, 0.05)),
}


def random_q(robot: WalkerRobot, seed: int, tilt: float = 0.6) -> Floats:
    """Freedoms anywhere: places within 0.3 m of (0, 0, 0.4), any yaw, tilts and joints as told."""
    assert robot.arm is not None
    rng = np.random.default_rng(seed)
    out: Floats = rng.uniform(-1.0, 1.0, 6 + robot.arm.n_joints)
    out[:6] *= np.array([0.3, 0.3, 0.3, 3.0, tilt, tilt])
    out[2] += 0.4
    out[6:] *= 2.5
    return out


def switch(before: Floats, after: Floats, part: float) -> Floats:
    """Weights on the way from one set to another: speeds and accelerations of the switching are 0 at both ends.

    Args:
        before, after: Weights, shape (m,).
        part: Of the switching's time that has passed, [0, 1].
    """
    out: Floats = before + quintic_share(part) * (after - before)
    return out


def differences(function: object, q: Floats, step: float = 1e-6) -> Floats:
    """Central differences of a function of q along each freedom, shape (m, ...)."""
    assert callable(function)
    rows = []
    for k in range(q.size):
        ahead, behind = q.copy(), q.copy()
        ahead[k] += step
        behind[k] -= step
        rows.append((np.asarray(function(ahead)) - np.asarray(function(behind))) / (2.0 * step))
    return np.array(rows)

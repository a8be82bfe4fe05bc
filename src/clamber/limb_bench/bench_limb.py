"""The limb that is put on the bench: which robot's, from where it starts, and its chain."""

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np

from ..errors import ClamberError, StatedError
from ..family import families
from ..sim.bench_limb import BenchLimb, GearedRobot
from ..tasks.robots import build_robot, family_in, read_robot
from ..units import PointError


class StartError(StatedError):
    """A start of the limb that cannot be: names the limb, the place and why."""

    says = "{limb}: start ({place[0]:g}, {place[1]:g}) m {problem}"
    limb: str
    place: tuple[float, float]
    problem: str


LEAST_SIGMA = 0.01
"""A start whose Jacobian has a smaller singular value counts as singular [m/rad]."""


def load_geared(name: str) -> tuple[GearedRobot, Callable[..., BenchLimb]]:
    """A robot by name or file whose limbs the bench takes, and what makes such a limb of it.

    Raises:
        UnknownNameError: If there is no such robot.
        ClamberError: If its family has no limbs for the bench.
    """
    document = read_robot(name)
    make_limb = family_in(document).bench_limb
    if make_limb is None:
        known = " or ".join(f"'{family.name}'" for family in families() if family.bench_limb is not None)
        raise ClamberError(f"{name}: the limb bench takes robots of the family {known}")
    robot: Any = build_robot(document)
    return robot, make_limb


def bench_limb(
    robot: str = "libra",
    limb: str | None = None,
    start: tuple[float, float] = (0.22, 0.0),
    *,
    elbow: int | None = None,
    upright: bool = False,
) -> BenchLimb:
    """A limb with its tip at `start` of its port frame [m].

    Args:
        robot: A climber's name or file.
        limb: Its name, or its place from 1; None: the first.
        start: Where the tip is [m].
        elbow: 1 for a positive elbow angle, -1 for a negative one; None: positive if that is within the joints' limits.
        upright: Whether weight acts.

    Raises:
        StartError: If no pose within the joints' limits has its tip there, or only a singular one.
        UnknownNameError: If there is no such robot or limb.
    """
    loaded, make_limb = load_geared(robot)
    limb_at = make_limb(loaded, limb, upright=upright)
    chain = limb_at.chain
    label = f"{loaded.name}'s {limb_at.name} limb"
    branches = limb_at.branches(*start)
    if not branches:
        least, most = limb_at.reach
        raise StartError(label, start, f"is out of reach: allowed are {least:.3g} to {most:.3g} m")
    wanted = branches if elbow is None else (branches[0 if elbow > 0 else 1],)
    for q in wanted:
        inside = all(
            low <= angle <= high
            for low, angle, high in zip(chain.joints["lower"], q, chain.joints["upper"], strict=True)
        )
        if not inside:
            continue
        sigma = float(np.linalg.svd(chain.jacobian(q)[:2], compute_uv=False).min())
        if sigma < LEAST_SIGMA:
            raise StartError(
                label,
                start,
                f"is singular: its Jacobian's smallest singular value is {sigma:.2g} m/rad, {LEAST_SIGMA:g} is allowed",
            )
        return replace(limb_at, q0=np.array(q))
    raise StartError(label, start, "needs joint angles beyond the joints' limits")


def read_elbow(text: str | None) -> int | None:
    """1 or -1 of "+" or "-".

    Raises:
        PointError: If it is neither.
    """
    signs = {"+": 1, "-": -1, "positive": 1, "negative": -1}
    if text is None:
        return None
    if text not in signs:
        raise PointError("elbow", text, "must be + or -")
    return signs[text]

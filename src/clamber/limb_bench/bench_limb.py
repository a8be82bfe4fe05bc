"""The limb that is put on the bench: which robot's, from where it starts, and its chain."""

from dataclasses import dataclass

import numpy as np

from ..control.chain import Chain
from ..errors import ClamberError
from ..families.climber.control.limb_chain import chain_of_limb, closed_branches
from ..families.climber.robot.robot import Limb, LimbedRobot
from ..tasks.robots import load_robot
from ..types import Floats
from ..units import PointError


class StartError(ClamberError):
    """A start of the limb that cannot be: names the limb, the place and why."""

    def __init__(self, limb: str, place: tuple[float, float], problem: str) -> None:
        super().__init__(limb, place, problem)
        self.limb, self.place, self.problem = limb, place, problem

    def __str__(self) -> str:
        return f"{self.limb}: start ({self.place[0]:g}, {self.place[1]:g}) m {self.problem}"


@dataclass(frozen=True, slots=True, eq=False)
class BenchLimb:
    """One limb of a climber, at rest somewhere."""

    robot: LimbedRobot
    name: str
    chain: Chain
    """As its file states it; what is unknown to the controller is the plant's."""
    gears: Floats
    """Motor turns per joint turn, shape (n,)."""
    q0: Floats
    """Joint angles at the start [rad]."""

    @property
    def spec(self) -> Limb:
        """As the robot's file states it."""
        return self.robot.limbs[self.robot.limb_index(self.name)]

    @property
    def start(self) -> tuple[float, float]:
        """Tip at the start, port frame [m]."""
        place = self.chain.place(self.q0)
        return float(place[0]), float(place[1])


LEAST_SIGMA = 0.01
"""A start whose Jacobian has a smaller singular value counts as singular [m/rad]."""


def limbed_robot(name: str) -> LimbedRobot:
    """A climber by name or file.

    Raises:
        UnknownNameError: If there is no such robot.
        ClamberError: If it is of another family.
    """
    loaded = load_robot(name)
    if not isinstance(loaded, LimbedRobot):
        raise ClamberError(f"{name}: the limb bench takes robots of the family 'limbed'")
    return loaded


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
    loaded = limbed_robot(robot)
    names = loaded.limb_names
    name = (
        names[0]
        if limb is None
        else names[int(limb) - 1]
        if limb.isdecimal() and 1 <= int(limb) <= len(names)
        else limb
    )
    spec = loaded.limbs[loaded.limb_index(name)]
    chain = chain_of_limb(loaded, name, upright=upright)
    label = f"{loaded.name}'s {name} limb"
    branches = closed_branches(spec, *start)
    if not branches:
        raise StartError(
            label, start, f"is out of reach: allowed are {abs(spec.l1 - spec.l2_effective):.3g} to {spec.length:.3g} m"
        )
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
        gears = np.array((spec.shoulder.gear, spec.elbow.gear))
        return BenchLimb(loaded, name, chain, gears, np.array(q))
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
